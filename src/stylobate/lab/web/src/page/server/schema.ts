/** Types of the server's answers, written by tools/page_types.py from its OpenAPI document. Do not edit. */

/** What there is to choose from. */
export type About = {
  /** of stylobate */
  readonly version: string;
  /** How much may be asked for. */
  readonly limits: {
    readonly body: number;
    readonly records: number;
    readonly unpacked: number;
    readonly receiving: number;
    readonly connections: number;
    readonly uploads: number;
    readonly duration: number;
    readonly steps: number;
    readonly usual_steps: number;
    readonly points: number;
    readonly cells: number;
    readonly motions: number;
    readonly record_samples: number;
    readonly run_time: number;
    readonly wait: number;
    readonly runs: number;
    readonly jobs: number;
    readonly waiting: number;
    readonly abandoned: number;
  };
  /** of columns */
  readonly shapes: readonly Kind[];
  /** of models */
  readonly models: readonly Kind[];
  /** of base motions */
  readonly motions: readonly Kind[];
  /** records that are here */
  readonly samples: readonly ({
    readonly name: string;
    readonly about: string;
  })[];
  /** motions worth seeing */
  readonly presets: readonly ({
    readonly id: string;
    readonly title: string;
    readonly about: string;
    /** to be sent to /api/simulate */
    readonly description: Readonly<Record<string, unknown>>;
    /** how the page shows it */
    readonly view: Readonly<Record<string, unknown>>;
  })[];
  /** the possible outcomes */
  readonly outcomes: readonly ({
    readonly name: "AT_REST" | "ROCKING" | "ROLLING" | "MODULATED" | "OVERTURNED" | "STILL_MOVING" | "LIMIT_REACHED" | "LIFTED_OFF" | "FAILED" | "SLID" | "SURVIVED" | "STOPPED";
    /** in words */
    readonly value: string;
    /** in maps */
    readonly code: number;
  })[];
};

/** The result of a basin: where each start leads. */
export type BasinResult = {
  /** runs whose outcome rounding error could change */
  readonly uncertain: number;
  /** runs in all */
  readonly runs: number;
  /** a row for each value of x */
  readonly codes: readonly (readonly number[])[];
  /** codes and what they mean */
  readonly names: readonly (readonly [number, string])[];
  /** what starts lead to */
  readonly attractors: readonly ({
    /** as in names */
    readonly name: string;
    /** the kind of outcome */
    readonly kind: string;
    /** in periods of the base; 0 where it has none */
    readonly period: number;
    /** of all starts */
    readonly fraction: number | null;
    /** lower end of its interval */
    readonly fraction_low: number | null;
    /** upper end of its interval */
    readonly fraction_high: number | null;
  })[];
};

/** A job that begins. */
export type Begun = {
  /** by which it is asked for */
  readonly id: string;
};

/** The numbers of the column that decide. */
export type ColumnNumbers = {
  /** radius of the base [m] */
  readonly radius: number;
  /** acceleration of gravity [m/s²] */
  readonly gravity: number;
  /** slenderness r/h */
  readonly slenderness: number;
  /** m h²/J0 */
  readonly inertia_ratio: number;
  /** I_a/(m r²) */
  readonly axial_ratio: number;
  /** height of the centre of mass [m] */
  readonly mass_height: number;
  /** mass [kg] */
  readonly mass: number;
  /** moment of inertia about a horizontal axis through the centre of mass [kg m²] */
  readonly transverse_inertia: number;
  /** moment of inertia about the axis [kg m²] */
  readonly axial_inertia: number;
  /** ω0 [rad/s] */
  readonly frequency_scale: number;
  /** frequency parameter √(m g R/K) [rad/s] */
  readonly frequency_parameter: number;
  /** c g, the horizontal acceleration that tips the standing column [m/s²] */
  readonly uplift_acceleration: number;
};

