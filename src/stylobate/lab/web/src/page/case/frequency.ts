/** The frequency of a harmonic base motion, in whichever of its quantities it is given. */

import type { Part } from "./description";
import { isVector, without } from "./description";
import { BY_ACCELERATION, FREQUENCIES, RESPONDING } from "../server/declared";

const TURN = 2 * Math.PI;

/** Units of frequencies: how many rad/s one of them is. */
export const RATES: Readonly<Record<string, number>> = { "rad/s": 1, Hz: TURN, "1/min": TURN / 60 };

/** Returns the number that holds the frequency, and how many rad/s one of its units is. */
function heldIn({ kind }: Part): readonly [string, number] | null {
  const [name, unit] = FREQUENCIES[String(kind)] ?? [];
  return name === undefined || unit === undefined ? null : [name, RATES[unit] ?? 1];
}

/** Returns the angular frequency [rad/s], or null for a motion that has none. */
export function angularFrequency(motion: Part): number | null {
  const held = heldIn(motion);
  const value = held && motion[held[0]];
  return held && typeof value === "number" ? value * held[1] : null;
}

/** Returns the motion at another angular frequency [rad/s]. */
export function withAngularFrequency(motion: Part, frequency: number): Part {
  const held = heldIn(motion);
  return held ? { ...motion, [held[0]]: Number((frequency / held[1]).toPrecision(6)) } : motion;
}

/** Returns whether the motion is one that response curves are drawn for: harmonic, and in the horizontal. */
export function isHorizontalHarmonic(motion: Part): boolean {
  const amplitude = motion["amplitude"];
  return (
    RESPONDING.includes(String(motion["kind"])) &&
    !(isVector(amplitude) && amplitude.length === 3 && amplitude[2] !== 0)
  );
}

/** Returns what of the motion its response depends on: not its frequency, where the acceleration is what is given. */
export function withoutFrequency(motion: Part): Part {
  const byAcceleration = BY_ACCELERATION.includes(String(motion["kind"]));
  return byAcceleration ? without(motion, "angular_frequency", "start_phase", "ramp") : motion;
}
