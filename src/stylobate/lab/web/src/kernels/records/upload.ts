/** Reads the files of one event, as the server does: in a worker, since large files take seconds. */

import type { Part, Value } from "../../page/case/description";
import type { UploadedRecord } from "../../page/server/schema";
import { Refused } from "../../page/server/source";
import { general } from "../general";
import { baseOf, isZip, membersOf } from "./archive";
import { inLatin, textOf } from "./content";
import { AXES } from "./directions";
import { type ReadFile, eventsIn, joined } from "./joining";
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
  /** Names of the files of the record, below that of their archive. */
  readonly paths: readonly string[];
}

/** Reads an upload; its argument is that of `Source.sendRecord`. */
export async function readUpload(body: Part): Promise<Upload> {
  const files = body["files"] as unknown as readonly SentFile[];
  const step = stepOf(body["step"] ?? null);
  const units = typeof body["units"] === "string" ? body["units"] : null;
  if (new Set(files.map((file) => file.name)).size < files.length) {
    throw new Refused(422, ["files: the names must be different. Rename a file."]);
  }
  const wanted = typeof body["record"] === "string" ? body["record"] : null;
  const { read, records, warnings } = await eventIn(files, step, wanted);
  const record = recordOf(read, units);
  const given = [repr(units), repr(step), ...(wanted === null ? [] : [wanted])];
  const upload = identity([...given, ...files.flatMap(({ name, content }) => [name, content])]);
  const received = reported(upload, record);
  return {
    received: { ...received, warnings: [...warnings, ...received.warnings], records },
    samples: samplesOf(record),
    paths: read.map(({ name }) => name),
  };
}

interface EventFiles {
  readonly read: readonly ReadFile[];
  /** Names of the records in an archive. */
  readonly records: string[];
  readonly warnings: readonly string[];
}

/** Reads the files of an event: all, or those of the wanted record in an archive, of the first one if none is. */
async function eventIn(files: readonly SentFile[], step: number | null, wanted: string | null): Promise<EventFiles> {
  const [first] = files;
  const sent = first && files.length === 1 ? atob(first.content) : "";
  const read: ReadFile[] = [];
  if (!first || !isZip(sent)) {
    for (const { name, content } of files) read.push({ name, content: await componentOf(name, atob(content), step) });
    return { read, records: [], warnings: [] };
  }
  const others: Refused[] = [];
  for (const { name, bytes } of await membersOf(first.name, sent)) {
    const latin = inLatin(bytes);
    const content = await componentOf(name, latin, step);
    if (content instanceof Refused && !ROW_OF_NUMBERS.test(latin)) others.push(content);
    else read.push({ name, content });
  }
  const events = eventsIn(read);
  const [usual] = events.keys();
  if (usual === undefined) throw others[0] ?? new Refused(422, [`${first.name}: holds no record`]);
  const chosen = events.get(wanted ?? usual);
  if (chosen === undefined) {
    const listed = [...events.keys()].join(", ");
    const problem = `record: not in ${first.name} (got ${repr(wanted)})`;
    throw new Refused(422, [`${problem}. Use one of ${listed}.`]);
  }
  return { read: chosen, records: [...events.keys()], warnings: leftOut(first.name, others) };
}

/** A line that has a number and nothing else. */
const ROW_OF_NUMBERS = /^[ \t]*[-+]?[\d.][-+\d.,;eEdD \t]*\r?$/m;

/** Returns the warning about the files of an archive that hold no record. */
function leftOut(archive: string, others: readonly Refused[]): string[] {
  if (others.length === 0) return [];
  const names = others
    .map(({ problems }) => baseOf(/^(.*?)(?:, line \d+)?: /.exec(problems[0] ?? "")?.[1] ?? ""))
    .join(", ");
  const [hold, are] = others.length > 1 ? ["files hold", "are"] : ["file holds", "is"];
  return [`${archive}: ${others.length} ${hold} no record and ${are} left out: ${names}`];
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
async function componentOf(name: string, sent: string, step: number | null): Promise<ReadFile["content"]> {
  try {
    return readComponent(await textOf(name, sent), step);
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
    ...{ upload, name, samples: length, step, duration: step * (length - 1), provenance, records: [] },
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
