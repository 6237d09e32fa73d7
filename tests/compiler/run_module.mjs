// Runs `advance` of a module on arrays from a file and writes the first array back:
// node run_module.mjs MODULE MATHEMATICS INPUT OUTPUT
import { readFileSync, writeFileSync } from "node:fs";

const [module, mathematics, input, output] = process.argv.slice(2);
const bytes = readFileSync(input);
const length = bytes.readUInt32LE(0);
const { shapes } = JSON.parse(bytes.subarray(4, 4 + length).toString());
const arrays = new Uint8Array(bytes.subarray(4 + length));

const [constants, stack] = [1 << 16, 1 << 18]; // constant tables lie below, the stack between them and the arrays
const memory = new WebAssembly.Memory({ initial: 4 + Math.ceil((stack + arrays.length + (1 << 16)) / (1 << 16)) });
const pointer = new WebAssembly.Global({ value: "i32", mutable: true }, stack);
const made = async (path, env) => WebAssembly.instantiate(await WebAssembly.compile(readFileSync(path)), { env });
const own = new WebAssembly.Memory({ initial: 2 });
const functions = await made(mathematics, {
  __linear_memory: own,
  __stack_pointer: new WebAssembly.Global({ value: "i32", mutable: true }, 1 << 17),
});
const instance = await made(module, { ...functions.exports, __linear_memory: memory, __stack_pointer: pointer });
if (constants >= stack) throw new Error("no room for the stack");

new Uint8Array(memory.buffer).set(arrays, stack);
const values = [];
let place = stack;
for (const { sizes, width, lengths } of shapes) {
  values.push(place, ...(lengths ? sizes.map(BigInt) : []));
  place += width * sizes.reduce((a, b) => a * b, 1);
  place += (64 - (place % 64)) % 64;
}
instance.exports.advance(...values);
const [{ sizes, width }] = shapes;
writeFileSync(output, new Uint8Array(memory.buffer, stack, width * sizes.reduce((a, b) => a * b, 1)));
