/** What can be drawn over the time of a run: its quantities, as far as its model provides them. */

import type { Run as Answer, Series } from "../server/schema";
import type { Numbers } from "./plot-looks";
import { formatted, unitWritten, withUnit } from "../frame/format";
import { isDimensionless, isTaught, tiltScaling } from "../frame/units";

/** A level that a quantity is held against. */
export interface Level {
  readonly value: number;
  readonly label: string;
}

/** A quantity over time, ready to be drawn. */
export interface History {
  readonly name: HistoryName;
  /** Name of the axis, with its unit. */
  readonly label: string;
  readonly colour: string;
  /** Times of its values [s]: those of the samples, and of the extremes between them. */
  readonly time: readonly number[];
  readonly values: Numbers;
  readonly level: Level | null;
  /** What of it is drawn; the rest is cut off. */
  readonly limits: readonly [number, number];
  /** What stands beside it. */
  readonly note: string;
}

/** What a link and the page call each quantity, in the order in which they are offered. */
export const HISTORIES = {
  tilt: "Tilt",
  rolling_rate: "Rolling rate",
  spin: "Spin about the axis",
  friction_demand: "Friction demand",
  pivoting_demand: "Pivoting demand",
  normal_force: "Normal force",
  displacement_x: "Displacement on the base along x",
  displacement_y: "Displacement on the base along y",
  slip_speed: "Slip speed of the contact",
  clearance: "Clearance above the base",
  base_x: "Base acceleration along x",
  base_y: "Base acceleration along y",
  base_z: "Base acceleration along z",
} as const;

export type HistoryName = keyof typeof HISTORIES;
export type HistoryPair = readonly [HistoryName, HistoryName];

const NAMES = Object.keys(HISTORIES) as readonly HistoryName[];

export function isHistoryName(name: string): name is HistoryName {
  return Object.hasOwn(HISTORIES, name);
}

/** In units of c: what falls is seen to leave, and what came before is still seen. */
const FARTHEST = 2.5;
const OFF = ", off the scale";
/** A tilt that no plot shows, in units of c: the column stands. */
const UPRIGHT = 1e-3;

/** A run with its histories; `frequency` is that of the base motion [rad/s], where it has one. */
export interface RunShown {
  readonly answer: Answer;
  readonly frequency: number | null;
}

/** A second run beside the first, and what tells the two columns apart in words. */
export interface SecondRun {
  readonly run: RunShown;
  readonly labels: readonly [string, string];
}

/** The same quantity of a second run. */
export interface SecondHistory {
  readonly history: History;
  readonly labels: readonly [string, string];
}

/** Returns a quantity of a second run for the plot of the first; null where it has none, or both have the same. */
export function secondHistory(first: History, second: SecondRun | null): SecondHistory | null {
  if (second === null || first.name.startsWith("base_") || !offeredHistories(second.run).includes(first.name))
    return null;
  const history = historyOf(first.name, second.run);
  return history.label === first.label ? { history, labels: second.labels } : null;
}

/** Returns the quantities of a run; of the base, the directions in which it moves. */
export function offeredHistories({ answer: { series } }: RunShown): readonly HistoryName[] {
  return NAMES.filter((name) => {
    const { values, place } = SOURCES[name];
    const history = series[values] as Numbers | readonly Numbers[] | undefined;
    return history?.some((one) => known(one, place)) ?? false;
  });
}

function known(value: number | null | Numbers, place: number | null): boolean {
  return place === null ? value !== null : typeof value === "object" && Boolean(value?.[place]);
}

/** Returns the two most informative quantities of a run: those of `wanted` that it has, else what suits it. */
export function chosenHistories(run: RunShown, wanted: HistoryPair | null): readonly [HistoryName, HistoryName] {
  const offered = offeredHistories(run);
  const has = (name: HistoryName): boolean => offered.includes(name);
  const order: readonly HistoryName[] = ["friction_demand", "rolling_rate", "base_x", "base_y", "base_z"];
  const [above, below] = [usualAbove(run.answer), order.find(has) ?? "tilt"];
  if (wanted === null) return [above, below];
  return [has(wanted[0]) ? wanted[0] : above, has(wanted[1]) ? wanted[1] : below];
}

