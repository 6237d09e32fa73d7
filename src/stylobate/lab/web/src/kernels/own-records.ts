/** Records from the user's own files, which never leave the browser. */

import { type Part, type Value, isPart } from "../page/case/description";
import type { UploadedRecord } from "../page/server/schema";
import { Refused } from "../page/server/source";
import { general } from "./general";
import { textOf } from "./records/content";
import { AXES } from "./records/directions";
import { type ReadFile, joined } from "./records/joining";
import { repr } from "./records/python";
import { type EventRecord, asRecord, peakOf, readComponent } from "./records/reading";

/** Accelerations at equal steps. */
export interface Samples {
  /** x, y, z of one instant after the other [m/s²]. */
  readonly values: Float64Array;
  /** [s]. */
  readonly step: number;
}

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

/** A record that was read here, with the plain values by which Python reads its files. */
interface Held {
  readonly samples: Samples;
  readonly reading: Part;
}

export class OwnRecords {
  readonly #held = new Map<Value | undefined, Held>();

  /** Returns a description whose record, if it was read here, is that of its files. */
  shown(description: Part): Part {
    const motion = description["motion"];
    const held = isPart(motion) ? this.#held.get(motion["upload"]) : undefined;
    if (held === undefined || !isPart(motion)) return description;
    const { kind, upload, ...rest } = motion;
    return { ...description, motion: { ...held.reading, ...rest } };
  }

  /** Returns the samples of a record that was read here. */
  samples(upload: Value | undefined): Samples {
    const found = this.#held.get(upload);
    if (found) return found.samples;
    const short = repr(String(upload).slice(0, 12));
    throw new Refused(422, [`motion.upload: record ${short} is not stored (any more). Upload its files again.`]);
  }

  /** Reads the files of one event. */
  async add(body: Part): Promise<UploadedRecord> {
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
    const names = files.map((file) => file.name);
    const given = { ...(units === null ? {} : { units }), ...(step === null ? {} : { step }) };
    const path = names.length === 1 ? (names[0] ?? "") : names;
    const reading = { kind: "record", path, ...given, one_component: true };
    this.#held.set(upload, { samples: samplesOf(record), reading });
    return reported(upload, record);
  }
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
