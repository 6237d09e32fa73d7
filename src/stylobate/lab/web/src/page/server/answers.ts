/** What the server answers. Numbers that are not finite come as null. */

import type { DrawnMotion, Pair, Triple } from "../../viewer/drawn-motion";
import type { Value } from "../case/description";

export type Numbers = readonly (number | null)[];

export interface Series {
  readonly time: readonly number[];
  readonly amplitude: Numbers;
  readonly azimuth: Numbers;
  readonly rolling_rate: Numbers;
  readonly base_acceleration: readonly Triple[];
  readonly spin?: Numbers;
  readonly friction_demand?: Numbers;
  readonly pivoting_demand?: Numbers;
  /** Over the weight. */
  readonly normal_force?: Numbers;
  /** Of the centre of the footprint, from where it began. */
  readonly displacement?: readonly Pair[];
  readonly slip_speed?: Numbers;
  readonly clearance?: Numbers;
}

export interface ColumnTold {
  readonly slenderness: number;
  readonly frequency_scale: number;
  /** p of a rigid body about a point of its rim [rad/s]. */
  readonly frequency_parameter: number;
  readonly [name: string]: Value;
}

export interface Described {
  readonly toml: string;
  readonly python: string;
  readonly column?: ColumnTold;
}

/** The answer to one run. */
export interface Answer extends Described {
  readonly outcome: string;
  readonly label: string;
  readonly reason: string;
  readonly decided_at: number | null;
  readonly uncertain: boolean;
  readonly planar: boolean;
  readonly warnings: readonly string[];
  readonly events: readonly { readonly kind: string; readonly time: number }[];
  /** Numbers of the column and the run, to read: label and value. */
  readonly summary: readonly (readonly [string, string])[];
  readonly measures: Readonly<Record<string, number | null>>;
  readonly thresholds: Readonly<Record<string, number | null>>;
  readonly column: ColumnTold;
  readonly drawn: DrawnMotion;
  readonly series: Series;
}

export interface ResponseBranch {
  readonly sense: string;
  readonly branch: string;
  readonly amplitude: Numbers;
  readonly phase: Numbers;
  readonly stable: readonly (boolean | null)[];
}

export interface ResponseCurves {
  readonly angular_frequency: readonly number[];
  readonly branches: readonly ResponseBranch[];
  readonly backbone: Numbers;
  readonly critical: readonly { readonly sense: string; readonly angular_frequency: number | null }[];
  readonly averaged: boolean;
}

export interface ExactFamily {
  readonly name: string;
  readonly angular_frequency: Numbers;
  readonly mean_tilt: Numbers;
  readonly least_tilt: Numbers;
  readonly largest_tilt: Numbers;
  readonly phase: Numbers;
  readonly stable: readonly (boolean | null)[];
  /** At t = 0: where a run on the orbit starts. */
  readonly tilt: readonly Pair[];
  readonly tilt_rate: readonly Pair[];
}

export interface ExactResponse {
  readonly families: readonly ExactFamily[];
  readonly bifurcations: readonly {
    readonly kind: string;
    readonly angular_frequency: number;
    readonly mean_tilt: number | null;
    readonly soft: boolean | null;
  }[];
}

/** An axis of a map as it is computed. */
export interface ToldAxis {
  readonly name: string;
  readonly values: readonly number[];
  readonly units: string;
}

export interface AxesEvent {
  readonly axes: { readonly x: ToldAxis; readonly y: ToldAxis };
  readonly names: readonly (readonly [number, string])[];
}

export interface CellsEvent {
  readonly stride: number;
  readonly cells: readonly (readonly [number, number, number])[];
}

export interface Attractor {
  readonly name: string;
  readonly kind: string;
  readonly fraction: number | null;
  readonly fraction_low: number | null;
  readonly fraction_high: number | null;
}

/** What is known of a plane when all of it is: `codes` and `names` of basins and of what a sliding column does. */
export interface PlaneResult {
  readonly codes?: readonly (readonly number[])[];
  readonly names?: readonly (readonly [number, string])[];
  readonly attractors?: readonly Attractor[];
  readonly uncertain?: number;
  readonly runs?: number;
}

export interface JobReport {
  readonly id: string;
  readonly kind: string;
  readonly state: "waiting" | "running" | "done" | "failed" | "cancelled";
  readonly done: number;
  readonly total: number;
  readonly events: readonly unknown[];
  readonly next: number;
  readonly note?: string;
  readonly problems: readonly string[];
  readonly result: unknown;
}

/** A record that the server has received. */
export interface Received {
  readonly upload: string;
  readonly name: string;
  readonly samples: number;
  readonly step: number;
  readonly duration: number;
  readonly peaks: Readonly<Record<string, number>>;
  readonly provenance: readonly string[];
  /** What may be wrong with its files. */
  readonly warnings: readonly string[];
}

/** The start on a branch of steady rolling. */
export interface BranchStart {
  readonly tilt: Pair;
  readonly tilt_rate: Pair;
  readonly spin: number;
  /** Whether it is approximate, or its orbit unstable. */
  readonly warnings: readonly string[];
}
