/** The frequency of a harmonic base motion, in whichever of its quantities it is given. */

import type { Part } from "./description";
import { isVector, without } from "./description";

const TURN = 2 * Math.PI;

/** By kind: the quantity that holds the frequency, and how many rad/s one of its units is. */
const HELD_IN: Readonly<Record<string, readonly [string, number]>> = {
  circular: ["angular_frequency", 1],
  straight: ["angular_frequency", 1],
  elliptic: ["angular_frequency", 1],
  vertical: ["angular_frequency", 1],
  oblique: ["angular_frequency", 1],
  displacement_amplitude: ["angular_frequency", 1],
  harmonic: ["angular_frequency", 1],
  stroke: ["frequency", TURN],
  orbit: ["rpm", TURN / 60],
};

/** Returns the angular frequency [rad/s], or null for a motion that has none. */
export function angularFrequency(motion: Part): number | null {
  const held = HELD_IN[String(motion["kind"])];
  const value = held && motion[held[0]];
  return held && typeof value === "number" ? value * held[1] : null;
}

/** Returns the motion at another angular frequency [rad/s]. */
export function withAngularFrequency(motion: Part, frequency: number): Part {
  const held = HELD_IN[String(motion["kind"])];
  return held ? { ...motion, [held[0]]: Number((frequency / held[1]).toPrecision(6)) } : motion;
}

/** Returns whether the motion is one that response curves are drawn for: harmonic, and in the horizontal. */
export function isHorizontalHarmonic(motion: Part): boolean {
  const kind = String(motion["kind"]);
  if (!(kind in HELD_IN) || kind === "vertical" || kind === "oblique") return false;
  const amplitude = motion["amplitude"];
  return !(isVector(amplitude) && amplitude.length === 3 && amplitude[2] !== 0);
}

/** Returns what of the motion its response depends on: not its frequency, where the acceleration is what is given. */
export function withoutFrequency(motion: Part): Part {
  const byAcceleration = ["circular", "straight", "elliptic"].includes(String(motion["kind"]));
  return byAcceleration ? without(motion, "angular_frequency", "start_phase", "ramp") : motion;
}
