/** Names and kinds, written by tools/page_types.py from their declarations. Do not edit. */

/** The numbers of a start. */
export const START: readonly string[] = ["tilt", "tilt_rate", "spin"];

/** What runs have besides column, model and motion. */
export const RUN: readonly string[] = ["tilt", "tilt_rate", "spin", "rtol", "atol", "tilt_limit", "rest_energy", "max_steps", "duration", "friction_coefficient", "samples", "twist", "position", "velocity", "clearance", "periods", "method", "strobes", "confidence", "rules"];

/** Kinds of motions that can have response curves. */
export const RESPONDING: readonly string[] = ["circular", "straight", "elliptic", "displacement_amplitude", "stroke", "orbit", "harmonic"];

/** Those whose acceleration does not depend on their frequency. */
export const BY_ACCELERATION: readonly string[] = ["circular", "straight", "elliptic"];

/** Kinds of models of columns that may turn about their axis. */
export const TURNING: readonly string[] = ["slender_rolling", "rolling", "sliding"];

/** Studies whose result is a grid of classes: whether only initial conditions vary. */
export const GRIDS = {
  map: { starts: false },
  basin: { starts: true },
} as const;

/** By kind of harmonic motion: the number that holds the frequency, and its unit. */
export const FREQUENCIES: Readonly<Record<string, readonly [name: string, unit: string]>> = {
  circular: ["angular_frequency", "rad/s"],
  straight: ["angular_frequency", "rad/s"],
  elliptic: ["angular_frequency", "rad/s"],
  vertical: ["angular_frequency", "rad/s"],
  oblique: ["angular_frequency", "rad/s"],
  displacement_amplitude: ["angular_frequency", "rad/s"],
  stroke: ["frequency", "Hz"],
  orbit: ["rpm", "1/min"],
  harmonic: ["angular_frequency", "rad/s"],
};

/** A start on a branch is off it by this fraction of its tilt: a run leaves a motion that is not stable. */
export const OFF_BRANCH = 0.001;

/** Points of a response curve, about one to a pixel. */
export const POINTS = 400;

/** Ends of the range of frequencies of a response curve, over the frequency scale of the column. */
export const RANGE = [0.2, 3.5] as const;

/** The range also includes the frequency of the case, and goes beyond it by this factor. */
export const BEYOND = 1.2;
