/** Whether one point of the rim touches: not while the column stands on all of it, nor while it flies. */

import type { DrawnMotion } from "./drawn-motion";

const FLYING = 1e-6; // clearance over radius, above which nothing touches

export function flies(clearance: number, radius: number): boolean {
  return clearance > FLYING * radius;
}

/** Return whether the column is on one point of its rim at this sample. */
export function onRim({ resting, clearance, column }: DrawnMotion, i: number): boolean {
  return resting[i] !== 1 && !flies(clearance?.[i] ?? 0, column.radius);
}