/** The result of a map of a model that slides: what the column does. */
export type ContactMapResult = {
  /** runs whose outcome rounding error could change */
  readonly uncertain: number;
  /** runs in all */
  readonly runs: number;
  /** a row for each value of x */
  readonly codes: readonly (readonly number[])[];
  /** codes and what they mean */
  readonly names: readonly (readonly [number, string])[];
};

/** What a description says, without a run. */
export type Described = {
  /** the description as a file for the command line */
  readonly toml: string;
  /** the same run as a Python program */
  readonly python: string;
  readonly column: ColumnNumbers;
};

/** The motion at equal steps in time, to be drawn: lengths in m in the frame of the base, z upwards. Null for what the model does not provide. */
export type DrawnMotion = {
  /** The body. */
  readonly column: {
    /** radius of the base [m] */
    readonly radius: number;
    /** radius of the top [m] */
    readonly top_radius: number;
    /** height of the body [m] */
    readonly height: number;
    /** height of the centre of mass [m] */
    readonly mass_height: number;
    /** slenderness r/h */
    readonly slenderness: number;
    readonly [name: string]: unknown;
  };
  readonly plane: {
    /** [rad] */
    readonly incline: number;
    /** [rad] */
    readonly incline_direction: number;
    readonly [name: string]: unknown;
  };
  /** [s] */
  readonly time: readonly number[];
  /** vector θ(cos β, sin β) [rad] */
  readonly tilt: readonly (readonly [number, number])[];
  /** its rate [rad/s] */
  readonly tilt_rate: readonly (readonly [number, number])[];
  /** χ, angle of turn about the axis [rad] */
  readonly twist: readonly number[];
  readonly spin: readonly number[] | null;
  /** centre of the circle on the base about which the contact point lies [m] */
  readonly footprint: readonly (readonly [number, number])[];
  /** [m] */
  readonly contact_point: readonly (readonly [number, number])[];
  /** 1 where the whole base touches */
  readonly resting: readonly (0 | 1)[];
  readonly clearance: readonly number[] | null;
  /** displacement of the base [m] */
  readonly base: readonly (readonly [number, number, number])[];
  /** unit quaternion w, x, y, z */
  readonly rotation: readonly (readonly [number, number, number, number])[];
  /** of the bottom circle [m] */
  readonly centre: readonly (readonly [number, number, number])[];
  readonly friction_demand: readonly (number | null)[] | null;
  /** of the contact, where it is known */
  readonly friction_coefficient: number | null;
  /** the outcome */
  readonly outcome: "AT_REST" | "ROCKING" | "ROLLING" | "MODULATED" | "OVERTURNED" | "STILL_MOVING" | "LIMIT_REACHED" | "LIFTED_OFF" | "FAILED" | "SLID" | "SURVIVED" | "STOPPED";
  /** [s] */
  readonly decided_at: number;
  /** a line that states the outcome */
  readonly title: string;
  readonly [name: string]: unknown;
};

/** Exact periodic orbits, the result of a job `exact`. */
export type ExactOrbits = {
  /** orbits that go over into one another; all lists of a family are of one length */
  readonly families: readonly ({
    /** which family */
    readonly name: string;
    /** [rad/s] */
    readonly angular_frequency: readonly number[];
    /** [rad] */
    readonly mean_tilt: readonly number[];
    /** [rad] */
    readonly minimum_tilt: readonly number[];
    /** [rad] */
    readonly peak_tilt: readonly number[];
    /** [rad] */
    readonly phase: readonly (number | null)[];
    /** whether it is stable */
    readonly stable: readonly boolean[];
    /** at t = 0, along x and y [rad] */
    readonly tilt: readonly (readonly [number, number])[];
    /** at t = 0 [rad/s] */
    readonly tilt_rate: readonly (readonly [number, number])[];
  })[];
  /** where stability changes */
  readonly bifurcations: readonly ({
    /** such as Neimark-Sacker */
    readonly kind: string;
    /** [rad/s] */
    readonly angular_frequency: number;
    /** [rad] */
    readonly mean_tilt: number;
    /** whether it is supercritical; null if undecided */
    readonly supercritical: boolean | null;
  })[];
};

