/** Types of the answers, written by tools/page_types.py from stylobate.lab.answers. Do not edit. */

/** Options of the laboratory. */
export type About = {
  /** version of stylobate */
  readonly version: string;
  readonly limits: {
    readonly body: number;
    readonly records: number;
    readonly unpacked: number;
    readonly uploads: number;
    readonly duration: number;
    readonly steps: number;
    readonly points: number;
    readonly cells: number;
    readonly run_time: number;
    readonly wait: number;
    readonly runs: number;
    readonly jobs: number;
    readonly waiting: number;
    readonly abandoned: number;
  };
  /** kinds of columns */
  readonly shapes: readonly Kind[];
  /** kinds of models */
  readonly models: readonly Kind[];
  /** kinds of base motions */
  readonly motions: readonly Kind[];
  /** names of the sample records */
  readonly samples: readonly string[];
  /** example motions */
  readonly presets: readonly Preset[];
  /** the tour */
  readonly lessons: readonly Lesson[];
};

/** A new job. */
export type Begun = {
  /** identity of the job in requests */
  readonly id: string;
};

/** A bifurcation of a family. */
export type Bifurcation = {
  /** kind, such as Neimark-Sacker */
  readonly kind: string;
  /** [rad/s] */
  readonly angular_frequency: number;
  /** [rad] */
  readonly mean_tilt: number;
  /** whether it is supercritical; null if undecided */
  readonly supercritical: boolean | null;
};

/** A class of cells: a kind of outcome or of contact, or an attractor. */
export type CellClass = {
  /** code in the cells */
  readonly code: number;
  readonly name: string;
  /** share of all runs */
  readonly share: number | null;
  /** lower end of the interval of the share; null if there is none */
  readonly low: number | null;
  /** upper end */
  readonly high: number | null;
};

/** One of the choices of a lesson. */
export type Choice = {
  readonly text: string;
  /** parts of the description to replace */
  readonly change: Readonly<Record<string, unknown>>;
};

/** The decisive numbers of the column. */
export type ColumnNumbers = {
  /** radius of the base [m] */
  readonly radius: number;
  /** mass [kg] */
  readonly mass: number;
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
  /** moment of inertia about a horizontal axis through the centre of mass [kg m²] */
  readonly transverse_inertia: number;
  /** moment of inertia about the axis [kg m²] */
  readonly axial_inertia: number;
  /** ω0 [rad/s] */
  readonly frequency_scale: number;
  /** frequency parameter √(m g R/K) [rad/s] */
  readonly frequency_parameter: number;
  /** c g, the horizontal acceleration at which the standing column uplifts [m/s²] */
  readonly uplift_acceleration: number;
};

/** Kind of contact between column and plane: the value of the last state. */
export type Contact = 0 | 1 | 2 | 3 | 4 | 5;

/** The frequency at which the upper branch loses its stability. */
export type CriticalFrequency = {
  /** sense of rolling, seen from above */
  readonly sense: "anticlockwise" | "clockwise";
  /** [rad/s], null if there is none */
  readonly angular_frequency: number | null;
};

/** One branch of steady rolling; null at frequencies without such rolling. */
export type CurveBranch = {
  /** sense of rolling, seen from above */
  readonly sense: "anticlockwise" | "clockwise";
  /** one of the two solutions */
  readonly branch: "lower" | "upper";
  /** tilt [rad] */
  readonly amplitude: readonly (number | null)[];
  /** phase of the lean relative to the base acceleration [rad] */
  readonly phase: readonly (number | null)[];
  /** whether the motion is stable */
  readonly stable: readonly boolean[];
};

/** The snippets and the column of a description, without a run. */
export type Described = {
  /** the description as a file for the command line */
  readonly toml: string;
  /** the same run as a Python program */
  readonly python: string;
  readonly column: ColumnNumbers;
};

/** OpenAPI 3.1. */
export type Document = Readonly<Record<string, unknown>>;

