/** Base motions as the numbers of a program. */

import type { Part } from "../page/case/description";
import { Refused } from "../page/server/source";
import { numberOf, refuseOthers } from "./case";
import type { Kernels, Numbers } from "./kernels";
import type { Samples } from "./own-records";
import type { Tabulated } from "./tables";

export type Vector = readonly [x: number, y: number];

export interface Shaking {
  /** Kind of base motion: the second part of the name of a program. */
  readonly kind: string;
  /** The numbers of a motion without a table, by name. */
  readonly numbers: Numbers;
  /** Period of the base motion [s]; null without one. */
  readonly period: number | null;
  /** Time after which the base stands still [s]. */
  readonly lasts: number;
  /** Highest angular frequency of the motion [rad/s]. */
  readonly frequency: number;
  /** Returns horizontal vectors that span the motion. */
  readonly vectors: () => readonly Vector[];
  /** Returns the table of the motion up to a time [s]; null for a motion without one. */
  readonly table: ((end: number) => Tabulated) | null;
}

const STILL = { period: null, lasts: 0, frequency: 0 };
const RESTING: Shaking = { kind: "rest", numbers: {}, ...STILL, vectors: () => [], table: null };
/** Numbers of a record besides its source. */
const OF_A_RECORD = ["kind", "sample", "upload", "scale", "rotation", "tail"];
/** Fraction of a step by which a time counts as a whole number of steps. */
const SLACK = 1e-6;

export async function shakingOf(kernels: Kernels, motion: Part): Promise<Shaking> {
  const kind = kindOfShaking(kernels, motion);
  if (kind === "rest") return RESTING;
  if (kind === "linear") return recordOf(kernels, motion);
  return kind === "harmonic" ? wavesOf(kernels, motion) : pulseOf(kernels, motion);
}

/** Returns the kind of a base motion, the second part of the name of a program; null for one that is not computed. */
export function kindOfShaking(kernels: Kernels, motion: Part): string | null {
  const kind = String(motion["kind"]);
  if (kind === "rest") return "rest";
  if (kind === "record") return "linear";
  const { case: waves, tables } = kernels.described;
  const [harmonic, other] = [waves, tables.variants].map((known) => known.some((one) => one.of === `motion_${kind}`));
  const ramped = typeof motion["ramp"] === "number" && motion["ramp"] > 0; // such a motion has a table, too
  return harmonic && !ramped ? "harmonic" : harmonic || other ? "smooth" : null;
}

async function wavesOf(kernels: Kernels, motion: Part): Promise<Shaking> {
  const [ax, ay, az, px, py, pz, frequency = NaN, phase] = Object.values(await kernels.made("motion", motion, "kind"));
  const [amplitude, phases] = [named("amplitude", [ax, ay, az]), named("phase", [px, py, pz])];
  const numbers = { ...amplitude, ...phases, angular_frequency: frequency, start_phase: phase ?? NaN };
  const moved = (part: (angle: number) => number): Vector => [
    (ax ?? NaN) * part(px ?? NaN),
    (ay ?? NaN) * part(py ?? NaN),
  ];
  const vectors = (): readonly Vector[] => [moved(Math.cos), moved(Math.sin)];
  const period = (2 * Math.PI) / frequency;
  return { kind: "harmonic", numbers, period, lasts: Infinity, frequency, vectors, table: null };
}

function named(name: string, values: readonly (number | undefined)[]): Numbers {
  return Object.fromEntries(values.map((value, axis) => [`${name}_${"xyz"[axis]}`, value ?? NaN]));
}

async function pulseOf(kernels: Kernels, motion: Part): Promise<Shaking> {
  const { variants, pieces } = kernels.described.tables;
  const known = [...kernels.described.case, ...variants]; // harmonic motions with a ramp have tables too
  const [name, values] = kernels.arguments(known, `motion_${String(motion["kind"])}`, motion, "kind");
  const tables = await kernels.tables();
  return tabulated("smooth", (end) => tables.smooth(name, values, end, pieces["smooth"] ?? NaN));
}

async function recordOf(kernels: Kernels, motion: Part): Promise<Shaking> {
  refuseOthers(motion, OF_A_RECORD);
  const { sample, upload } = motion;
  const samples = typeof sample === "string" ? await kernels.sample(sample) : kernels.own.samples(upload);
  const [scale, rotation, tail] = [1, 0, 0].map((usual, k) => {
    const name = OF_A_RECORD[3 + k] ?? "";
    const value = numberOf(motion[name], usual, name);
    if (!Number.isFinite(value)) throw new Refused(422, [`motion.${name} must be finite, got ${value}`]);
    return value;
  }) as [number, number, number];
  const tables = await kernels.tables();
  const whole = followedBy(samples, tail);
  const table = tables.record(whole, scale, rotation, kernels.described.tables.pieces["linear"] ?? NaN);
  return tabulated("linear", () => table);
}

function followedBy({ values, step }: Samples, tail: number): Samples {
  if (tail < 0) throw new Refused(422, [`motion.tail must be zero or positive, got ${tail} s`]);
  const more = Math.max(0, Math.ceil(tail / step - SLACK));
  if (more === 0) return { values, step };
  const longer = new Float64Array(values.length + 3 * more);
  longer.set(values);
  return { values: longer, step };
}

function tabulated(kind: string, table: (end: number) => Tabulated): Shaking {
  const { lasts = NaN, period = 0, highest_frequency: frequency = 0 } = table(0).numbers;
  const vectors = (): readonly Vector[] => {
    const { first_x = 0, first_y = 0, other_x = 0, other_y = 0 } = table(Math.min(lasts, period || lasts)).numbers;
    return [
      [first_x, first_y],
      [other_x, other_y],
    ];
  };
  return { kind, numbers: {}, period: period > 0 ? period : null, lasts, frequency, vectors, table };
}