/** How a job stands. */
export type Job = {
  /** by which it is asked for */
  readonly id: string;
  /** what it computes */
  readonly kind: "exact" | "map" | "basin" | "animation";
  /** where it stands */
  readonly state: "waiting" | "running" | "done" | "failed" | "cancelled";
  /** runs that are done */
  readonly done: number;
  /** runs in all; 0 while that is not known */
  readonly total: number;
  /** a line about what goes on, such as that a kernel is compiled */
  readonly note: string;
  /** what was found, from the event `after` on */
  readonly events: readonly (PlaneBegun | PlaneCells)[];
  /** what to give as `after` the next time */
  readonly next: number;
  /** why it failed, one line each */
  readonly problems: readonly string[];
  /** what it found, when it is done; null until then, and of an animation, which has a file */
  readonly result: ExactOrbits | MapResult | ContactMapResult | BasinResult | null;
};

/** A kind of column, model or motion. */
export type Kind = {
  /** as in descriptions */
  readonly kind: string;
  /** in words */
  readonly name: string;
  /** a line about it */
  readonly about: string;
  /** its numbers */
  readonly parameters: readonly ({
    /** as in descriptions */
    readonly name: string;
    /** as in the literature; empty without one */
    readonly symbol: string;
    /** empty without one */
    readonly unit: string;
    /** what it is */
    readonly about: string;
    /** null without one */
    readonly default: unknown;
    /** whether it must be given */
    readonly needed: boolean;
    /** whether maps can vary it */
    readonly varies: boolean;
    /** lower end of a slider; null where none serves all */
    readonly from: number | null;
    /** its upper end */
    readonly to: number | null;
    /** where there are few */
    readonly choices?: readonly (number | string)[];
  })[];
  /** of motions: whether it comes to an end, so that a run needs no duration */
  readonly ends?: boolean;
};

/** The result of a map: how often which outcome came. */
export type MapResult = {
  /** runs whose outcome rounding error could change */
  readonly uncertain: number;
  /** runs in all */
  readonly runs: number;
  /** Of all runs, by outcome. */
  readonly shares: {
    /** that ended at rest */
    readonly "at rest": number | null;
    /** that ended rocking */
    readonly rocking: number | null;
    /** that ended rolling */
    readonly rolling: number | null;
    /** that ended modulated */
    readonly modulated: number | null;
    /** that ended overturned */
    readonly overturned: number | null;
    /** that ended still moving */
    readonly "still moving": number | null;
    /** that ended limit reached */
    readonly "limit reached": number | null;
    /** that ended lifted off */
    readonly "lifted off": number | null;
    /** that ended failed */
    readonly failed: number | null;
    /** that ended slid */
    readonly slid: number | null;
    /** that ended survived */
    readonly survived: number | null;
    /** that ended stopped */
    readonly stopped: number | null;
  };
};