/** The motion to draw, at equal time steps: lengths in m in the frame of the base, z upwards. Null for quantities that the model does not provide. */
export type DrawnMotion = {
  /** the body */
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
  readonly plane: DrawnPlane;
  /** [s] */
  readonly time: readonly number[];
  /** tilt vector θ(cos β, sin β) [rad] */
  readonly tilt: readonly (readonly [number, number])[];
  /** rate of the tilt vector [rad/s] */
  readonly tilt_rate: readonly (readonly [number, number])[];
  /** twist χ about the axis [rad] */
  readonly twist: readonly number[];
  /** angular velocity about the axis [rad/s] */
  readonly spin: readonly number[] | null;
  /** centre of the circle on the base about which the contact point lies [m] */
  readonly footprint: readonly (readonly [number, number])[];
  /** [m] */
  readonly contact_point: readonly (readonly [number, number])[];
  /** 1 if the whole base face is in contact */
  readonly resting: readonly (0 | 1)[];
  /** height of the lowest point above the base [m] */
  readonly clearance: readonly number[] | null;
  /** displacement of the base [m] */
  readonly base: readonly (readonly [number, number, number])[];
  /** unit quaternion w, x, y, z */
  readonly rotation: readonly (readonly [number, number, number, number])[];
  /** centre of the bottom circle [m] */
  readonly centre: readonly (readonly [number, number, number])[];
  /** friction over normal force */
  readonly friction_demand: readonly (number | null)[] | null;
  /** friction coefficient of the contact, if known */
  readonly friction_coefficient: number | null;
  readonly outcome: "AT_REST" | "ROCKING" | "ROLLING" | "MODULATED" | "OVERTURNED" | "STILL_MOVING" | "LIMIT_REACHED" | "LIFTED_OFF" | "FAILED" | "SLID" | "SURVIVED" | "STOPPED" | "PERIODIC" | "APERIODIC";
  /** [s] */
  readonly decided_at: number;
  /** a line that states the outcome */
  readonly title: string;
  readonly [name: string]: unknown;
};

/** The inclined plane. */
export type DrawnPlane = {
  /** [rad] */
  readonly incline: number;
  /** [rad] */
  readonly incline_direction: number;
  readonly [name: string]: unknown;
};

/** Exact periodic orbits, the result of a job `exact`. */
export type ExactOrbits = {
  readonly families: readonly OrbitFamily[];
  readonly bifurcations: readonly Bifurcation[];
};

/** The result of a map or basin: the class of each cell. */
export type GridResult = {
  /** number of runs */
  readonly runs: number;
  /** runs whose outcome is numerically uncertain: rounding or the rest threshold could alter it */
  readonly uncertain: number;
  /** a row for each value of x, with a code for each value of y; -1 if not computed */
  readonly codes: readonly (readonly number[])[];
  readonly classes: readonly CellClass[];
};

/** The state of a job. */
export type Job = {
  /** identity of the job in requests */
  readonly id: string;
  /** kind of computation */
  readonly kind: "map" | "basin" | "exact" | "animation";
  readonly state: "waiting" | "running" | "done" | "failed" | "cancelled";
  /** number of completed runs */
  readonly done: number;
  /** number of runs; 0 while unknown */
  readonly total: number;
  /** a line about the computation, such as the compilation of a kernel */
  readonly note: string;
  /** events, from the number `after` on */
  readonly events: readonly (PlaneBegun | PlaneCells)[];
  /** value of `after` in the next request */
  readonly next: number;
  /** reasons for the failure, one line each */
  readonly problems: readonly string[];
  /** the result when the job is done; null before, and for an animation, which has a file */
  readonly result: ExactOrbits | GridResult | null;
};

/** A kind of column, model or motion. */
export type Kind = {
  /** kind as in descriptions */
  readonly kind: string;
  /** name in words */
  readonly name: string;
  /** one-line description */
  readonly about: string;
  readonly parameters: readonly Parameter[];
  /** for motions: whether the base moves, so that a run needs no duration */
  readonly moves?: boolean;
};

