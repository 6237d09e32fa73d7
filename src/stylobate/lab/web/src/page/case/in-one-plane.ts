/** A case turned into one vertical plane, for a model that rocks in one. */

import type { Description, Part } from "./description";
import { isVector } from "./description";
import { angularFrequency } from "./frequency";

/** Returns the case with its start along x and, where the base goes round, a base that goes to and fro along x. */
export function inOnePlane(description: Description): Description {
  const { motion } = description;
  const start = Object.fromEntries(
    (["tilt", "tilt_rate"] as const).flatMap((name) => {
      const value = description[name];
      return isVector(value) ? [[name, [value[0] ?? 0, 0]]] : [];
    }),
  );
  const rest = Object.fromEntries(Object.entries(description).filter(([name]) => name !== "spin"));
  return { ...rest, ...start, motion: alongX(motion) } as Description;
}

function alongX(motion: Part): Part {
  const frequency = angularFrequency(motion);
  if (motion["kind"] === "circular")
    return { ...pick(motion, ["acceleration", "angular_frequency"]), kind: "straight" };
  if (motion["kind"] === "orbit" && frequency !== null)
    return { kind: "stroke", stroke: motion["diameter"] ?? 0, frequency: frequency / (2 * Math.PI) };
  return "direction" in motion ? { ...motion, direction: 0 } : motion;
}

function pick(part: Part, names: readonly string[]): Part {
  return Object.fromEntries(Object.entries(part).filter(([name]) => names.includes(name)));
}
