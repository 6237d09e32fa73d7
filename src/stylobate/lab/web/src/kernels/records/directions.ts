/** Directions of components: their names, in files too, and rotation to the axes x, y and z. */

import { Refused } from "../../page/server/source";
import { general } from "../general";
import { baseOf } from "./archive";
import { trimmedEnd } from "./python";

/** Direction in which a component is positive. */
export interface Direction {
  /** Clockwise from north [degrees]; null if it is unknown. */
  readonly azimuth: number | null;
  /** 1 for up, -1 for down, 0 for horizontal. */
  readonly vertical: number;
  /** One of two perpendicular axes of unknown azimuth. */
  readonly axis: "x" | "y" | null;
}

export const AXES = ["x", "y", "z"] as const;
export type Axis = (typeof AXES)[number];

/** Accelerations along axes; those of other axes are zero. */
export type AlongAxes = Partial<Record<Axis, Float64Array>>;

function directions(names: string, direction: Partial<Direction>): [string, Direction][] {
  return names.split(" ").map((name) => [name, { azimuth: null, vertical: 0, axis: null, ...direction }]);
}

const NAMES = new Map<string, Direction>([
  ...directions("N NS N-S NSC NORTH", { azimuth: 0 }),
  ...directions("E EW E-W WE WEC EAST", { azimuth: 90 }),
  ...directions("S SOUTH", { azimuth: 180 }),
  ...directions("W WEST", { azimuth: 270 }),
  ...directions("UP UPC V Z ZUP UD U-D VER VERT VRT VERTICAL", { vertical: 1 }),
  ...directions("DN DWN DOWN", { vertical: -1 }),
  ...directions("L L1 LONG LONGITUDINAL H1 X XTE R FN", { axis: "x" }),
  ...directions("T T1 TRAN TRANS TRANSVERSE H2 Y YLN FP", { axis: "y" }),
]);

/** Bearings from north or south, such as N10E. */
const QUADRANT = String.raw`[NSns]\s*\d{1,3}(?:\.\d+)?\s*°?\s*[EWew]`;
/** SEED codes of accelerometers and seismometers, such as HNE. */
const CHANNEL = "[BEH][GHLN][ENZ12]";

const IS_CHANNEL = new RegExp(`^${CHANNEL}$`);
const AZIMUTH = /^(\d{1,3}(?:\.\d+)?)\s*(?:DEG\w*|°)?\.?$/;
const BEARING = /^([NS])\s*(\d{1,3}(?:\.\d+)?)\s*°?\s*([EW])$/;

/** Parses the direction in a name such as "090", "NS", "S61W", "HNZ", "UP" or "L1"; null for other names. */
export function parsedDirection(text: string): Direction | null {
  let plain = text.trim().toUpperCase();
  if (IS_CHANNEL.test(plain)) plain = plain.replace(/^..([12])$/, "H$1").replace(/^..([ENZ])$/, "$1");
  const named = NAMES.get(plain);
  if (named) return named;
  const azimuth = Number(AZIMUTH.exec(plain)?.[1] ?? NaN);
  if (azimuth <= 360) return { azimuth: azimuth % 360, vertical: 0, axis: null };
  const [, from, angle, to] = BEARING.exec(plain) ?? [];
  if (from === undefined || Number(angle) > 180) return null;
  const turn = (from === "N") === (to === "E") ? Number(angle) : -Number(angle);
  return { azimuth: inCircle((from === "N" ? 0 : 180) + turn), vertical: 0, axis: null };
}

/** Returns an angle from 0° to below 360°. */
function inCircle(degrees: number): number {
  const rest = degrees % 360;
  return rest < 0 ? rest + 360 : rest;
}

/** Returns whether both can describe one component; a name may leave the sign along a line open. */
export function agree(one: Direction, other: Direction): boolean {
  if (one.azimuth === null || other.azimuth === null) return (one.vertical !== 0) === (other.vertical !== 0);
  return (one.azimuth - other.azimuth) % 180 === 0;
}

export function inWords({ azimuth, vertical, axis }: Direction): string {
  if (vertical !== 0) return vertical > 0 ? "up" : "down";
  if (axis !== null) return `${axis === "x" ? "first" : "second"} of two perpendicular axes`;
  return `azimuth ${general(azimuth ?? NaN, 6)}°`;
}

// Names of files

