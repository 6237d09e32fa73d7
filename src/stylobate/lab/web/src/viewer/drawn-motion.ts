/** A motion as it is to be drawn: equal samples of the computed run, SI units, frame of the base unless stated. */

export type Pair = readonly [number, number];
export type Triple = readonly [number, number, number];
/** Unit quaternion, real part first. */
export type Rotation = readonly [number, number, number, number];

export interface DrawnColumn {
  readonly radius: number;
  readonly top_radius: number;
  readonly height: number;
  readonly mass_height: number;
  /** Tilt at which the centre of mass stands over the rim [rad]. */
  readonly slenderness: number;
}

export interface DrawnPlane {
  readonly incline: number;
  /** Azimuth of the way down [rad]. */
  readonly incline_direction: number;
}

export interface DrawnMotion {
  readonly column: DrawnColumn;
  readonly plane: DrawnPlane;
  readonly time: readonly number[];
  readonly tilt: readonly Pair[];
  readonly tilt_rate: readonly Pair[];
  readonly twist: readonly number[];
  readonly spin: readonly number[] | null;
  /** Centre of the circle on which the column stood or rolls. */
  readonly footprint: readonly Pair[];
  readonly contact_point: readonly Pair[];
  readonly resting: readonly number[];
  /** Height of the lowest point of the rim above the plane; null where it never leaves it. */
  readonly clearance: readonly number[] | null;
  /** Displacement of the base in the frame of the ground. */
  readonly base: readonly Triple[];
  readonly rotation: readonly Rotation[];
  /** Centre of the bottom of the column. */
  readonly centre: readonly Triple[];
  readonly friction_demand: readonly (number | null)[] | null;
  readonly friction_coefficient: number | null;
  readonly outcome: string;
  readonly decided_at: number;
  readonly title: string;
}

/** A second column on the same base, and what is written below both. */
export interface Beside {
  readonly motion: DrawnMotion;
  readonly labels: readonly [string, string];
}

const SAMPLED = [
  "tilt",
  "tilt_rate",
  "twist",
  "footprint",
  "contact_point",
  "resting",
  "base",
  "rotation",
  "centre",
] as const satisfies readonly (keyof DrawnMotion)[];

/** Return `motion`, or say in one line why it cannot be drawn. */
export function drawable(motion: DrawnMotion): DrawnMotion {
  const { time, column } = motion;
  if (time.length === 0) throw new Error("time must hold one sample at least, got none: draw a run that has begun");
  for (const name of SAMPLED) {
    const count = motion[name].length;
    if (count !== time.length)
      throw new Error(`${name} must have a sample for each of the ${time.length} times, got ${count}`);
  }
  for (const [name, value] of Object.entries(column)) {
    if (!(value > 0 && Number.isFinite(value))) throw new Error(`column.${name} must be positive, got ${value}`);
  }
  return motion;
}