/** A question about one case, with one control and an answer for each outcome. */
export type Lesson = {
  readonly id: string;
  readonly title: string;
  readonly question: string;
  /** what to do */
  readonly task: string;
  /** whether the page shows frequency response and maps beside the motion */
  readonly curves?: boolean;
  readonly control: LessonControl;
  /** text for each outcome; {critical} stands for the critical frequency of the case */
  readonly said: Readonly<Record<string, string>>;
  /** body for /api/simulate */
  readonly description: Readonly<Record<string, unknown>>;
  /** view on the page, as for presets */
  readonly view: Readonly<Record<string, unknown>>;
};

/** The control of a lesson: a number with a range, some choices, or both. */
export type LessonControl = {
  /** name of the number; null for choices alone */
  readonly number?: string;
  /** lower end of the range */
  readonly from?: number;
  /** upper end of the range */
  readonly to?: number;
  /** choices */
  readonly options?: readonly Choice[];
};

/** Numbers of the run as a whole. Models may add further numbers. */
export type Measures = {
  /** [rad] */
  readonly peak_tilt: number | null;
  /** peak tilt over the slenderness */
  readonly peak_tilt_over_c: number | null;
  /** [s] */
  readonly time_of_peak_tilt: number | null;
  /** [rad] */
  readonly minimum_tilt: number | null;
  /** minimum tilt at a passage through the vertical [rad]; null if none */
  readonly least_passage: number | null;
  /** turns of the contact point round the rim */
  readonly turns: number | null;
  /** steps of the integration */
  readonly steps: number | null;
  /** mean rolling rate over the last periods of the base [rad/s] */
  readonly mean_rolling_rate?: number | null;
  /** difference of the last periods, over the slenderness */
  readonly repetition?: number | null;
  /** mean tilt over the last periods [rad] */
  readonly mean_tilt_late?: number | null;
  /** minimum tilt over the last periods [rad] */
  readonly minimum_tilt_late?: number | null;
  /** peak tilt over the last periods [rad] */
  readonly peak_tilt_late?: number | null;
  /** periods of the base after which the motion repeats; 0 if it does not */
  readonly repeats_after?: number | null;
  /** change of the modulation over the second half of the run */
  readonly modulation_change?: number | null;
  /** error of the mean rolling rate, from the turns */
  readonly rolling_rate_error?: number | null;
  /** peak friction over normal force; null without a normal force */
  readonly peak_friction_demand?: number | null;
  /** peak moment over normal force and radius */
  readonly peak_pivoting_demand?: number | null;
  /** minimum normal force over weight */
  readonly minimum_normal_force?: number | null;
  /** time resting [s] */
  readonly time_resting?: number | null;
  /** time sliding [s] */
  readonly time_sliding?: number | null;
  /** time rolling [s] */
  readonly time_rolling?: number | null;
  /** time slipping [s] */
  readonly time_slipping?: number | null;
  /** time flying [s] */
  readonly time_flying?: number | null;
  /** residual displacement of the centre of the footprint [m] */
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
  /** number of impacts on the plane */
  readonly impacts?: number | null;
  /** number of starts of slip */
  readonly slips?: number | null;
  /** 1 without friction; dynamic jamming at 0 */
  readonly least_painleve_denominator?: number | null;
  readonly [name: string]: unknown;
};

/** A family of exact orbits; all its lists have the same length. */
export type OrbitFamily = {
  /** name of the family */
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
  /** whether the motion is stable */
  readonly stable: readonly boolean[];
  /** tilt at t = 0, along x and y [rad] */
  readonly tilt: readonly (readonly [number, number])[];
  /** tilt rate at t = 0 [rad/s] */
  readonly tilt_rate: readonly (readonly [number, number])[];
};

