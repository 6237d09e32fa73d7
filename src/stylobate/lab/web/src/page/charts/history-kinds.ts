/** What can be drawn over the time of a run: its quantities, as far as its model tells them. */

import type { Answer, Numbers, Series } from "../server/answers";
import { told } from "../frame/format";

/** A level that a quantity is held against. */
export interface Level {
  readonly value: number;
  readonly told: string;
}

/** A quantity over time, ready to be drawn. */
export interface History {
  readonly name: HistoryName;
  /** Name of the axis, with its unit. */
  readonly label: string;
  readonly colour: string;
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
  friction_demand: "Friction needed at the contact",
  pivoting_demand: "Pivoting moment needed",
  normal_force: "Normal force",
  displacement_x: "Displacement on the base along x",
  displacement_y: "Displacement on the base along y",
  slip_speed: "Slip speed of the contact",
  clearance: "Clearance from the base",
  base_x: "Base acceleration along x",
  base_y: "Base acceleration along y",
  base_z: "Base acceleration along z",
} as const;

export type HistoryName = keyof typeof HISTORIES;

export function isHistoryName(name: string): name is HistoryName {
  return Object.hasOwn(HISTORIES, name);
}

/** In units of c: what falls is seen to leave, and what came before is still seen. */
const FARTHEST = 2.5;
/** A tilt that no plot shows, in units of c: the column stands. */
const UPRIGHT = 1e-3;

/** Returns the quantities that are told of a run; `frequency` is that of its base motion [rad/s], where it has one. */
export function historiesOf(answer: Answer, frequency: number | null): readonly History[] {
  const made = MAKERS.map((make) => make(answer, frequency));
  return made.filter((one) => one !== null).filter((one) => one.values.some((value) => value !== null));
}

/** Returns the two quantities that tell most of a run: those of `wanted` that it has, else what suits it. */
export function chosenHistories(
  offered: readonly History[],
  wanted: readonly [HistoryName, HistoryName] | null,
): readonly [History | undefined, History | undefined] {
  const find = (name: HistoryName | undefined): History | undefined => offered.find((one) => one.name === name);
  const [above, below] = usualNames(offered);
  return [find(wanted?.[0]) ?? find(above), find(wanted?.[1]) ?? find(below)];
}

function usualNames(offered: readonly History[]): readonly [HistoryName, HistoryName | undefined] {
  const has = (name: HistoryName): boolean => offered.some((one) => one.name === name);
  const order: readonly HistoryName[] = ["friction_demand", "rolling_rate", "base_x", "base_y", "base_z"];
  const below = order.find(has);
  return [slidesOnly(offered) ? farthestMoved(offered) : "tilt", below];
}

/** Tells whether the column stands all the time and moves on its base: then its tilt tells nothing. */
function slidesOnly(offered: readonly History[]): boolean {
  const tilt = offered.find((one) => one.name === "tilt");
  return tilt !== undefined && largestOf(tilt.values) < UPRIGHT && reachOf(offered, farthestMoved(offered)) > 0;
}

function farthestMoved(offered: readonly History[]): HistoryName {
  const [x, y] = [reachOf(offered, "displacement_x"), reachOf(offered, "displacement_y")];
  return y > x ? "displacement_y" : "displacement_x";
}

function reachOf(offered: readonly History[], name: HistoryName): number {
  const [low, high] = offered.find((one) => one.name === name)?.limits ?? [0, 0];
  return high - low;
}

type Maker = (answer: Answer, frequency: number | null) => History | null;

