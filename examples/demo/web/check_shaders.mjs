// Every shader that the library can compose, in the browser's own compiler, with the limits that every browser offers.
import { existsSync } from "node:fs";
import { readdir } from "node:fs/promises";
import { join } from "node:path";

// So many at a time: enough to keep the compiler busy.
const BATCH = 16;

// Runs in the page. Returns the names of shaders that do not compile, each with the message.
async function compile(names) {
  window.device ??= await (await navigator.gpu.requestAdapter()).requestDevice();
  const refused = [];
  const one = async (name) => {
    const code = await (await fetch(`/permutations/${name}`)).text();
    const module = window.device.createShaderModule({ code });
    const { messages } = await module.getCompilationInfo();
    const compute = { module, entryPoint: "main" };
    const error = await window.device
      .createComputePipelineAsync({ layout: "auto", compute })
      .then(() => undefined, (error) => error.message);
    const said = messages.map((m) => `${m.type}: line ${m.lineNum}: ${m.message}`);
    if (said.length > 0 || error) refused.push([name, code.split("\n")[0], ...said, error].join("\n  "));
  };
  await Promise.all(names.map(one));
  return refused;
}

export async function checkShaders(tab, site, target) {
  const folder = join(target, "permutations");
  const names = existsSync(folder) ? (await readdir(folder)).sort() : [];
  if (names.length === 0) {
    console.log("not checked: shaders were not written (cargo test --lib every_reachable_permutation_is_written -- --ignored)");
    return;
  }
  await tab.goto(`${site}/blank`);
  const refused = [];
  for (let i = 0; i < names.length; i += BATCH) {
    refused.push(...(await tab.evaluate(compile, names.slice(i, i + BATCH))));
  }
  if (refused.length > 0) {
    throw new Error(`${refused.length} of ${names.length} shaders do not compile:\n${refused.slice(0, 10).join("\n")}`);
  }
  console.log(`ok: all ${names.length} shaders compile`);
}