/** Where the column stands all the time and moves on its base its tilt is zero: then how far it came. */
function usualAbove({ series, column }: Answer): HistoryName {
  if (!series.displacement || largestOf(series.amplitude) >= UPRIGHT * column.slenderness) return "tilt";
  const [x, y] = ([0, 1] as const).map((place) => largestOf(along(series.displacement!, place).map(magnitude)));
  if (!x && !y) return "tilt";
  return y! > x! ? "displacement_y" : "displacement_x";
}

/** Returns a quantity of a run, ready to be drawn. */
export function historyOf(name: HistoryName, run: RunShown): History {
  const { time, values } = withExtremes(name, run.answer.series);
  return { ...shaped(name, values, run), time };
}

/** Returns the samples of a quantity with the extremes between them: so a chart shows no beat that is not there. */
function withExtremes(
  name: HistoryName,
  series: Series,
): { readonly time: readonly number[]; readonly values: Numbers } {
  const { values: source, place } = SOURCES[name];
  const found = series[source] ?? [];
  const values = place === null ? (found as Numbers) : along(found as readonly Numbers[], place);
  const extremes = series.extremes[place === null ? source : `${source}_${"xyz"[place]}`] ?? [];
  if (extremes.length === 0) return { time: series.time, values };
  const points = series.time.map((time, k): readonly [number, number | null] => [time, values[k] ?? null]);
  const all = [...points, ...extremes].sort((one, other) => one[0] - other[0]);
  return { time: all.map(([time]) => time), values: all.map(([, value]) => value) };
}

/** A history before it has its times. */
type Shaped = Omit<History, "time">;

function shaped(name: HistoryName, values: Numbers, { answer, frequency }: RunShown): Shaped {
  const { column, drawn } = answer;
  switch (name) {
    case "tilt":
      return tilt(values, column.slenderness);
    case "rolling_rate":
      return rollingRate(values, frequency);
    case "friction_demand":
      return demand(name, "T/N", values, drawn.friction_coefficient, answer.measures["peak_friction_demand"]);
    case "pivoting_demand":
      return demand(name, "M/(N r)", values, null, answer.measures["peak_pivoting_demand"]);
    case "normal_force":
      return { ...signed(name, "green", "N/(m g)", "", values), level: { value: 1, label: "weight" } };
    case "displacement_x":
      return length(name, "x", values);
    case "displacement_y":
      return length(name, "y", values);
    case "clearance":
      return length(name, "gap", values);
    case "slip_speed":
      return signed(name, "vermilion", "|v|", "m/s", values);
    case "spin":
      return signed(name, "purple", "spin", "rad/s", values);
    default:
      return signed(name, "muted", name.replace("base_", "a"), "m/s²", values);
  }
}

/** Where the numbers of each quantity stand: a history, and which of its components. */
const SOURCES: Readonly<Record<HistoryName, { readonly values: keyof Series; readonly place: number | null }>> = {
  tilt: { values: "amplitude", place: null },
  rolling_rate: { values: "rolling_rate", place: null },
  spin: { values: "spin", place: null },
  friction_demand: { values: "friction_demand", place: null },
  pivoting_demand: { values: "pivoting_demand", place: null },
  normal_force: { values: "normal_force", place: null },
  displacement_x: { values: "displacement", place: 0 },
  displacement_y: { values: "displacement", place: 1 },
  slip_speed: { values: "slip_speed", place: null },
  clearance: { values: "clearance", place: null },
  base_x: { values: "base_acceleration", place: 0 },
  base_y: { values: "base_acceleration", place: 1 },
  base_z: { values: "base_acceleration", place: 2 },
};

