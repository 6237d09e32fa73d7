/** Axes of maps and basins that suit a case where none are given. */

import type { About } from "../case/about";
import type { Description, Part } from "../case/description";
import { without, written } from "../case/description";
import { RATES } from "../case/frequency";
import type { ColumnScales, Quantity } from "../case/quantities";
import { basinQuantities, mapQuantities, rangeAbout, valueOf } from "../case/quantities";
import { GRIDS } from "../server/declared";
import type { Axis, Plane, PlaneKind } from "../view/state";
import { DEFAULT_CELLS } from "../view/state";

export function quantitiesOf(
  kind: PlaneKind,
  description: Description,
  about: About,
  scales: ColumnScales,
): readonly Quantity[] {
  return GRIDS[kind].starts ? basinQuantities(description, scales) : mapQuantities(description, about, scales);
}

/** Returns the plane of the first two quantities: frequency and strength of the motion, or the two tilts. */
export function defaultPlane(kind: PlaneKind, description: Description, quantities: readonly Quantity[]): Plane | null {
  const moving = quantities.filter(({ name, unit }) => name in description.motion && unit !== "rad");
  const named = ["friction_coefficient", "damping"].flatMap((name) => quantities.filter((one) => one.name === name));
  const wanted = GRIDS[kind].starts ? [] : [...moving.filter(({ unit }) => unit in RATES), ...moving, ...named];
  const [x, y] = new Set([...wanted, ...quantities]);
  return x && y ? { x: defaultAxis(x, description), y: defaultAxis(y, description) } : null;
}

export function defaultAxis(quantity: Quantity, description: Description, number = DEFAULT_CELLS): Axis {
  return { name: quantity.name, ...rangeAbout(quantity, valueOf(description, quantity.name)), number };
}

/** Returns whether both quantities are numbers that this case has: an axis may be left from another one. */
export function belongs(plane: Plane, quantities: readonly Quantity[]): boolean {
  return [plane.x, plane.y].every((axis) => quantities.some((one) => one.name === axis.name));
}

/** Returns what a plane's picture depends on: the case but for the two numbers that vary, the axes, the length of runs. */
export function keyOf(description: Description, plane: Plane, length: Part): string {
  const varied = [plane.x.name, plane.y.name];
  const starts = varied.some((name) => name.startsWith("tilt_"));
  const own = (...names: readonly string[]): boolean =>
    plane.start !== undefined || names.every((name) => varied.includes(name));
  const rest = {
    column: without(description.column, ...varied),
    model: without(description.model, ...varied),
    motion: without(description.motion, ...varied),
    tilt: own("tilt_x", "tilt_y") ? null : (description["tilt"] ?? null),
    tilt_rate: own("tilt_rate_x", "tilt_rate_y") ? null : (description["tilt_rate"] ?? null),
    spin: own("spin") ? null : (description["spin"] ?? null),
    length: varied.includes("duration") ? null : length,
    starts,
    start: plane.start ?? null,
    x: { ...plane.x },
    y: { ...plane.y },
  };
  return written(rest);
}
