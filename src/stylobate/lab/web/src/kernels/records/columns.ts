/** The accelerations in the columns of a table, found by their names or by their number. */

import { AXES, type Direction, alongAxes, isOneSet, parsedDirection, splitName } from "./directions";
import { repr } from "./python";
import { TIMES, type TextTable } from "./tables";
import type { Component, RecordText, Row } from "./text";
import { equalSteps, requireTwo } from "./time-steps";
import { SECOND, type TimeUnit, timeUnitOf, unitOf, unknownUnit } from "./units";

const ACCELERATION = ["acceleration", "accel", "acc", "a"];
/** Single letters that are a velocity, a length, a time or a radius unless they fit the directions of others. */
const UNSURE = ["v", "l", "t", "r"];
const AXIS_NAMES: readonly string[] = AXES.flatMap((axis) => [axis, `a${axis}`]);
const NO_NUMBERS = "the file has no numbers. Export it again";
const NO_DIRECTION: Direction = { azimuth: null, vertical: 0, axis: null };

/** Reads a table without names: a column of accelerations, or times and accelerations. */
export function readTable({ text, rows }: TextTable, step: number | null): Component {
  const [first] = rows;
  if (!first) throw text.fault(text.lines.length - 1, NO_NUMBERS);
  const width = first[1].length;
  if (width > 4) {
    requireNumbers(text, first);
    const wanted = "one (acceleration) to four (time, x, y, z) are expected. Name them in the first line";
    throw text.fault(first[0], `${width} columns: ${wanted}`);
  }
  for (const row of rows) {
    if (row[1].length === width) continue;
    requireNumbers(text, row);
    throw text.fault(row[0], `${row[1].length} columns, the lines before have ${width}. Correct the line`);
  }
  const columns = text.columns(rows, [...first[1].keys()]);
  const places = rows.map(([at]) => at);
  const rest = { unit: null, direction: null, title: "", statesTimeUnit: false };
  if (width === 1) {
    if (step === null) throw text.fault(first[0], "a single column has no time step: state step, in s");
    requireTwo(text, places);
    return { columns, step, start: 0, ...rest };
  }
  const [times = new Float64Array(), ...accelerations] = columns;
  const [start, own] = equalSteps(text, times, places, step);
  if (accelerations.length === 1) return { columns: accelerations, step: own, start, ...rest };
  requireNoIntegral(text, places[0]!, accelerations, own);
  const title = `columns 2 to ${width} as ${["x", "y", "z"].slice(0, width - 1).join(", ")}`;
  const nothing = new Float64Array(times.length);
  return { columns: [0, 1, 2].map((place) => accelerations[place] ?? nothing), step: own, start, ...rest, title };
}

/** Correlation with the integral of the column before from which a column counts as a velocity, and how many samples. */
const [ALIKE, FEW] = [0.98, 20];

/** Refuses a column that is the integral of the one before: velocity and displacement, no components. */
function requireNoIntegral(text: RecordText, line: number, columns: readonly Float64Array[], step: number): void {
  columns.slice(1).forEach((after, place) => {
    let sum = 0;
    const gained = centred(columns[place]!.map((value) => (sum += step * value)));
    const own = centred(after);
    const [both, size] = [dot(gained, own), Math.sqrt(dot(gained, gained) * dot(own, own))];
    if (after.length <= FEW || !(size > 0) || !(both > ALIKE * size)) return;
    const what = `column ${place + 3} looks like the integral of column ${place + 2}, a velocity or displacement`;
    throw text.fault(line, `${what}. Name the columns in the first line, such as time, x and velocity`);
  });
}

function centred(values: Float64Array): Float64Array {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
  return values.map((value) => value - mean);
}

function dot(one: Float64Array, other: Float64Array): number {
  return one.reduce((sum, value, i) => sum + value * other[i]!, 0);
}

function requireNumbers(text: RecordText, [at, fields]: Row): void {
  for (const field of fields) text.number(at, field);
}