const MAKERS: readonly Maker[] = [
  ({ series, column }) => {
    const values = scaled(series.amplitude, 1 / column.slenderness);
    const largest = largestOf(values);
    const level = largest > 0.7 ? { value: 1, told: "c" } : null;
    const limits = [0, Math.min(largest, FARTHEST)] as const;
    return { name: "tilt", label: "|θ|/c", colour: "blue", values, level, limits, note: `largest ${told(largest)} c` };
  },
  ({ series }, frequency) => {
    const made = signed("rolling_rate", "purple", "ψ̇", "rad/s", series.rolling_rate);
    const mean = middleOf(series.rolling_rate);
    if (frequency === null || made === null) return made;
    return { ...made, level: { value: mean < 0 ? -frequency : frequency, told: "Ω of the base" } };
  },
  ({ series }) => signed("spin", "purple", "spin", "rad/s", series.spin),
  ({ series, drawn }) => demand("friction_demand", "T/N", series, drawn.friction_coefficient),
  ({ series }) => demand("pivoting_demand", "M/(N r)", series, null),
  ({ series }) => {
    const made = signed("normal_force", "green", "N/(m g)", "", series.normal_force);
    return made && { ...made, level: { value: 1, told: "weight" } };
  },
  ({ series }) => length("displacement_x", "x", along(series.displacement, 0)),
  ({ series }) => length("displacement_y", "y", along(series.displacement, 1)),
  ({ series }) => signed("slip_speed", "vermilion", "|v|", "m/s", series.slip_speed),
  ({ series }) => length("clearance", "clearance", series.clearance),
  ...(["x", "y", "z"] as const).map(
    (axis, index): Maker =>
      ({ series }) => {
        const values = along(series.base_acceleration, index);
        if (values === null || values.every((value) => value === 0)) return null;
        return signed(`base_${axis}`, "muted", `a${axis}`, "m/s²", values);
      },
  ),
];

/** Friction or pivoting over what presses: where the column hardly presses, huge for an instant, and cut off. */
function demand(
  name: "friction_demand" | "pivoting_demand",
  label: string,
  series: Series,
  coefficient: number | null,
): History | null {
  const values = series[name];
  if (!values) return null;
  const largest = largestOf(values);
  const level = coefficient === null ? null : { value: coefficient, told: `friction coefficient ${told(coefficient)}` };
  const usual = Math.max(quantile(values, 0.99) * 1.2, (coefficient ?? 0) * 1.25);
  const limits = [0, Math.min(largest, usual) || (coefficient ?? 1)] as const;
  return { name, label, colour: "green", values, level, limits, note: `largest ${told(largest)}` };
}

/** A quantity of either sign; what it does in rare instants is cut off where it would hide the rest. */
function signed(
  name: HistoryName,
  colour: string,
  label: string,
  unit: string,
  values: Numbers | null | undefined,
): History | null {
  if (!values) return null;
  const [least, largest] = [-largestOf(scaled(values, -1)), largestOf(values)];
  const usual = 1.5 * quantile(values.map(magnitude), 0.99);
  const limits = [Math.max(least, -usual), Math.min(largest, usual)] as const;
  const note = least < 0 ? `${told(least)} to ${told(largest)} ${unit}` : `largest ${told(largest)} ${unit}`;
  return { name, label: unit ? `${label} [${unit}]` : label, colour, values, level: null, limits, note: note.trim() };
}

/** A length, in the unit in which its numbers are short. */
function length(name: HistoryName, label: string, values: Numbers | null | undefined): History | null {
  if (!values) return null;
  const fine = largestOf(values.map(magnitude)) < 0.1;
  const made = signed(name, "blue", label, fine ? "mm" : "m", fine ? scaled(values, 1000) : values);
  return made && { ...made, note: `${made.note}, at the end ${told(made.values.at(-1))}` };
}

function along(vectors: readonly (readonly (number | null)[])[] | null | undefined, index: number): Numbers | null {
  return vectors?.map((vector) => vector[index] ?? null) ?? null;
}

function scaled(values: Numbers, factor: number): Numbers {
  return values.map((value) => (value === null ? null : value * factor));
}

function magnitude(value: number | null): number | null {
  return value === null ? null : Math.abs(value);
}

function middleOf(values: Numbers): number {
  return quantile(values, 0.5);
}

export function largestOf(values: Numbers): number {
  return values.reduce<number>((most, value) => (value !== null && value > most ? value : most), 0);
}

export function quantile(values: Numbers, share: number): number {
  const known = values.filter((value): value is number => value !== null).sort((a, b) => a - b);
  return known[Math.floor(share * (known.length - 1))] ?? 0;
}
