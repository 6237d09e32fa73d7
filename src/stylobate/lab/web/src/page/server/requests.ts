/** What is asked for a view: the bodies of the requests. */

import type { Description, Part, Value } from "../case/description";
import { isPart } from "../case/description";
import { isHorizontalHarmonic, withoutFrequency } from "../case/frequency";
import { niceAbove, niceBelow } from "../case/ranges";
import { BEYOND, POINTS, RANGE } from "./declared";
import type { Plane, PlaneKind } from "../view/state";

/** Returns a description as it is sent: what need not be given and is not, is left out. */
export function sent(description: Part): Part {
  const given = Object.entries(description).filter(([, value]) => value !== null);
  return Object.fromEntries(given.map(([name, value]): [string, Value] => [name, isPart(value) ? sent(value) : value]));
}

/** Returns the range of frequencies that suits a column, and holds the frequency that is shown. */
export function usualRange(scale: number, frequency: number | null): readonly [number, number] {
  const [low, high] = [niceBelow(RANGE[0] * scale), niceAbove(RANGE[1] * scale)];
  if (frequency === null || !(frequency > 0)) return [low, high];
  return [
    frequency < low ? niceBelow(frequency / BEYOND) : low,
    frequency > high ? niceAbove(frequency * BEYOND) : high,
  ];
}

/** Returns the request for exact orbits of the case, or null where it has no response. */
export function exactRequest(description: Description, range: readonly [number, number]): Part | null {
  const { column, model, motion } = description;
  if (!isHorizontalHarmonic(motion)) return null;
  return sent({ column, model, motion: withoutFrequency(motion), angular_frequency_range: [...range] });
}

/** Returns the request for response curves: only the slender model has a closed form, and it stands for the others. */
export function responseRequest(description: Description, range: readonly [number, number]): Part | null {
  const { model } = description;
  const slender: Part = { kind: "slender", damping: model["damping"] ?? 0 };
  const exact = exactRequest({ ...description, model: slender }, range);
  return exact && { ...exact, points: POINTS };
}

export function isSlender(description: Description): boolean {
  return (description.model["kind"] ?? "wobbling") === "slender";
}

/** Returns the description of a map or a basin with runs of this length. */
export function planeRequest(kind: PlaneKind, description: Description, plane: Plane, length: Part): Part {
  const axes = { x: { ...plane.x }, y: { ...plane.y } };
  return sent({ ...description, ...length, [kind]: axes });
}
