// Reads records as the page does: node read-records.mjs FOLDER, which holds a list of what the page sends.

import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { readUpload } from "../../src/kernels/records/upload";
import type { Part } from "../../src/page/case/description";
import { Refused } from "../../src/page/server/source";

const folder = process.argv[2] ?? ".";
const sent = JSON.parse(readFileSync(join(folder, "sent.json"), "utf8")) as readonly Part[];
const answers: unknown[] = [];
for (const body of sent) {
  try {
    const { received, samples } = await readUpload(body);
    const { values, step } = samples;
    answers.push({ received, values: [...values], step });
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    answers.push({ problems: error.problems });
  }
}
writeFileSync(join(folder, "answers.json"), JSON.stringify(answers));
