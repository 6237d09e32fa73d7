/** Reads the files of one event, as the server does: in a worker, since large files take seconds. */

import type { Part, Value } from "../../page/case/description";
import type { UploadedRecord } from "../../page/server/schema";
import { Refused } from "../../page/server/source";
import { general } from "../general";
import { textOf } from "./content";
import { AXES } from "./directions";
import { type ReadFile, joined } from "./joining";
import type { Samples } from "../own-records";
import { repr } from "./python";
import { type EventRecord, asRecord, peakOf, readComponent } from "./reading";

/** A file as the page sends it: its content is in base64. */
interface SentFile {
  readonly name: string;
  readonly content: string;
}

/** Sizes of numbers other than zero that can be computed with. */
const [SMALLEST, LARGEST] = [1e-30, 1e15];

/** Basis and prime of FNV-1a, and another pair. */
const SEEDS = [
  [0x811c9dc5, 0x01000193],
  [0x9dc5811c, 0x85ebca6b],
] as const;

/** What is read: the answer to the page, and the samples. */
export interface Upload {
  readonly received: UploadedRecord;
  readonly samples: Samples;
}

/** Reads an upload; its argument is that of `Source.sendRecord`. */
export async function readUpload(body: Part): Promise<Upload> {
  const files = body["files"] as unknown as readonly SentFile[];
  const step = stepOf(body["step"] ?? null);
  const units = typeof body["units"] === "string" ? body["units"] : null;
  if (new Set(files.map((file) => file.name)).size < files.length) {
    throw new Refused(422, ["files: the names must be different. Rename a file."]);
  }
  const read: ReadFile[] = [];
  for (const { name, content } of files) read.push({ name, content: await componentOf(name, content, step) });
  const record = recordOf(read, units);
  const upload = identity([repr(units), repr(step), ...files.flatMap(({ name, content }) => [name, content])]);
  return { received: reported(upload, record), samples: samplesOf(record) };
}

function stepOf(given: Value): number | null {
  if (given === null) return null;
  if (typeof given !== "number") throw new Refused(422, ["step: Input should be a valid number"]);
  const size = Math.abs(given);
  if (given !== 0 && !(SMALLEST <= size && size <= LARGEST)) {
    const range = `zero or between ${general(SMALLEST, 6)} and ${general(LARGEST, 6)} in size`;
    throw new Refused(422, [`step must be ${range}, got ${repr(given)}`]);
  }
  if (given <= 0) throw new Refused(422, [`step must be positive, got ${repr(given)} s`]);
  return given;
}

/** Reads a file; a refusal waits for the other files, in whose order it is reported. */
async function componentOf(name: string, content: string, step: number | null): Promise<ReadFile["content"]> {
  try {
    return readComponent(await textOf(name, content), step);
  } catch (error) {
    if (error instanceof Refused) return error;
    throw error;
  }
}

function recordOf(read: readonly ReadFile[], units: string | null): EventRecord {
  const [first, ...others] = read;
  if (!first || others.length > 0) return joined(read, units);
  if (first.content instanceof Refused) throw first.content;
  return asRecord(first.content, first.name, units, null);
}

function samplesOf({ axes, length, step }: EventRecord): Samples {
  const values = new Float64Array(3 * length);
  AXES.forEach((axis, place) => axes[axis]?.forEach((value, k) => (values[3 * k + place] = value)));
  return { values, step };
}

function reported(upload: string, record: EventRecord): UploadedRecord {
  const { name, length, step, provenance } = record;
  const peaks = AXES.map((axis) => [axis, peakOf(record.axes[axis] ?? new Float64Array())] as const).filter(
    ([, peak]) => peak > 0,
  );
  return {
    ...{ upload, name, samples: length, step, duration: step * (length - 1), provenance },
    peaks: Object.fromEntries(peaks),
    warnings: [
      ...new Set([
        ...record.warnings,
        ...missingComponents(
          record,
          peaks.map(([axis]) => axis),
        ),
      ]),
    ],
  };
}

/** Returns the warning about a record without acceleration or without two horizontal components. */
function missingComponents({ name, provenance }: EventRecord, moving: readonly string[]): string[] {
  const flat = moving.filter((axis) => axis !== "z");
  if (flat.length > 1) return [];
  const files = [...provenance.join("\n").matchAll(/read from (.*?), in /g)].map((found) => found[1]).join(", ");
  if (moving.length === 0) return [`${name}: all accelerations are zero (${files || "no file"}). Check the files`];
  const what = flat.length > 0 ? "one horizontal component" : "a vertical component and no horizontal one";
  const remedy = "List the files of the event together, or set one_component if one is meant";
  return [`${name}: ${what} (${files || "no file"}). ${remedy}`];
}

/** Returns an identity of texts, which is no digest of the server: two hashes of 32 bits as FNV-1a forms them. */
function identity(texts: readonly string[]): string {
  const all = texts.join("\0");
  const hashes = SEEDS.map(([begin, factor]) => {
    let hash: number = begin;
    for (let k = 0; k < all.length; k += 1) hash = Math.imul(hash ^ all.charCodeAt(k), factor);
    return (hash >>> 0).toString(16).padStart(8, "0");
  });
  return `page-${hashes.join("")}`;
}