/** Reads a table with names such as `time [s],x [m/s²],y [m/s²]`; `step` [s] is for one without times. */
export function readNamedColumns(
  { text, rows, namesAt }: TextTable,
  header: readonly string[],
  step: number | null,
): Component {
  const parts = header.map((name) => /^([^[(]*)(?:[[(]([^\])]*)[\])]\s*)?$/.exec(name));
  const names = parts.map((found) => found?.[1]?.trim() ?? "");
  const units = parts.map((found) => found?.[2] ?? null);
  const chosen = chosenAmong(text, namesAt, names);
  for (const [at, fields] of rows) {
    if (fields.length === names.length) continue;
    throw text.fault(at, `${fields.length} columns, the first line names ${names.length}. Correct the line`);
  }
  const values = text.columns(rows, [...chosen.values()]);
  if (rows.length === 0) throw text.fault(namesAt, NO_NUMBERS);
  const columns = new Map([...chosen.keys()].map((name, k) => [name, values[k] ?? new Float64Array()]));
  const times = columns.get("time");
  columns.delete("time");
  const clock = times ? timeUnitIn(text, namesAt, units[chosen.get("time") ?? NaN] ?? null) : null;
  if (!times && step === null) throw text.fault(namesAt, "no column of times: state step, the time step in s");
  const places = rows.map(([at]) => at);
  const [start, own] = times ? equalSteps(text, times, places, step, clock ?? SECOND) : [0, step ?? NaN];
  const others = [...chosen].filter(([name]) => name !== "time").map(([, place]) => place);
  const unit = unitAmong(text, namesAt, new Map(others.map((place) => [names[place] ?? "", units[place] ?? null])));
  return { ...componentsOf(text, columns), step: own, start, unit, statesTimeUnit: clock !== null };
}

function componentsOf(
  text: RecordText,
  columns: ReadonlyMap<string, Float64Array>,
): Pick<Component, "columns" | "direction" | "title"> {
  let [axes, title]: [Readonly<Record<string, Float64Array>>, string] = [Object.fromEntries(columns), ""];
  if (![...columns.keys()].every((name) => (AXES as readonly string[]).includes(name))) {
    const directed = [...columns].map(([label, samples]) => {
      return { label, direction: directionIn(label) ?? NO_DIRECTION, samples };
    });
    const [first] = directed;
    if (first && directed.length === 1) return { columns: [first.samples], direction: first.direction, title };
    ({ axes, origin: title } = alongAxes(text.name, directed));
  }
  const x = axes["x"];
  if (x && Object.keys(axes).length === 1) return { columns: [x], direction: null, title };
  const rest = new Float64Array([...columns.values()][0]?.length ?? 0);
  return { columns: AXES.map((axis) => axes[axis] ?? rest), direction: null, title };
}

/** Returns the direction that the name of a column states, such as NS or acc_NS. */
function directionIn(name: string): Direction | null {
  return parsedDirection(name) ?? splitName(name).direction;
}

// Choice of columns, by time, axes and directions

type Chosen = ReadonlyMap<string, number>;

function chosenAmong(text: RecordText, line: number, names: readonly string[]): Chosen {
  const lower = names.map((name) => name.toLowerCase());
  const time = TIMES.map((name) => lower.indexOf(name)).find((place) => place >= 0);
  const others = [...names.keys()].filter((place) => place !== time);
  const accelerations = others.filter((place) => ACCELERATION.includes(lower[place] ?? ""));
  const components = accelerations.length > 0 ? new Map() : componentsAmong(text, line, names, others);
  const likely = accelerations.length > 0 ? accelerations : others;
  const [only] = likely;
  const spelled = others.some((place) => spellsDirection(names[place] ?? ""));
  if (components.size === 0 && (only === undefined || likely.length > 1 || spelled)) {
    const question = `which of ${names.join(", ")} is the acceleration?`;
    throw text.fault(line, `${question} state columns, or name it x or acceleration`);
  }
  const times: [string, number][] = time === undefined ? [] : [["time", time]];
  return new Map([...times, ...(components.size > 0 ? components : [["x", only ?? NaN] as const])]);
}