/** A parameter. */
export type Parameter = {
  /** name as in descriptions */
  readonly name: string;
  /** symbol in the literature; empty if there is none */
  readonly symbol: string;
  /** unit; empty if there is none */
  readonly unit: string;
  /** one-line description */
  readonly about: string;
  /** default value; null if there is none */
  readonly default: unknown;
  /** whether the parameter is required */
  readonly needed: boolean;
  /** whether maps can vary the parameter */
  readonly varies: boolean;
  /** lower end of the slider; null if no range suits all cases */
  readonly from: number | null;
  /** upper end of the slider */
  readonly to: number | null;
  /** possible values, if there are few */
  readonly choices?: readonly (number | string)[];
};

/** Peak accelerations. */
export type Peaks = {
  /** along x [m/s²] */
  readonly x?: number;
  /** along y [m/s²] */
  readonly y?: number;
  /** along z [m/s²] */
  readonly z?: number;
};

/** The axes of a map or basin. */
export type PlaneAxes = {
  readonly x: PlaneAxis;
  readonly y: PlaneAxis;
};

/** A quantity that varies. */
export type PlaneAxis = {
  /** name as in the description */
  readonly name: string;
  /** in SI units */
  readonly values: readonly (number | null)[];
  /** name in words */
  readonly long_name?: string;
  /** unit such as rad s-1 */
  readonly units?: string;
};

/** The first event of a map or basin: its axes, and the meanings of the codes of cells. */
export type PlaneBegun = {
  readonly axes: PlaneAxes;
  /** codes and their meanings */
  readonly names: readonly (readonly [number, string])[];
};

/** Computed cells, from coarse to fine. */
export type PlaneCells = {
  /** step between known values along x and y */
  readonly stride: number;
  /** index along x, index along y, and code */
  readonly cells: readonly (readonly [number, number, number])[];
};

/** An example motion. */
export type Preset = {
  readonly id: string;
  readonly title: string;
  readonly about: string;
  /** body for /api/simulate */
  readonly description: Readonly<Record<string, unknown>>;
  /** view on the page: branch of the start, tab, quantities over time; the page chooses what is missing */
  readonly view: Readonly<Record<string, unknown>>;
};

/** Reasons for the refusal of a request. */
export type Problems = {
  /** one line each */
  readonly problems: readonly string[];
};

/** Steady rolling over frequency, from theory; all lists are as long as `angular_frequency`. */
export type ResponseCurves = {
  /** [rad/s] */
  readonly angular_frequency: readonly number[];
  /** one for each sense and branch */
  readonly branches: readonly CurveBranch[];
  /** tilt of free rolling [rad], null if there is no such rolling */
  readonly backbone: readonly (number | null)[];
  readonly critical: readonly CriticalFrequency[];
  /** whether the curves are approximate (averaging) rather than exact */
  readonly averaged: boolean;
};

/** One run. */
export type Run = {
  /** the description as a file for the command line */
  readonly toml: string;
  /** the same run as a Python program */
  readonly python: string;
  readonly column: ColumnNumbers;
  readonly outcome: "AT_REST" | "ROCKING" | "ROLLING" | "MODULATED" | "OVERTURNED" | "STILL_MOVING" | "LIMIT_REACHED" | "LIFTED_OFF" | "FAILED" | "SLID" | "SURVIVED" | "STOPPED" | "PERIODIC" | "APERIODIC";
  /** the outcome in words */
  readonly label: "at rest" | "rocking" | "rolling" | "modulated" | "overturned" | "still moving" | "limit reached" | "lifted off" | "failed" | "slid" | "survived" | "stopped" | "periodic" | "aperiodic";
  /** reason for the outcome */
  readonly reason: string;
  /** time at which the outcome was decided [s] */
  readonly decided_at: number;
  /** whether the outcome is numerically uncertain: rounding or the rest threshold could alter it */
  readonly uncertain: boolean;
  /** whether the motion stayed in one vertical plane */
  readonly planar: boolean;
  /** one line each */
  readonly warnings: readonly string[];
  /** uplifts, impacts and other events */
  readonly events: readonly RunEvent[];
  readonly measures: Measures;
  /** labels and values */
  readonly summary: readonly (readonly [string, string])[];
  /** the thresholds that decided the outcome */
  readonly thresholds: Readonly<Record<string, number | null>>;
  readonly drawn: DrawnMotion;
  readonly series: Series;
};