/** Numbers of the run as a whole, null where one is not finite. Models may add further ones. */
export type Measures = {
  /** [rad] */
  readonly peak_tilt: number | null;
  /** the same over the slenderness */
  readonly peak_tilt_over_c: number | null;
  /** [s] */
  readonly time_of_peak_tilt: number | null;
  /** [rad] */
  readonly minimum_tilt: number | null;
  /** minimum tilt at a passage of the upright [rad]; null without a passage */
  readonly least_passage: number | null;
  /** of the contact point round the rim */
  readonly turns: number | null;
  /** of the integration */
  readonly steps: number | null;
  /** over the last periods of the base [rad/s] */
  readonly mean_rolling_rate?: number | null;
  /** by how much the last periods differ, over the slenderness */
  readonly repetition?: number | null;
  /** over the last periods [rad] */
  readonly mean_tilt_late?: number | null;
  /** over the last periods [rad] */
  readonly minimum_tilt_late?: number | null;
  /** over the last periods [rad] */
  readonly peak_tilt_late?: number | null;
  /** of the modulation over the last periods */
  readonly modulation_change?: number | null;
  /** of the mean rate, by the turns */
  readonly rolling_rate_error?: number | null;
  /** friction over normal force; null where nothing presses */
  readonly peak_friction_demand?: number | null;
  /** moment over normal force and radius */
  readonly peak_pivoting_demand?: number | null;
  /** over the weight */
  readonly minimum_normal_force?: number | null;
  /** resting [s] */
  readonly time_resting?: number | null;
  /** sliding [s] */
  readonly time_sliding?: number | null;
  /** rolling [s] */
  readonly time_rolling?: number | null;
  /** slipping [s] */
  readonly time_slipping?: number | null;
  /** flying [s] */
  readonly time_flying?: number | null;
  /** of the centre of the footprint [m] */
  readonly residual_displacement?: number | null;
  /** [m] */
  readonly residual_displacement_x?: number | null;
  /** [m] */
  readonly residual_displacement_y?: number | null;
  /** [rad] */
  readonly residual_twist?: number | null;
  /** length of the path of the footprint [m] */
  readonly walking_distance?: number | null;
  /** length of the path of the contact on the plane [m] */
  readonly slip_distance?: number | null;
  /** how often it struck the plane */
  readonly impacts?: number | null;
  /** how often it began to slip */
  readonly slips?: number | null;
  /** 1 without friction; a contact jams at 0 */
  readonly least_painleve_denominator?: number | null;
  readonly [name: string]: unknown;
};

/** The first event of a map or basin: its axes, and what the codes of cells mean. */
export type PlaneBegun = {
  readonly axes: {
    /** A quantity that varies. */
    readonly x: {
      /** as in the description */
      readonly name: string;
      /** in SI units */
      readonly values: readonly (number | null)[];
      /** in words */
      readonly long_name?: string;
      /** such as rad s-1 */
      readonly units?: string;
    };
    /** A quantity that varies. */
    readonly y: {
      /** as in the description */
      readonly name: string;
      /** in SI units */
      readonly values: readonly (number | null)[];
      /** in words */
      readonly long_name?: string;
      /** such as rad s-1 */
      readonly units?: string;
    };
  };
  /** codes and what they mean */
  readonly names: readonly (readonly [number, string])[];
};

/** Cells that were computed, from coarse to fine. */
export type PlaneCells = {
  /** of all values along x and y those of so many steps are known now */
  readonly stride: number;
  readonly cells: readonly (readonly [number, number, number])[];
};

/** Why a request was refused. */
export type Problems = {
  /** one line each */
  readonly problems: readonly string[];
};

/** Steady rolling over frequency, by theory; all lists as long as `angular_frequency`. */
export type ResponseCurves = {
  /** [rad/s] */
  readonly angular_frequency: readonly number[];
  /** one for each sense and branch */
  readonly branches: readonly ({
    /** which way it rolls, seen from above */
    readonly sense: "anticlockwise" | "clockwise";
    /** which of the two solutions */
    readonly branch: "lower" | "upper";
    /** tilt [rad], null where there is no such rolling */
    readonly amplitude: readonly (number | null)[];
    /** of the lean to the base acceleration [rad], null where there is no such rolling */
    readonly phase: readonly (number | null)[];
    /** whether it is stable */
    readonly stable: readonly boolean[];
  })[];
  /** tilt of free rolling [rad], null where there is no such rolling */
  readonly backbone: readonly (number | null)[];
  /** where the upper branch loses its stability */
  readonly critical: readonly ({
    /** which way it rolls, seen from above */
    readonly sense: "anticlockwise" | "clockwise";
    /** [rad/s], null where there is none */
    readonly angular_frequency: number | null;
  })[];
  /** whether the curves are approximate, by averaging, rather than exact */
  readonly averaged: boolean;
};

