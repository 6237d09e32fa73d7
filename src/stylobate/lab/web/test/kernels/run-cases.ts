// Runs cases by a program: node run-cases.mjs FOLDER, which holds modules, descriptions and the numbers of the cases.

import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { type Common, type Described, evenly, Program } from "../../src/kernels/program";

interface Asked {
  readonly common: Common;
  readonly described: Described;
  readonly cases: number;
  readonly samples: number;
}

const folder = process.argv[2] ?? ".";
const asked = JSON.parse(readFileSync(join(folder, "asked.json"), "utf8")) as Asked;
const module = (name: string): Promise<WebAssembly.Module> => WebAssembly.compile(readFileSync(join(folder, name)));

const mathematics = await WebAssembly.instantiate(await module("mathematics.wasm"), {
  env: {
    __linear_memory: new WebAssembly.Memory({ initial: 2 }),
    __stack_pointer: new WebAssembly.Global({ value: "i32", mutable: true }, 1 << 17),
  },
});
const { described, common } = asked;
const program = await Program.of(await module("program.wasm"), mathematics.exports, described, common);
const bytes = readFileSync(join(folder, "numbers"));
const every = new Float64Array(bytes.buffer, bytes.byteOffset, bytes.length / 8);
const width = described.names.length;
let spent = 0;
for (let k = 0; k < asked.cases; k += 1) {
  const begun = performance.now();
  const found = program.run(every.slice(k * width, (k + 1) * width));
  const { log, setup } = common.columns;
  const end = (found.row[log["time"] ?? NaN] ?? NaN) * (found.row[setup["time_scale"] ?? NaN] ?? NaN);
  const samples = program.samples(found.stretches, evenly(end, asked.samples));
  spent += performance.now() - begun;
  for (const [name, numbers] of Object.entries({ ...found, samples, planar: Float64Array.of(found.planar ? 1 : 0) })) {
    writeFileSync(join(folder, `${name}${k}`), numbers as Float64Array);
  }
}
console.log(spent / asked.cases);
