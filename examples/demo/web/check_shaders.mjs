// Compiles every shader that the library can compose in the browser's own compiler, with the limits that every browser offers.
import { existsSync } from "node:fs";
import { readdir } from "node:fs/promises";
import { join } from "node:path";

// Number of shaders that compile at a time: enough to keep the compiler busy.
const BATCH = 16;

// One shader among this many becomes a pipeline, which is machine code for a CPU here and takes forty times as long as the check of
// the language. All shaders pass that check.
const PIPELINES = 64;

// Runs in the page. Returns the errors of shaders, each with the shader's name.
async function compile({ names, pipelines }) {
  window.device ??= await (await navigator.gpu.requestAdapter()).requestDevice();
  const problems = await Promise.all(
    names.map(async (name) => {
      const code = await (await fetch(`/permutations/${name}`)).text();
      const module = window.device.createShaderModule({ code });
      const { messages } = await module.getCompilationInfo();
      const said = messages.map((m) => `${m.type} in line ${m.lineNum}: ${m.message}`);
      if (said.length === 0 && pipelines.includes(name)) {
        const descriptor = { layout: "auto", compute: { module, entryPoint: "main" } };
        await window.device.createComputePipelineAsync(descriptor).catch((error) => said.push(error.message));
      }
      return said.length > 0 && [name, code.split("\n")[0], ...said].join("\n  ");
    }),
  );
  return problems.filter(Boolean);
}

export async function checkShaders(tab, site, target) {
  const folder = join(target, "permutations");
  const names = existsSync(folder) ? (await readdir(folder)).sort() : [];
  if (names.length === 0) {
    console.log("not checked: no shaders (cargo test --lib every_reachable_permutation_is_written -- --ignored)");
    return;
  }
  await tab.goto(`${site}/blank`);
  // Pipelines are made of the first shader of each pass, and of some more where a pass has many.
  const pipelines = names.filter((name) => Number(/-(\d+)\./.exec(name)[1]) % PIPELINES === 0);
  const problems = [];
  for (let i = 0; i < names.length; i += BATCH) {
    const batch = names.slice(i, i + BATCH);
    problems.push(...(await tab.evaluate(compile, { names: batch, pipelines })));
  }
  if (problems.length > 0) {
    throw new Error(`${problems.length} of ${names.length} shaders do not compile:\n${problems.slice(0, 10).join("\n")}`);
  }
  console.log(`ok: all ${names.length} shaders compile, and ${pipelines.length} of them to pipelines`);
}
