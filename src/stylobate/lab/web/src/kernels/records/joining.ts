/** Records from the files of an event: two horizontal components and a vertical one. */

import { Refused } from "../../page/server/source";
import { general } from "../general";
import {
  type Directed,
  type Direction,
  agree,
  alongAxes,
  inWords,
  parsedDirection,
  remarkOf,
  splitName,
  stemOf,
} from "./directions";
import { trimmedEnd, words } from "./python";
import { baseOf } from "./archive";
import { type EventRecord, asRecord } from "./reading";
import type { Component } from "./text";

const SAME_STEP = 1e-9;
/** Lost fraction of the Arias intensity that is worth a warning; the tail of a record is usually below. */
const REMARKABLE = 0.01;
/** Length of a common part of names that is too short for a name. */
const SHORTEST_NAME = 3;
/** The number of a record in the PEER databases. */
const RECORD_NUMBER = /(?:^|[-_. ])(?:RSN|NGA[-_]no)[-_]?0*(\d+)(?!\d)/i;
const DATE = /\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}|\b(?:19|20)\d\d\b/;

/** A file of an event: its component or the refusal to read it. */
export interface ReadFile {
  readonly name: string;
  readonly content: Component | Refused;
}

interface EventFile extends ReadFile {
  /** The name without format and direction. */
  readonly event: string;
  /** The direction from the header or the name; null if it is unknown. */
  readonly direction: Direction | null;
  /** Event, date and station in the header; empty if missing. */
  readonly title: string;
}

interface Part {
  readonly file: EventFile;
  readonly record: EventRecord;
}

/** Joins two or three files of one event to a record. */
export function joined(files: readonly ReadFile[], units: string | null): EventRecord {
  const described = files.map(eventFile);
  const event = commonName(described.map((file) => file.event));
  const parts = described.sort(order).map((file) => {
    if (file.content instanceof Refused) throw file.content;
    const { columns } = file.content;
    const component = { ...file.content, direction: null };
    return { file, record: asRecord(component, file.name, units, columns.length > 1 ? null : "x") };
  });
  for (const { file, record } of parts) requireDirection(file, Object.keys(record.axes).length);
  requireOneStep(event, parts);
  const length = Math.min(...parts.map(({ record }) => record.length));
  const { axes, origin } = alongAxes(
    event,
    parts.map((part) => directed(part, length)),
  );
  const step = parts[0]?.record.step ?? NaN;
  const warnings = [titlesDiffer(event, files.map(eventFile)), ...parts.map(({ record }) => record.warnings)];
  return {
    ...{ axes, length, step, name: event },
    provenance: [...parts.flatMap(({ record }) => record.provenance), ...trimming(parts, length), origin],
    warnings: [...warnings.flat(), ...lostShaking(event, parts, length)],
  };
}

