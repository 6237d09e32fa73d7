/** A column that rolls round its rim, leans more and less, and turns: every quantity in closed form. */

import type { DrawnMotion, Pair, Rotation, Triple } from "../../src/viewer/drawn-motion";

export const RADIUS = 0.5;

export interface Attitude {
  readonly azimuth: number;
  readonly angle: number;
  readonly twist: number;
}

export function attitudeAt(t: number): Attitude {
  return { azimuth: 1.3 * t, angle: 0.05 + 0.02 * Math.sin(0.7 * t), twist: 0.4 * t + 0.3 * Math.sin(t) };
}

/** Return Rz(β) Ry(θ) Rz(χ − β). */
export function rotationTo({ azimuth, angle, twist }: Attitude): Rotation {
  const about = twist - azimuth;
  const [c, s] = [Math.cos(angle / 2), Math.sin(angle / 2)];
  const [half, apart] = [0.5 * (azimuth + about), 0.5 * (azimuth - about)];
  return [c * Math.cos(half), -s * Math.sin(apart), s * Math.cos(apart), c * Math.sin(half)];
}

export function rolling(samples = 401, duration = 20): DrawnMotion {
  const time = Array.from({ length: samples }, (_, i) => (duration * i) / (samples - 1));
  const attitudes = time.map(attitudeAt);
  const towards = attitudes.map(({ azimuth }): Pair => [Math.cos(azimuth), Math.sin(azimuth)]);
  const pairs = (value: (i: number) => number): Pair[] => towards.map(([x, y], i) => [value(i) * x, value(i) * y]);
  const rim = attitudes.map(({ angle }) => RADIUS * (1 - Math.cos(angle)));
  return {
    column: { radius: RADIUS, top_radius: 0.45, height: 5, mass_height: 2.5, slenderness: 0.2 },
    plane: { incline: 0, incline_direction: 0 },
    time,
    tilt: pairs((i) => attitudes[i]!.angle),
    tilt_rate: pairs(() => 0),
    twist: attitudes.map(({ twist }) => twist),
    spin: time.map(() => 0),
    footprint: time.map((): Pair => [0, 0]),
    contact_point: pairs(() => RADIUS),
    resting: time.map(() => 0),
    clearance: null,
    base: time.map((t): Triple => [0.1 * Math.cos(1.3 * t), 0.1 * Math.sin(1.3 * t), 0]),
    rotation: attitudes.map(rotationTo),
    centre: towards.map(([x, y], i): Triple => [rim[i]! * x, rim[i]! * y, RADIUS * Math.sin(attitudes[i]!.angle)]),
    friction_demand: null,
    friction_coefficient: null,
    outcome: "ROLLING",
    decided_at: duration,
    title: "A column that rolls.",
  };
}
