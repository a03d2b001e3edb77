// Drives the demo in a headless Chromium with software WebGPU, and compares what it renders with what it has to be.
//
//   sh examples/demo/web/serve build
//   npm install --prefix target/tools playwright-core
//   node examples/demo/web/check.mjs
//
// CHROMIUM names the browser, /usr/bin/chromium if it is not set.
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { dirname, extname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const site = join(root, "target/web");
const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";

function skip(what) {
  console.log(`not checked: ${what}`);
  process.exit(0);
}

if (!existsSync(join(site, "asvgf-demo_bg.wasm"))) skip("the demo was not built for browsers (sh examples/demo/web/serve build)");
if (!existsSync(browserPath)) skip(`there is no browser at ${browserPath}`);
let playwright;
try {
  playwright = createRequire(join(root, "target/tools/package.json"))("playwright-core");
} catch {
  skip("playwright-core is not installed (npm install --prefix target/tools playwright-core)");
}

function assert(holds, what) {
  if (!holds) throw new Error(what);
  console.log(`ok: ${what}`);
}

const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const server = createServer(async (request, response) => {
  const name = request.url === "/" ? "/index.html" : request.url;
  try {
    const body = await readFile(join(site, name));
    response.writeHead(200, { "content-type": types[extname(name)] ?? "application/octet-stream" }).end(body);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));

const browser = await playwright.chromium.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"],
});
const minutes = 60_000;
let failed = false;
try {
  const tab = await browser.newPage({ viewport: { width: 720, height: 480 } });
  const complaints = [];
  tab.on("console", (line) => line.type() === "error" && complaints.push(line.text()));
  tab.on("pageerror", (error) => complaints.push(String(error)));
  await tab.goto(`http://127.0.0.1:${server.address().port}/`);
  await tab.waitForFunction(() => window.page || window.failure, null, { timeout: 5 * minutes });
  assert((await tab.evaluate(() => window.failure)) === undefined, "the page comes up");

  // Chooses, and waits for so many frames of what was chosen.
  const render = async (count, state) => {
    const text = JSON.stringify({ scale: 0.1, ...state });
    const last = await tab.evaluate((text) => (window.page.choose(text), window.page.frames()), text);
    const reached = (n) => window.page.frames() >= n;
    await tab.waitForFunction(reached, last + count, { timeout: 5 * minutes, polling: 20 });
  };
  // Linear radiance of the left half.
  const radiance = async () => {
    await tab.evaluate(() => window.page.ask());
    const handle = await tab.waitForFunction(
      () => {
        const numbers = window.page.radiance();
        return numbers.length > 0 && Array.from(numbers);
      },
      null,
      { timeout: minutes, polling: 20 },
    );
    return handle.jsonValue();
  };
  const mean = (numbers) => numbers.reduce((sum, x) => sum + x, 0) / numbers.length;
  const lit = { motion: { blink: false } };
  const dark = { motion: { blink: false, lit: false } };

  await render(3, lit);
  const first = await radiance();
  assert(new Set(first).size > 100 && first.every(Number.isFinite), "the canvas is not blank");

  // After the lamps have gone out the truth is black: all that is left is history.
  const left = {};
  for (const source of ["Adaptive", "Constant"]) {
    await render(12, { ...lit, left: source });
    const before = mean(await radiance());
    await render(1, { ...dark, left: source, paused: true });
    left[source] = mean(await radiance()) / before;
  }
  assert(left.Adaptive < 0.02, `adaptive α has forgotten the light (${left.Adaptive.toFixed(3)} is left)`);
  assert(Math.abs(left.Constant - 0.8) < 0.12, `a constant α of 0.2 keeps 0.8 of it (${left.Constant.toFixed(3)})`);

  for (const left of ["Noisy", "Reference"]) {
    await render(2, { ...lit, left });
    assert(mean(await radiance()) > 0.01, `${left} is rendered`);
  }
  for (const scene of ["cornell", "pillars"]) {
    for (const settings of [{}, { blend: "Lambda", stops: "Classic", kernel: "Full", feedback: true, variance: "OfSample" }]) {
      for (const gradient of ["Reshade", "BlinnPhong"]) {
        await render(2, { ...lit, scene, split: true, plots: true, settings: { ...settings, gradient } });
      }
    }
  }
  const views = "denoised noisy albedo normal depth triangle-id motion gradient lambda alpha history-length variance non-finite rays motion-error emission object pair-now pair-before mean";
  for (const view of views.split(" ")) {
    await render(1, { ...lit, view });
  }
  assert((await tab.evaluate(() => window.page.messages())) === "", "nothing was complained about in the window");
  assert(complaints.length === 0, `nor in the console ${complaints.slice(0, 5).join("; ")}`);
} catch (error) {
  console.error(`failed: ${error.message}`);
  failed = true;
} finally {
  await browser.close();
  server.close();
}
process.exit(failed ? 1 : 0);
