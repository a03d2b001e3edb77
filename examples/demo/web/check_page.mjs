// Drives the demo and compares its radiance, which the page reads back, with the expected values.
import { existsSync } from "node:fs";
import { join } from "node:path";

const MINUTE = 60_000;

function assert(holds, what) {
  if (!holds) throw new Error(what);
  console.log(`ok: ${what}`);
}

// Counts the colours of the right half of the window, where the picture is.
async function colors(tab) {
  const png = (await tab.screenshot()).toString("base64");
  return tab.evaluate(async (png) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
    const paper = new OffscreenCanvas(image.width, image.height).getContext("2d");
    paper.drawImage(image, 0, 0);
    const half = image.width / 2;
    const { data } = paper.getImageData(half, 0, half, image.height);
    return new Set(new Uint32Array(data.buffer)).size;
  }, png);
}

const mean = (numbers) => numbers.reduce((sum, x) => sum + x, 0) / numbers.length;

export async function checkPage(tab, site, target) {
  if (!existsSync(join(target, "web/asvgf-demo_bg.wasm"))) {
    console.log("not checked: the demo was not built for browsers (sh examples/demo/web/serve build)");
    return;
  }
  const complaints = [];
  tab.on("console", (line) => line.type() === "error" && complaints.push(line.text()));
  tab.on("pageerror", (error) => complaints.push(String(error)));
  await tab.goto(`${site}/web/index.html`);
  await tab.waitForFunction(() => window.page || window.failure, null, { timeout: 5 * MINUTE });
  const failure = await tab.evaluate(() => window.failure);
  assert(failure === undefined, `the page comes up ${failure ?? ""}`);

  const reach = (count) =>
    tab.waitForFunction((count) => window.page.frames() >= count, count, { timeout: 5 * MINUTE, polling: 20 });
  // Adopts a state, and waits for `count` frames of it.
  const render = async (count, state) => {
    const text = JSON.stringify({ scale: 0.1, ...state });
    await reach(count + (await tab.evaluate((text) => (window.page.choose(text), window.page.frames()), text)));
  };
  // Renders one more frame while time stands still.
  const step = async () => reach(1 + (await tab.evaluate(() => (window.page.step(), window.page.frames()))));
  // Returns the linear radiance of the left half.
  const radiance = async () => {
    await tab.evaluate(() => window.page.ask());
    const handle = await tab.waitForFunction(
      () => {
        const numbers = window.page.radiance();
        return numbers.length > 0 && Array.from(numbers);
      },
      null,
      { timeout: MINUTE, polling: 20 },
    );
    return handle.jsonValue();
  };
  const lit = { motion: { blink: false } };
  const dark = { motion: { blink: false, lit: false } };

  await render(3, lit);
  const first = await radiance();
  assert(new Set(first).size > 100 && first.every(Number.isFinite), "a frame is not blank");
  assert((await colors(tab)) > 100, "nor is the canvas");

  // After the lamps have gone out the truth is black: any remaining light is history.
  await render(12, { ...lit, left: "Adaptive" });
  const before = mean(await radiance());
  await render(1, { ...dark, left: "Adaptive", paused: true });
  const kept = mean(await radiance()) / before;
  assert(kept < 0.02, `an adaptive α has forgotten the light (${kept.toFixed(3)} is left)`);
  await render(12, { ...lit, left: "Constant" });
  await render(1, { ...dark, left: "Constant", paused: true });
  const once = mean(await radiance());
  for (let i = 0; i < 3; i++) await step();
  const faded = mean(await radiance()) / once;
  assert(Math.abs(faded - 0.8 ** 3) < 0.03, `a constant α of 0.2 keeps 0.8 of it a frame (${faded.toFixed(3)} over three)`);

  for (const left of ["Noisy", "Reference"]) {
    await render(2, { ...lit, left });
    assert(mean(await radiance()) > 0.01, `${left} is rendered`);
  }
  for (const scene of ["cornell", "pillars"]) {
    for (const settings of [{}, { blend: "lambda", stops: "classic", kernel: "full", feedback: true, variance: "of-sample" }]) {
      for (const gradient of ["reshade", "blinn-phong"]) {
        await render(2, { ...lit, scene, split: true, plots: true, settings: { ...settings, gradient } });
      }
    }
  }
  const views = "denoised noisy albedo normal depth triangle-id motion gradient lambda alpha history-length variance non-finite rays motion-error emission object pair-now pair-before mean";
  for (const view of views.split(" ")) {
    await render(1, { ...lit, view });
  }

  // Drops files together, as a browser hands them over.
  const drop = (files) =>
    tab.evaluate((files) => {
      const dataTransfer = new DataTransfer();
      files.forEach(([name, text]) => dataTransfer.items.add(new File([text], name)));
      document.getElementById("canvas").dispatchEvent(new DragEvent("drop", { dataTransfer, cancelable: true }));
    }, files);
  await drop([
    ["square.obj", "mtllib red.mtl\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nusemtl red\nf 1 2 3 4\n"],
    ["red.mtl", "newmtl red\nKd 0.8 0 0\n"],
  ]);
  const opened = () => JSON.parse(window.page.chosen()).scene === "square.obj";
  await tab.waitForFunction(opened, null, { timeout: MINUTE, polling: 20 });
  await render(2, { ...lit, scene: "square.obj" });
  const dropped = await radiance();
  const red = dropped.filter((x, i) => i % 3 === 0 && x > 0.01 && dropped[i + 1] < 0.01 * x).length;
  assert(red > 0, `dropped files are opened (${red} of ${dropped.length / 3} pixels are red)`);

  assert((await tab.evaluate(() => window.page.messages())) === "", "nothing was complained about in the window");
  assert(complaints.length === 0, `nor in the console ${complaints.slice(0, 5).join("; ")}`);
}