/** An uplift, an impact or another event. */
export type RunEvent = {
  /** kind of event */
  readonly kind: string;
  /** time [s] */
  readonly time: number;
};

/** Histories, all as long as `time`. Models may add further histories. */
export type Series = {
  /** [s] */
  readonly time: readonly number[];
  /** base acceleration along x, y, z [m/s²] */
  readonly base_acceleration: readonly (readonly [number, number, number])[];
  /** tilt θ [rad] */
  readonly amplitude: readonly (number | null)[];
  /** azimuth β of the lean [rad]; null if the column stands upright */
  readonly azimuth?: readonly (number | null)[];
  /** rate of the azimuth [rad/s] */
  readonly rolling_rate?: readonly (number | null)[];
  /** angular velocity about the axis [rad/s] */
  readonly spin?: readonly (number | null)[];
  /** friction over normal force */
  readonly friction_demand?: readonly (number | null)[];
  /** moment over normal force and radius */
  readonly pivoting_demand?: readonly (number | null)[];
  /** normal force over weight */
  readonly normal_force?: readonly (number | null)[];
  /** 0 resting, 1 sliding, 2 rolling, 3 slipping, 4 flying, 5 jammed */
  readonly contact?: readonly Contact[];
  /** height of the lowest point above the base [m] */
  readonly clearance?: readonly (number | null)[];
  /** displacement of the centre of the footprint since the start [m] */
  readonly displacement?: readonly (readonly (number | null)[])[];
  /** slip speed of the contact on the plane [m/s] */
  readonly slip_speed?: readonly (number | null)[];
  /** time [s] and value of extremes between the samples, by history; of vectors as displacement_x */
  readonly extremes: Readonly<Record<string, readonly (readonly [number, number])[]>>;
  readonly [name: string]: unknown;
};

/** Initial conditions of a run. */
export type Start = {
  /** tilt along x and y [rad] */
  readonly tilt: readonly [number, number];
  /** [rad/s] */
  readonly tilt_rate: readonly [number, number];
  /** angular velocity about the axis [rad/s] */
  readonly spin: number;
  /** one line if the start is approximate, or its orbit unstable */
  readonly warnings: readonly string[];
};

/** An uploaded record. */
export type UploadedRecord = {
  /** digest, for the motion {"kind": "record", "upload": …} */
  readonly upload: string;
  /** name of the event */
  readonly name: string;
  /** number of samples */
  readonly samples: number;
  /** time step [s] */
  readonly step: number;
  /** duration [s] */
  readonly duration: number;
  readonly peaks: Peaks;
  /** origin, one line each */
  readonly provenance: readonly string[];
  /** possible mistakes in its files, one line each */
  readonly warnings: readonly string[];
  /** names of the records in an archive, of which this is one; else none */
  readonly records: readonly string[];
};

/** Small variations of one case. */
export type Variations = {
  readonly varied: readonly Varied[];
  /** number of runs */
  readonly runs: number;
  /** outcomes that occur, the most frequent first */
  readonly classes: readonly CellClass[];
  /** of each run */
  readonly outcomes: readonly ("AT_REST" | "ROCKING" | "ROLLING" | "MODULATED" | "OVERTURNED" | "STILL_MOVING" | "LIMIT_REACHED" | "LIFTED_OFF" | "FAILED" | "SLID" | "SURVIVED" | "STOPPED" | "PERIODIC" | "APERIODIC")[];
  /** of each run [s] */
  readonly times: readonly (readonly (number | null)[])[];
  /** of each run [rad] */
  readonly tilts: readonly (readonly (number | null)[])[];
};

/** A number that varies. */
export type Varied = {
  /** name as in the description; scale is the strength of the base motion */
  readonly name: string;
  /** standard deviation of its logarithm */
  readonly deviation: number;
};
