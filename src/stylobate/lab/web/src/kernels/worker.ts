/** Runs computed beside the page: a worker makes a program of its compiled modules, then computes pieces of maps. */

import { imported } from "./instances";
import { Program } from "./program";
import type { Asked, Found, Setup } from "./worker-pool";

// What prevents the start is an error of the worker, at which the page computes by itself.
const ready = new Promise<Program>((resolve) => {
  const setUp = ({ data }: MessageEvent<Setup>): void => void made(data).then(resolve, self.reportError);
  self.addEventListener("message", setUp, { once: true });
  self.addEventListener("messageerror", () => self.reportError(new Error("the modules cannot be sent to a worker")));
});

async function made({ mathematics, program, described, common }: Setup): Promise<Program> {
  const env = imported(new WebAssembly.Memory({ initial: 2 }));
  const { exports } = await WebAssembly.instantiate(mathematics, { env });
  return Program.of(program, exports, described, common);
}

async function answer({ data }: MessageEvent<Asked | Setup>): Promise<void> {
  if (!("runs" in data)) return;
  let found: Found;
  try {
    found = { verdicts: (await ready).batch(data.runs) };
  } catch (error) {
    found = { problem: error instanceof Error ? error.message : String(error) };
  }
  self.postMessage(found);
}

self.addEventListener("message", (event: MessageEvent<Asked | Setup>) => void answer(event));