/** Groups files of an archive into events, by number, title or name; returns the files of each by its name. */
export function eventsIn(files: readonly ReadFile[]): ReadonlyMap<string, readonly ReadFile[]> {
  const groups = groupedBy(keyOf, files).flatMap(copiesIn);
  const named = groups.map((group) => [commonName(group.map(eventOf)), group] as const);
  const count = (name: string): number => named.filter(([other]) => other === name).length;
  const path = (group: readonly ReadFile[]): string => (group[0]?.name ?? "").replace(/^[^/]*\//, "");
  const sorted = named.sort(([one], [other]) => (one < other ? -1 : Number(one > other)));
  return new Map(sorted.map(([name, group]) => [count(name) === 1 ? name : path(group), group]));
}

function groupedBy(key: (file: ReadFile) => string, files: readonly ReadFile[]): readonly (readonly ReadFile[])[] {
  const groups = new Map<string, ReadFile[]>();
  for (const file of files) groups.set(key(file), [...(groups.get(key(file)) ?? []), file]);
  return [...groups.values()];
}

/** Returns a group, or the copies of one set of components in it, in other folders or with other names. */
function copiesIn(group: readonly ReadFile[]): readonly (readonly ReadFile[])[] {
  const direction = (file: ReadFile): string => {
    const { direction: found } = eventFile(file);
    return found ? inWords(found) : "";
  };
  for (const key of [folderOf, eventOf]) {
    const copies = groupedBy(key, group);
    const ways = new Set(copies.map((copy) => copy.map(direction).sort().join("; ")));
    if (copies.length > 1 && ways.size === 1 && group.every((file) => direction(file) !== "")) {
      return copies.flatMap(copiesIn);
    }
  }
  return [group];
}

function folderOf({ name }: ReadFile): string {
  return name.slice(0, name.lastIndexOf("/"));
}

function eventOf(file: ReadFile): string {
  const header = file.content instanceof Refused ? null : file.content.direction;
  return namedParts(stemOf(file.name), header).event;
}

function keyOf(file: ReadFile): string {
  const stem = stemOf(file.name);
  const title = file.content instanceof Refused ? "" : titleIn(file.content.title);
  const number = RECORD_NUMBER.exec(stem)?.[1];
  if (number !== undefined) return `number ${Number(number)}${remarkOf(stem)}`;
  return title === "" ? `name ${folderOf(file)}/${eventOf(file)}` : `title ${title}/${eventOf(file)}`;
}

// The event and the direction of each file, by name and header

function eventFile({ name, content }: ReadFile): EventFile {
  const stem = stemOf(name);
  const component = content instanceof Refused ? null : content;
  const several = component !== null && component.columns.length > 1;
  const header = component?.direction ?? null;
  const named = several ? { event: stem, direction: null } : namedParts(stem, header);
  const found = { event: named.event, direction: header ?? named.direction };
  const unsure = splitName(stem, true); // among others of its event a weak sign suffices
  return {
    ...{ name, content, title: several ? "" : titleIn(component?.title ?? "") },
    ...(found.direction || !unsure.direction ? found : unsure),
  };
}

/** Returns event and direction of a name; if the header contradicts, the ending is no direction. */
function namedParts(stem: string, header: Direction | null): { event: string; direction: Direction | null } {
  const all = parsedDirection(stem);
  if (all && !/^\d/.test(stem)) return { event: stem, direction: all };
  const sure = splitName(stem);
  const named = sure.direction === null && header !== null ? splitName(stem, true) : sure;
  const contradicted = named.direction && header && !agree(named.direction, header);
  return contradicted ? { event: stem, direction: null } : named;
}

/** Returns event, date and station of a title such as "Loma Prieta, 10/18/1989, Corralitos, 90". */
function titleIn(header: string): string {
  const comma = header.lastIndexOf(",");
  const title = header.slice(0, Math.max(0, comma));
  if (!parsedDirection(header.slice(comma + 1)) || !DATE.test(title)) return "";
  return words(title.toLowerCase()).join(" ");
}

function commonName(events: readonly string[]): string {
  const [first = "", ...others] = events;
  if (others.every((other) => other === first)) return first;
  let length = 0;
  while (length < first.length && others.every((other) => other[length] === first[length])) length += 1;
  const common = trimmedEnd(first.slice(0, length), "-_. ");
  return common.length < SHORTEST_NAME ? first : common;
}

/** Orders files by azimuth, x before y, the vertical last. */
function order({ direction: one }: EventFile, { direction: other }: EventFile): number {
  const vertical = Number((one?.vertical ?? 0) !== 0) - Number((other?.vertical ?? 0) !== 0);
  const azimuth = (one?.azimuth ?? 0) - (other?.azimuth ?? 0);
  return vertical || azimuth || (one?.axis ?? "").localeCompare(other?.axis ?? "");
}

function requireDirection({ name, direction }: EventFile, axes: number): void {
  if (axes > 1) throw new Refused(422, [`${name}: it has the components of an event already. List it alone`]);
  if (direction) return;
  const state = "State directions, its azimuth in degrees or up, or end its name with it, such as _NS, _090 or _UP";
  throw new Refused(422, [`${name}: its direction is unknown. ${state}`]);
}

function titlesDiffer(event: string, files: readonly EventFile[]): string[] {
  const titles = new Map(files.filter((file) => file.title !== "").map((file) => [file.title, file.name]));
  if (titles.size < 2) return [];
  const headers = [...titles].map(([title, name]) => `${name} (${title})`).join(", ");
  const problem = `the headers name different events or stations: ${headers}`;
  return [`${event}: ${problem}. List the files of each event together`];
}

// One step and one length

function directed({ file, record }: Part, length: number): Directed {
  const samples = (record.axes.x ?? new Float64Array()).subarray(0, length);
  return { label: baseOf(file.name), direction: file.direction as Direction, samples };
}

function requireOneStep(event: string, parts: readonly Part[]): void {
  const finest = Math.min(...parts.map(({ record }) => record.step));
  if (parts.every(({ record }) => Math.abs(record.step / finest - 1) <= SAME_STEP)) return;
  const listed = parts.map(({ file, record }) => `${file.name} ${general(record.step, 6)} s`).join(", ");
  const remedy = "state steps to be resampled, or make them alike";
  throw new Refused(422, [`${event}: time steps differ (${listed}); ${remedy}`]);
}

function trimming(parts: readonly Part[], length: number): string[] {
  if (parts.every(({ record }) => record.length === length)) return [];
  const listed = parts.map(({ file, record }) => `${file.name} ${record.length}`).join(", ");
  return [`trimmed to ${length} samples: ${listed}`];
}

function lostShaking(event: string, parts: readonly Part[], length: number): string[] {
  return parts.flatMap(({ file, record: { axes, step, length: whole } }) => {
    const lost = length < whole ? lostIntensity(axes.x ?? new Float64Array(), step, length) : 0;
    if (lost <= REMARKABLE) return [];
    const spans = [whole, length].map((count) => `${general(step * (count - 1), 6)} s`).join(" to ");
    const remedy = "Set lengths to pad, or check that the files are of one event";
    const loss = `loses ${general(100 * lost, 3)} % of its Arias intensity`;
    return [`${event}: ${file.name} is trimmed from ${spans} and ${loss}. ${remedy}`];
  });
}

/** Returns the fraction of the Arias intensity after the first `kept` samples. */
function lostIntensity(samples: Float64Array, step: number, kept: number): number {
  let [sum, before] = [0, 0];
  for (let k = 1; k < samples.length; k += 1) {
    const [left, right] = [samples[k - 1] ?? NaN, samples[k] ?? NaN];
    sum += (step / 3) * (left ** 2 + left * right + right ** 2);
    if (k === kept - 1) before = sum;
  }
  return sum > 0 ? 1 - before / sum : 0;
}
