/** A record from one file, in SI units. */

import { Refused } from "../../page/server/source";
import { general } from "../general";
import { baseOf } from "./archive";
import { isAt2, isWrapped, readAt2 } from "./at2";
import { readNamedColumns, readTable } from "./columns";
import { isCalledAt2 } from "./content";
import { AXES, type AlongAxes, type Axis, inWords } from "./directions";
import { tableOf } from "./tables";
import { type Component, REMARKS, type RecordText, notReadHere } from "./text";
import { STANDARD_GRAVITY, scaleOf } from "./units";

/** Accelerations of an event, with their origin and possible mistakes. */
export interface EventRecord {
  readonly axes: AlongAxes;
  readonly length: number;
  /** [s]. */
  readonly step: number;
  readonly name: string;
  readonly provenance: readonly string[];
  readonly warnings: readonly string[];
}

/** Horizontal and vertical peaks of earthquakes are below, except a few close to the fault [g]. */
const LARGEST_PEAK = 3;
/** Longest step and duration of an accelerogram that are likely [s]. */
const [LONGEST_STEP, LONGEST_DURATION] = [0.5, 7200];
/** Limits of readable numbers: steps [s], and accelerations in any unit. */
const LIMITS = { "a time step [s]": [1e-9, 1e6], "a peak": [0, 1e30] } as const;
const TOO_SHORT = "samples must be numbers of shape (n,) or (n, 1 to 3) with n of at least 2";
const ASC_KEYS = ["SAMPLING_INTERVAL_S", "NDATA", "DATA_TYPE", "STREAM", "UNITS", "HEADER_FORMAT"];

/** Reads the component of a file in the units of the file; `step` [s] is for a file that states none. */
export function readComponent(text: RecordText, step: number | null): Component {
  if (text.lines[0]?.startsWith("Origin Time")) throw notReadHere(text.name, "K-NET files");
  if (text.lines.every((line) => line.trim() === "" || line.trimStart().startsWith(REMARKS[0]))) {
    throw text.fault(text.lines.length - 1, "the file has no numbers. Export it again");
  }
  if (isAt2(text) || (isCalledAt2(text.name) && isWrapped(text))) return readAt2(text, step);
  if (isAsc(text)) throw notReadHere(text.name, "ASC files of ESM and ITACA");
  const table = tableOf(text);
  return table.names === null ? readTable(table, step) : readNamedColumns(table, table.names, step);
}

/** Returns whether a file begins with the header of an ASC file, of lines such as `NDATA: 4000`. */
function isAsc(text: RecordText): boolean {
  const keys = new Set<string>();
  for (const line of text.lines) {
    const key = /^([A-Z][A-Z0-9_/^.%]*)\s*:/.exec(line)?.[1];
    if (key === undefined && line.trim() !== "") break;
    if (key !== undefined && ASC_KEYS.includes(key)) keys.add(key);
  }
  return keys.size > 1;
}

/** Converts the component of a file; `axis` is that of a single one, null for the direction that its file states. */
export function asRecord(component: Component, file: string, units: string | null, axis: Axis | null): EventRecord {
  const { columns, step, title, direction } = component;
  const [factor, unit] = scaleOf(file, component.unit, units);
  const peak = Math.max(...columns.map(peakOf));
  requirePossible(file, { "a time step [s]": step, "a peak": peak });
  if (component.start !== 0)
    throw notReadHere(file, `times that begin at ${general(component.start, 6)} s and not at 0 s`);
  const length = columns[0]?.length ?? 0;
  if (length < 2) throw new Refused(422, [`${TOO_SHORT}, got (${length}, 3)`]);
  const warnings = [...strongPeak(file, (factor * peak) / STANDARD_GRAVITY, unit), ...unlikelyTimes(file, component)];
  const up = direction?.vertical ?? 0;
  const along = axis ?? (up === 0 ? "x" : "z");
  const turned = up < 0 && along === "z";
  const provenance = [`read from ${file}, ${unit}${title === "" ? "" : `: ${title}`}`];
  if (columns.length === 1 && direction) {
    provenance.push(`${inWords(direction)} along ${along}${turned ? " with its sign turned" : ""}`);
  }
  const scaled = columns.map((values) => values.map((value) => (turned ? -factor : factor) * value));
  const named = columns.length === 1 ? [along] : AXES;
  return {
    axes: Object.fromEntries(scaled.map((values, k) => [named[k] ?? along, values])),
    ...{ length, step, provenance, warnings, name: nameOf(file) },
  };
}

export function peakOf(values: Float64Array): number {
  return values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
}

function requirePossible(file: string, numbers: Record<keyof typeof LIMITS, number>): void {
  for (const [what, [least, most]] of Object.entries(LIMITS)) {
    const value = numbers[what as keyof typeof LIMITS];
    if (least <= value && value <= most) continue;
    const range = `${what} must be between ${general(least, 6)} and ${general(most, 6)}`;
    throw new Refused(422, [`${file}: ${range}, got ${general(value, 6)}. Check the numbers`]);
  }
}

function strongPeak(file: string, peak: number, unit: string): string[] {
  if (peak <= LARGEST_PEAK) return [];
  return [
    `${file}: its peak is ${general(peak, 3)} g, read ${unit}; hardly any earthquake shakes the ground beyond ` +
      `${LARGEST_PEAK} g: if the file is in another unit, such as cm/s², name that (units)`,
  ];
}

function unlikelyTimes(file: string, { step, columns, statesTimeUnit }: Component): string[] {
  const duration = step * ((columns[0]?.length ?? 0) - 1);
  if (statesTimeUnit || (step <= LONGEST_STEP && duration <= LONGEST_DURATION)) return [];
  const read = `the step read in s is ${general(step, 6)} s, the duration ${general(duration, 5)} s`;
  const remedy =
    "State the unit beside the name of the times, such as time [ms] or time [s], or give times and step in s";
  return [`${file}: check the unit of time: ${read}. ${remedy}`];
}

/** Returns the name of a file without suffixes. */
function nameOf(file: string): string {
  const name = baseOf(file).replace(/\.gz$/, "");
  return name.slice(0, Math.max(0, name.lastIndexOf("."))) || name;
}