/** One run. */
export type Run = {
  /** the outcome */
  readonly outcome: "AT_REST" | "ROCKING" | "ROLLING" | "MODULATED" | "OVERTURNED" | "STILL_MOVING" | "LIMIT_REACHED" | "LIFTED_OFF" | "FAILED" | "SLID" | "SURVIVED" | "STOPPED";
  /** the outcome in words */
  readonly label: "at rest" | "rocking" | "rolling" | "modulated" | "overturned" | "still moving" | "limit reached" | "lifted off" | "failed" | "slid" | "survived" | "stopped";
  /** why it is that outcome */
  readonly reason: string;
  /** when that was decided [s] */
  readonly decided_at: number;
  /** whether rounding error could change the outcome */
  readonly uncertain: boolean;
  /** whether it moved in one vertical plane */
  readonly planar: boolean;
  /** one line each */
  readonly warnings: readonly string[];
  /** uplifts, impacts and others */
  readonly events: readonly ({
    /** what happened */
    readonly kind: string;
    /** when [s] */
    readonly time: number;
  })[];
  readonly measures: Measures;
  /** labels and values */
  readonly summary: readonly (readonly [string, string])[];
  /** The numbers by which the outcome was decided. */
  readonly thresholds: Readonly<Record<string, number | null>>;
  readonly column: ColumnNumbers;
  readonly drawn: DrawnMotion;
  readonly series: Series;
  /** the description as a file for the command line */
  readonly toml: string;
  /** the same run as a Python program */
  readonly python: string;
};

/** Histories, all as long as `time`; null where a number is not finite. Models may add further ones. */
export type Series = {
  /** [s] */
  readonly time: readonly number[];
  /** along x, y, z [m/s²] */
  readonly base_acceleration: readonly (readonly [number, number, number])[];
  /** tilt θ [rad] */
  readonly amplitude: readonly (number | null)[];
  /** β, where it leans to [rad]; null where it stands upright */
  readonly azimuth?: readonly (number | null)[];
  /** rate of the azimuth [rad/s] */
  readonly rolling_rate?: readonly (number | null)[];
  /** angular velocity about the axis [rad/s] */
  readonly spin?: readonly (number | null)[];
  /** friction over normal force */
  readonly friction_demand?: readonly (number | null)[];
  /** moment over normal force and radius */
  readonly pivoting_demand?: readonly (number | null)[];
  /** over the weight */
  readonly normal_force?: readonly (number | null)[];
  /** 0 resting, 1 sliding, 2 rolling, 3 slipping, 4 flying, 5 jammed */
  readonly contact?: readonly (0 | 1 | 2 | 3 | 4 | 5)[];
  /** height of the lowest point above the base [m] */
  readonly clearance?: readonly (number | null)[];
  /** of the centre of the footprint since the start [m] */
  readonly displacement?: readonly (readonly (number | null)[])[];
  /** of the contact on the plane [m/s] */
  readonly slip_speed?: readonly (number | null)[];
  readonly [name: string]: unknown;
};

/** Where a run begins. */
export type Start = {
  /** along x and y [rad] */
  readonly tilt: readonly [number, number];
  /** [rad/s] */
  readonly tilt_rate: readonly [number, number];
  /** angular velocity about the axis [rad/s] */
  readonly spin: number;
  /** whether the start is approximate or its orbit unstable, one line each */
  readonly warnings: readonly string[];
};

/** A record that is kept. */
export type UploadedRecord = {
  /** its digest, for the motion {"kind": "record", "upload": …} */
  readonly upload: string;
  /** of the event */
  readonly name: string;
  /** how many */
  readonly samples: number;
  /** between them [s] */
  readonly step: number;
  /** [s] */
  readonly duration: number;
  /** Largest accelerations [m/s²]. */
  readonly peaks: {
    /** along x [m/s²] */
    readonly x?: number;
    /** along y [m/s²] */
    readonly y?: number;
    /** along z [m/s²] */
    readonly z?: number;
  };
  /** where it comes from, one line each */
  readonly provenance: readonly string[];
  /** what may be wrong with its files, one line each */
  readonly warnings: readonly string[];
};