/** Returns a pattern for some words, whatever the case of their letters. */
function anyCase(pattern: string): string {
  return pattern.replace(/[a-z]/gi, (letter) => `[${letter.toLowerCase()}${letter.toUpperCase()}]`);
}

/** Returns a pattern for whole names. */
function whole(pattern: string): RegExp {
  return new RegExp(`^(?:${pattern})$`);
}

const ENDINGS = new Set([".at2", ".txt", ".csv", ".dat", ".asc", ".acc"]);
const REMARKS =
  "scaled|filtered|corrected|corr?|uncorrected|matched|processed|proc|raw|resampled|trimmed|accel|acceleration|acc";
const REMARK = `(?<remark>(?:[-_. ](?:${anyCase(REMARKS)}))*)`;
const ITS_REMARK = whole(`.*?${REMARK}`);
const WORDS = anyCase([...NAMES.keys()].sort((one, other) => other.length - one.length).join("|"));
const APART = String.raw`[-_. ]+(?<apart>${WORDS}|${CHANNEL}|${QUADRANT}|\d{3})`;
const CAPITALS = "NS|EW|UP|DWN|DOWN|UD|VER|VERT|XTE|YLN|ZUP";
// More digits than these are a date or a time: 20160117 is not azimuth 117.
const JOINED = String.raw`(?<joined>${QUADRANT}|${CAPITALS}|(?<=\d)(?:${anyCase(CAPITALS)})|(?<!\d{3})\d{3})`;
const UNSURE = String.raw`(?<joined>(?<!\d{5})\d{3}|[HLT][12]|[NESWLTVZXY])`;
const KIK_NET = whole(String.raw`(?<event>.+)\.(?<apart>NS|EW|UD)(?<remark>[12])`);
const IN_NAMES = [
  KIK_NET,
  whole(`(?<event>.+?)(?:${APART}|${JOINED})${REMARK}`),
  whole(`(?<apart>${anyCase("NS|EW|UD|UP|N-S|E-W|U-D|DWN|VER|VERT|H1|H2")})[-_. ]+(?<event>.+)`),
  whole(`(?<event>.+[-_. ])(?<apart>${CHANNEL})(?<remark>[-_. ].+)`),
] as const;
/** Length of the name of a file at most, on usual systems: a longer text names no direction, after a long search. */
const LONGEST_NAME = 255;
const UNSURE_TAIL = whole(`(?<event>.+?)${UNSURE}${REMARK}`);

/** Returns the name of a file without the suffixes of its format; suffixes such as `.EW` stay. */
export function stemOf(file: string): string {
  const name = baseOf(file)
    .replace(/\.gz$/, "")
    .replace(/\.zip$/, "");
  const [, first = "", ending = ""] = /^(.*)\.([^.]*)$/.exec(name) ?? [];
  if (first === "" || KIK_NET.test(name) || (!/^\d+$/.test(ending) && parsedDirection(ending))) return name;
  let stem = first;
  while (ENDINGS.has(stem.slice(stem.lastIndexOf(".")).toLowerCase())) stem = stem.slice(0, stem.lastIndexOf("."));
  return stem;
}

/** Returns the words of a name that mark a processed copy; empty without them. */
export function remarkOf(stem: string): string {
  if (stem.length > LONGEST_NAME) return "";
  return (ITS_REMARK.exec(stem)?.groups?.["remark"] ?? "").toLowerCase();
}

export interface NameParts {
  /** The common part of the names of the files of an event. */
  readonly event: string;
  readonly direction: Direction | null;
}

/**
 * Splits the name of a file into the common part of its event and the direction of its component. `unsure`: a single
 * letter, or digits after many digits, also count, as in PRPCS, PRPCW.
 */
export function splitName(stem: string, unsure = false): NameParts {
  const patterns = unsure ? [...IN_NAMES, UNSURE_TAIL] : IN_NAMES;
  for (const pattern of stem.length > LONGEST_NAME ? [] : patterns) {
    const found = pattern.exec(stem)?.groups;
    if (!found) continue;
    const direction = parsedDirection(found["apart"] ?? found["joined"] ?? "");
    const event = trimmedEnd(found["event"] ?? "", "-_. ");
    if (direction && /[^-_. ]/.test(event)) return { event: event + (found["remark"] ?? ""), direction };
  }
  return { event: stem, direction: null };
}

// Rotation

/** Minimum sine of the angle between horizontal components that determine the motion. */
const LEAST_SINE = 0.5;

