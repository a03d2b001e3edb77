"""Makes the images here, and prints the numbers that other programs give for them.

needs: numpy, Pillow, scikit-image 0.26, flip-evaluator 1.7
"""
import numpy as np
from PIL import Image
from skimage.metrics import structural_similarity
from flip_evaluator import evaluate

W, H = 40, 28
y, x = np.mgrid[0:H, 0:W]
reference = np.stack([40 + 4 * x, 200 - 5 * y, 60 + 2 * x + y], -1).astype(float)
reference[(x - 14) ** 2 + (y - 12) ** 2 < 49] = [230, 180, 40]
reference[8:22, 26:34] = [20, 40, 160]
noisy = reference + np.random.default_rng(7).normal(0, 20, reference.shape)
blurred = sum(np.roll(reference, (dy, dx), (0, 1)) for dy in (-1, 0, 1) for dx in (-1, 0, 1)) / 9
images = {n: np.clip(i.round(), 0, 255).astype(np.uint8) for n, i in dict(reference=reference, noisy=noisy, blurred=blurred).items()}
for name, image in images.items():
    Image.fromarray(image).save(f'{name}.png')
    luma, truth = (images[n] / 255.0 @ [0.2126, 0.7152, 0.0722] for n in (name, 'reference'))
    ssim = structural_similarity(luma, truth, data_range=1, gaussian_weights=True, sigma=1.5, use_sample_covariance=False)
    a, b = (images[n].astype(np.float32) / 255 for n in ('reference', name))
    flip = evaluate(a, b, 'LDR', inputsRGB=True, applyMagma=False)
    print(name, 'ssim', f'{ssim:.8f}', 'flip', f'{flip[1]:.6f}', {f'{p}': round(float(flip[0][p[1], p[0], 0]), 5) for p in [(3, 3), (20, 14), (30, 20)]})