/** Returns the columns whose names state an axis, else a direction; none if both kinds are mixed. */
function componentsAmong(text: RecordText, line: number, names: readonly string[], places: readonly number[]): Chosen {
  const name = (place: number): string => names[place] ?? "";
  const onAxes = places.filter((place) => AXIS_NAMES.includes(name(place).toLowerCase()));
  const axes = new Map(onAxes.map((place) => [name(place).toLowerCase().slice(-1), place]));
  const directed = directedAmong(names, places);
  if (axes.has("x") || axes.has("y") || (axes.size > 0 && directed.size < 2)) {
    requireDistinct(
      text,
      line,
      onAxes.map((place) => [name(place), name(place).toLowerCase().slice(-1)]),
    );
    // velocities and displacements such as vel_NS may stand beside axes
    const rest = places.filter((place) => !onAxes.includes(place) && name(place).length > 1);
    return rest.some((place) => parsedDirection(name(place))) ? new Map() : axes;
  }
  requireDistinct(
    text,
    line,
    places.map((place) => [name(place), lineOf(name(place))]),
  );
  return directed;
}

/** Returns whether a name of more than one letter is an axis or a direction. */
function spellsDirection(name: string): boolean {
  return name.length > 1 && (AXIS_NAMES.includes(name.toLowerCase()) || directionIn(name) !== null);
}

/** Returns the line along which a column acts, whatever its sign, as a text; null if its name does not state one. */
function lineOf(name: string): string | null {
  if (UNSURE.includes(name.toLowerCase())) return `name ${name}`;
  const way = directionIn(name);
  if (way === null) return null;
  return `${way.vertical !== 0} ${way.azimuth === null ? null : way.azimuth % 180} ${way.axis}`;
}

/** Refuses two columns, each with its name, that state one component. */
function requireDistinct(
  text: RecordText,
  line: number,
  components: readonly (readonly [name: string, component: string | null])[],
): void {
  for (const [, component] of components) {
    const same = components.filter(([, other]) => other === component).map(([name]) => name);
    if (component === null || same.length < 2) continue;
    const remedy = new Set(same).size === 1 ? "Rename or remove one" : "State columns, or rename or remove one";
    throw text.fault(line, `columns for one component: ${same.map(repr).join(", ")}. ${remedy}`);
  }
}

/** Returns the columns whose names state a direction; an unsure letter only if it fits the others or is alone. */
function directedAmong(names: readonly string[], places: readonly number[]): Chosen {
  const found = new Map(places.map((place) => [names[place] ?? "", place]));
  for (const name of found.keys()) if (!directionIn(name)) found.delete(name);
  if (places.length === 1) return found;
  const without = (left: (name: string) => boolean): Chosen => new Map([...found].filter(([name]) => !left(name)));
  for (const some of [found, without((name) => UNSURE.includes(name.toLowerCase()))]) {
    if (some.size > 1 && isOneSet([...some.keys()].flatMap((name) => directionIn(name) ?? []))) return some;
  }
  return without((name) => name.length < 2);
}

// Units of columns

function timeUnitIn(text: RecordText, line: number, unit: string | null): TimeUnit | null {
  if (unit === null) return null;
  const known = timeUnitOf(unit);
  if (known) return known;
  const remedy = "Convert the times to s, ms, µs or min, and state that unit";
  throw text.fault(line, `unknown unit of time ${repr(unit)}. ${remedy}`);
}

function unitAmong(text: RecordText, line: number, units: ReadonlyMap<string, string | null>): string | null {
  const stated = [...units.values()].flatMap((unit) => unit ?? []);
  const unknown = stated.find((unit) => unitOf(unit) === null);
  if (unknown !== undefined) throw text.fault(line, unknownUnit(unknown));
  const known = new Set(stated.map(unitOf));
  if (known.size < 2) return [...known][0] ?? null;
  const listed = [...units.values()].map(repr).join(", ");
  throw text.fault(line, `columns of different units: ${listed}. Convert them to one unit`);
}