/** Accelerations that are positive in this direction, with their file or column. */
export interface Directed {
  readonly label: string;
  readonly direction: Direction;
  readonly samples: Float64Array;
}

function radians(degrees: number): number {
  return degrees * (Math.PI / 180);
}

/** Returns the sine of the angle between two horizontal directions; 0 if they are not independent. */
function sineBetween(first: Direction, second: Direction): number {
  if (first.azimuth === null || second.azimuth === null) {
    return first.axis !== null && second.axis !== null && first.axis !== second.axis ? 1 : 0;
  }
  const sine = Math.sin(radians(second.azimuth - first.azimuth));
  return Math.abs(sine) >= LEAST_SINE ? sine : 0;
}

/** Returns whether one event can have these directions: one vertical and two perpendicular ones at most. */
export function isOneSet(some: readonly Direction[]): boolean {
  const [first, second, ...more] = some.filter((one) => one.vertical === 0);
  const vertical = some.filter((one) => one.vertical !== 0).length;
  return vertical <= 1 && more.length === 0 && (!first || !second || sineBetween(first, second) !== 0);
}

/**
 * Rotates components to x, y and z, and returns their origin in words. x points along the lower azimuth of two, y 90°
 * anticlockwise from x, z up.
 */
export function alongAxes(event: string, components: readonly Directed[]): { axes: AlongAxes; origin: string } {
  const up = components.filter((one) => one.direction.vertical !== 0);
  const order = ({ direction: { azimuth, axis } }: Directed): number => azimuth ?? (axis === "y" ? 1 : 0);
  const flat = components.filter((one) => !up.includes(one)).sort((one, other) => order(one) - order(other));
  if (up.length > 1 || flat.length > 2) {
    const wanted = "two horizontal components and a vertical one at most";
    const remedy = "If they are of several events, list the files of each event together";
    throw new Refused(422, [`${event}: ${wanted}, got ${listed(components)}. ${remedy}`]);
  }
  const { axes, lines } = horizontal(event, flat);
  for (const { label, direction, samples } of up) {
    axes.z = samples.map((value) => direction.vertical * value);
    lines.push(`z up, from ${label} (${inWords(direction)})`);
  }
  return { axes, origin: lines.join("; ") };
}

function listed(components: readonly Directed[]): string {
  return components.map(({ label, direction }) => `${label} (${inWords(direction)})`).join(", ");
}

function horizontal(event: string, flat: readonly Directed[]): { axes: AlongAxes; lines: string[] } {
  const [first, second] = flat;
  if (!first) return { axes: {}, lines: [] };
  const one = first.direction;
  if (!second) {
    const where = one.axis === null ? `at ${inWords(one)}` : `along the ${inWords(one)}`;
    return { axes: { x: first.samples }, lines: [`x ${where}, from ${first.label}`] };
  }
  const other = second.direction;
  if (sineBetween(one, other) === 0) {
    const wanted = "horizontal components must be perpendicular, or nearly so";
    const remedy = "State directions, or list the files of each event together";
    throw new Refused(422, [`${event}: ${wanted}, got ${listed(flat)}. ${remedy}`]);
  }
  if (one.azimuth === null || other.azimuth === null) {
    const from = ({ label, direction }: Directed): string => `from ${label} (${inWords(direction)}, azimuth unknown)`;
    return { axes: { x: first.samples, y: second.samples }, lines: [`x ${from(first)}`, `y ${from(second)}`] };
  }
  const lateral = { ...one, azimuth: inCircle(one.azimuth - 90) };
  const lines = [
    `x at ${inWords(one)}, from ${first.label}`,
    `y at ${inWords(lateral)}, from ${second.label} (${inWords(other)})`,
  ];
  return {
    axes: { x: first.samples, y: acrossFirst(first.samples, second.samples, other.azimuth - one.azimuth) },
    lines,
  };
}

/** Returns (a1 cos Δ − a2)/sin Δ for two components with the angle Δ [degrees] between them. */
function acrossFirst(first: Float64Array, second: Float64Array, angle: number): Float64Array {
  const turn = radians(angle);
  // exact right angles: the rounding error of cos 90° must not mix the components
  const across = Math.abs(Math.cos(turn)) < 1e-12;
  const [cos, sin] = across ? [0, Math.sign(Math.sin(turn))] : [Math.cos(turn), Math.sin(turn)];
  return first.map((value, k) => (value * cos - (second[k] ?? NaN)) / sin);
}