function tilt(values: Numbers, slenderness: number): Shaped {
  const { unit, factor } = tiltScaling(slenderness);
  const [shown, edge] = [scaled(values, factor), slenderness * factor];
  const largest = largestOf(shown);
  return {
    ...{ name: "tilt", label: isTaught() ? "tilt [°]" : "|θ|/c", colour: "blue", values: shown },
    note: `largest ${formatted(largest)}${unit}${largest > FARTHEST * edge ? OFF : ""}`,
    level: largest > 0.7 * edge ? { value: edge, label: isTaught() ? "balance" : "|θ| = c" } : null,
    limits: [0, Math.min(largest, FARTHEST * edge)],
  };
}

function rollingRate(values: Numbers, frequency: number | null): Shaped {
  const made = signed("rolling_rate", "purple", "β̇", "rad/s", values);
  if (frequency === null) return made;
  const backwards = quantile(values, 0.5) < 0;
  return { ...made, level: { value: backwards ? -frequency : frequency, label: "Ω of the base" } };
}

/** Friction or pivoting over what presses: where the column hardly presses, huge for an instant, and cut off. */
function demand(
  name: HistoryName,
  label: string,
  values: Numbers,
  coefficient: number | null,
  measured: number | null | undefined,
): Shaped {
  const largest = largestOf(values);
  // What is measured of a run is found between its samples too, where the contact bears most for a moment.
  const peak = measured === null ? Infinity : Math.max(measured ?? 0, largest);
  const usual = Math.max(quantile(values, 0.99) * 1.2, (coefficient ?? 0) * 1.25);
  const top = Math.min(peak, usual) || (coefficient ?? 1);
  const most = Number.isFinite(peak) ? formatted(peak) : "without bound";
  return {
    ...{ name, label, colour: "green", values, note: `largest ${most}${peak > top ? OFF : ""}` },
    level:
      coefficient === null ? null : { value: coefficient, label: `friction coefficient ${formatted(coefficient)}` },
    limits: [0, top],
  };
}

/** A quantity of either sign; what it does in rare instants is cut off where it would hide the rest. */
function signed(name: HistoryName, colour: string, label: string, unit: string, values: Numbers): Shaped {
  const [least, largest] = [-largestOf(scaled(values, -1)), largestOf(values)];
  const usual = 1.5 * quantile(values.map(magnitude), 0.99);
  const note = least < 0 ? `${formatted(least)} to ${withUnit(largest, unit)}` : `largest ${withUnit(largest, unit)}`;
  return {
    ...{ name, label: unit ? `${label} [${unitWritten(unit)}]` : label, colour, values, level: null, note },
    limits: [Math.max(least, -usual), Math.min(largest, usual)],
  };
}

/** A length, in the unit in which its numbers are short. */
function length(name: HistoryName, label: string, values: Numbers): Shaped {
  const fine = !isDimensionless() && largestOf(values.map(magnitude)) < 0.1;
  const made = signed(name, "blue", label, fine ? "mm" : "m", fine ? scaled(values, 1000) : values);
  return { ...made, note: `${made.note}, at the end ${formatted(made.values.at(-1))}` };
}

function along(vectors: readonly (readonly (number | null)[])[], place: number): Numbers {
  return vectors.map((vector) => vector[place] ?? null);
}

function scaled(values: Numbers, factor: number): Numbers {
  return values.map((value) => (value === null ? null : value * factor));
}

function magnitude(value: number | null): number | null {
  return value === null ? null : Math.abs(value);
}

export function largestOf(values: Numbers): number {
  return values.reduce<number>((most, value) => (value !== null && value > most ? value : most), 0);
}

export function quantile(values: Numbers, share: number): number {
  const known = values.filter((value): value is number => value !== null).sort((a, b) => a - b);
  return known[Math.floor(share * (known.length - 1))] ?? 0;
}
