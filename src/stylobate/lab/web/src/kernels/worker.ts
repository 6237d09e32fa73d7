/** Work beside the page: a worker computes pieces of maps by a program of compiled modules, or reads a record. */

import { imported } from "./instances";
import type { Read, Reading } from "./own-records";
import { Program } from "./program";
import { readUpload } from "./records/upload";
import { Refused } from "../page/server/source";
import type { Asked, Found, Setup } from "./worker-pool";

// What prevents the start is an error of the worker, at which the page computes by itself.
const ready = new Promise<Program>((resolve) => {
  self.addEventListener("message", ({ data }: MessageEvent<Setup | Asked | Read>) => {
    if (!("runs" in data || "read" in data)) made(data).then(resolve, self.reportError);
  });
  self.addEventListener("messageerror", () => self.reportError(new Error("the modules cannot be sent to a worker")));
});

async function made({ mathematics, program, described, common }: Setup): Promise<Program> {
  const env = imported(new WebAssembly.Memory({ initial: 2 }));
  const { exports } = await WebAssembly.instantiate(mathematics, { env });
  return Program.of(program, exports, described, common);
}

async function answer({ data }: MessageEvent<Asked | Setup | Read>): Promise<void> {
  if ("read" in data) return self.postMessage(await reading(data));
  if (!("runs" in data)) return;
  let found: Found;
  try {
    found = { verdicts: (await ready).batch(data.runs, data.pieces) };
  } catch (error) {
    found = { problem: error instanceof Error ? error.message : String(error) };
  }
  self.postMessage(found);
}

async function reading({ read }: Read): Promise<Reading> {
  try {
    return await readUpload(read);
  } catch (error) {
    if (error instanceof Refused) return { problems: error.problems };
    throw error;
  }
}

self.addEventListener("message", (event: MessageEvent<Asked | Setup | Read>) => {
  void answer(event).catch(self.reportError);
});
