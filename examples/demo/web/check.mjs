// Checks in a headless Chromium with software WebGPU that every shader compiles there and that the demo renders correctly.
//
//   sh examples/demo/web/serve build
//   cargo test --lib every_reachable_permutation_is_written -- --ignored
//   npm install --prefix target/tools playwright-core
//   node examples/demo/web/check.mjs
//
// CHROMIUM names the browser; the default is /usr/bin/chromium. Missing parts are named, and not checked.
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { dirname, extname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { checkPage } from "./check_page.mjs";
import { checkShaders } from "./check_shaders.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";

function skip(what) {
  console.log(`not checked: ${what}`);
  process.exit(0);
}

if (!existsSync(browserPath)) skip(`there is no browser at ${browserPath}`);
let playwright;
try {
  playwright = createRequire(join(root, "target/tools/package.json"))("playwright-core");
} catch {
  skip("playwright-core is not installed (npm install --prefix target/tools playwright-core)");
}

const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const server = createServer(async (request, response) => {
  try {
    const body = await readFile(join(root, "target", request.url));
    response.writeHead(200, { "content-type": types[extname(request.url)] ?? "text/plain" }).end(body);
  } catch {
    response.writeHead(404, { "content-type": "text/html" }).end("not found");
  }
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const site = `http://127.0.0.1:${server.address().port}`;

// WebGPU and the compositor both run on SwiftShader's Vulkan: with another compositor, canvases stay blank and devices get lost.
// The watchdog is off, because SwiftShader may compile a shader for longer than it would wait.
const args = [
  "--no-sandbox",
  "--enable-unsafe-webgpu",
  "--use-webgpu-adapter=swiftshader",
  "--enable-features=Vulkan",
  "--use-vulkan=swiftshader",
  "--use-angle=swiftshader",
  "--disable-gpu-watchdog",
];
const browser = await playwright.chromium.launch({ executablePath: browserPath, args });
console.log(`Chromium ${browser.version()}`);
let failed = false;
for (const check of [checkShaders, checkPage]) {
  const tab = await browser.newPage({ viewport: { width: 720, height: 480 } });
  try {
    await check(tab, site, join(root, "target"));
  } catch (error) {
    console.error(`failed: ${error.message}`);
    failed = true;
  }
  await tab.close();
}
await browser.close();
server.close();
process.exit(failed ? 1 : 0);
