/** A case turned into one vertical plane, for a model that rocks in one. */

import type { Description, Part, Value } from "./description";
import { isVector, kindOf, written } from "./description";
import { angularFrequency } from "./frequency";

/** The model that rocks in one plane. */
export const PLANAR = "planar_rocking";

export function isPlanar(description: Description): boolean {
  return kindOf(description, "model") === PLANAR;
}

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

/** What a turn into one plane may change of a case. */
const TURNED = ["motion", "tilt", "tilt_rate", "spin"] as const;
type Turned = (typeof TURNED)[number];

/** What was changed of a case when it was turned into one plane, so that it can be changed back. */
export class PlaneTurn {
  readonly #before: Description;
  readonly #after: Description;
  readonly #changed: readonly Turned[];

  constructor(before: Description, after: Description) {
    this.#before = before;
    this.#after = after;
    this.#changed = TURNED.filter((name) => !alike(before[name], after[name]));
  }

  /** Returns the case with all that was changed as it was before, but for what the reader has changed since. */
  undone(description: Description): Description {
    const back = this.#kept(description).map((name): [string, Value] => [name, this.#before[name] ?? null]);
    return { ...description, ...Object.fromEntries(back) };
  }

  /** Returns in one line what was changed of the case that is shown; "" if nothing of it is left. */
  lineFor(description: Description): string {
    const kept = this.#kept(description);
    const starts = kept.some((name) => name !== "motion");
    const parts = [
      ...(kept.includes("motion") ? [`the motion is now ${this.#motionNow()}`] : []),
      ...(starts ? ["the initial condition lies in its plane"] : []),
    ];
    return parts.length === 0
      ? ""
      : `Planar rocking: ${parts.join(" and ")}. Choose another model to restore the earlier values.`;
  }

  #kept(description: Description): readonly Turned[] {
    return this.#changed.filter((name) => alike(description[name], this.#after[name]));
  }

  #motionNow(): string {
    const [before, after] = [this.#before.motion["kind"], this.#after.motion["kind"]];
    return before === after ? "along x" : "straight";
  }
}

/** What is left out is as nothing. */
function alike(one: Value | undefined, other: Value | undefined): boolean {
  return written(one ?? null) === written(other ?? null);
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
