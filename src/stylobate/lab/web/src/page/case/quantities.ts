/** The numbers that maps and basins vary, where they stand in a description, and the ranges that suit them. */

import type { About, Parameter } from "./about";
import { kindNamed } from "./about";
import type { Description, PartName, Value } from "./description";
import { isVector, kindOf, PARTS } from "./description";
import { isPlanar } from "./in-one-plane";
import { niceAbove, niceBelow, SPREAD } from "./ranges";

const STARTS: Readonly<Record<string, readonly [string, 0 | 1]>> = {
  tilt_x: ["tilt", 0],
  tilt_y: ["tilt", 1],
  tilt_rate_x: ["tilt_rate", 0],
  tilt_rate_y: ["tilt_rate", 1],
};

const OF_A_RUN: readonly string[] = ["spin", "duration"];

export interface Quantity {
  readonly name: string;
  readonly symbol: string;
  readonly unit: string;
  readonly from: number;
  readonly to: number;
}

/** Returns the value of a quantity, or undefined if the description has no such number. */
export function valueOf(description: Description, name: string): number | undefined {
  const start = STARTS[name];
  if (start) return numberIn(component(description[start[0]], start[1]) ?? 0);
  if (OF_A_RUN.includes(name)) return numberIn(description[name]) ?? (name === "spin" ? 0 : undefined);
  const part = partWith(description, name);
  const phase = name === "start_phase" ? 0 : undefined;
  return part === undefined ? phase : (numberIn(description[part][name]) ?? phase);
}

/** Returns the description with another value of a quantity. */
export function withValue(description: Description, name: string, value: number): Description {
  const start = STARTS[name];
  if (start) {
    const given = description[start[0]];
    const pair = [component(given, 0) ?? 0, component(given, 1) ?? 0];
    pair[start[1]] = value;
    return { ...description, [start[0]]: pair };
  }
  if (OF_A_RUN.includes(name)) return { ...description, [name]: value };
  const part = partWith(description, name) ?? "motion";
  return { ...description, [part]: { ...description[part], [name]: value } };
}

function partWith(description: Description, name: string): PartName | undefined {
  // Motion before model before column: where two have a number of the name, the sweep means the first.
  return [...PARTS].reverse().find((part) => typeof description[part][name] === "number");
}

function component(value: Value | undefined, index: number): Value | undefined {
  return isVector(value) ? value[index] : undefined;
}

function numberIn(value: Value | undefined): number | undefined {
  return typeof value === "number" ? value : undefined;
}

/** What of the column the ranges of starts follow from: the tilt of no return and the unit of frequency. */
export interface ColumnScales {
  readonly slenderness: number;
  readonly frequency_scale: number;
}

/** Returns the four starts with ranges that hold every start from which the free column comes back. */
export function startQuantities(scales: ColumnScales): readonly Quantity[] {
  const tilt = Number((scales.slenderness * 1.1).toPrecision(2));
  const rate = Number((scales.slenderness * scales.frequency_scale * 1.1).toPrecision(2));
  return [
    { name: "tilt_x", symbol: "θ_x", unit: "rad", from: -tilt, to: tilt },
    { name: "tilt_y", symbol: "θ_y", unit: "rad", from: -tilt, to: tilt },
    { name: "tilt_rate_x", symbol: "θ̇_x", unit: "rad/s", from: -rate, to: rate },
    { name: "tilt_rate_y", symbol: "θ̇_y", unit: "rad/s", from: -rate, to: rate },
  ];
}

/** Returns the starts that this case can have: a model that rocks in one plane starts in it. */
function startsOf(description: Description, scales: ColumnScales): readonly Quantity[] {
  return startQuantities(scales).filter(({ name }) => !(isPlanar(description) && name.endsWith("_y")));
}

/** Returns what an overturning map of this case can vary, the motion first. */
export function mapQuantities(description: Description, about: About, scales: ColumnScales): readonly Quantity[] {
  const found = [...PARTS].reverse().flatMap((part) => {
    const parameters = kindNamed(about, part, kindOf(description, part))?.parameters ?? [];
    const given = kindOf(description, part) === "given"; // its radius alone would be that of another body
    return parameters
      .filter(({ varies, default: usual }) => varies && typeof usual === "number")
      .filter(({ name }) => !(given && name === "radius"))
      .map(quantityOf);
  });
  const names = new Set<string>();
  const once = found.filter(({ name }) => !names.has(name) && names.add(name));
  return [...once, ...startsOf(description, scales)];
}

/** Returns what a basin can vary: starts of one system. */
export function basinQuantities(description: Description, scales: ColumnScales): readonly Quantity[] {
  const phase = { name: "start_phase", symbol: "φ", unit: "rad", from: 0, to: Number((2 * Math.PI).toPrecision(6)) };
  const harmonic = "angular_frequency" in description.motion || "rpm" in description.motion;
  return [...startsOf(description, scales), ...(harmonic ? [phase] : [])];
}

function quantityOf(parameter: Parameter): Quantity {
  const { name, symbol, unit, from, to } = parameter;
  const [low, high] = [from ?? 0, to ?? firstTop(parameter)];
  return { name, symbol: symbol ?? "", unit: unit ?? "", from: low, to: high };
}

/** Returns a range about the present value of a quantity: from a fraction of it to a few times it. */
export function rangeAbout(quantity: Quantity, value: number | undefined): { from: number; to: number } {
  if (!(value !== undefined && value > 0 && quantity.from >= 0)) return { from: quantity.from, to: quantity.to };
  const [from, to] = [niceBelow(value / 4), niceAbove(value * 2.5)];
  return { from: Math.max(from, quantity.from), to: Math.max(to, niceAbove(value)) };
}

/** Returns where the range of a number ends that has none of its own and is zero. */
export function firstTop({ unit, default: usual }: Parameter): number {
  if (typeof usual === "number" && usual > 0) return niceAbove(usual * SPREAD);
  return unit === "rad" ? 0.1 : unit === "s" ? 10 : 1;
}
