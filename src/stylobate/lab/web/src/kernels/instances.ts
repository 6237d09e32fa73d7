/** What modules of WebAssembly import. */

const PAGE = 1 << 16;

/** Returns the memory of a module and its stack, which lies below `stack` behind the constant tables. */
export function imported(memory: WebAssembly.Memory, stack = PAGE): WebAssembly.ModuleImports {
  const pointer = new WebAssembly.Global({ value: "i32", mutable: true }, stack);
  return { __linear_memory: memory, __stack_pointer: pointer };
}
