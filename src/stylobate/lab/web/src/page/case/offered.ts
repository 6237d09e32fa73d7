/** The kinds as the page offers them: with the numbers that have a control, and a first value for each of those. */

import type { About, Kind, Parameter } from "./about";
import type { Value } from "./description";
import { isPart } from "./description";

/** First values of numbers that a kind needs: bodies and motions of everyday size. */
const FIRST: Readonly<Record<string, Readonly<Record<string, Value>>>> = {
  solid: { radius: 0.5, height: 5, density: 2700 },
  hollow: { radius: 0.5, inner_radius: 0.4, height: 4, density: 2700 },
  frustum: { radius: 0.6, top_radius: 0.45, height: 5, density: 2700 },
  dimensionless: { slenderness: 0.1 },
  given: { radius: 0.5, mass_height: 2.5, mass: 10_000, transverse_inertia: 21_000, axial_inertia: 1250 },
  elliptic: { amplitude: [1, 0.5], phase: 1.5708 },
  displacement_amplitude: { amplitude: [0.02, 0, 0] },
  harmonic: { amplitude: [1, 0.5, 0], phase: [0, 1.5708, 0] },
  oblique: { acceleration: 3, angular_frequency: 150, angle: 0.5 },
  vertical: { acceleration: 2 },
  stroke: { stroke: 0.05, frequency: 1 },
  orbit: { diameter: 0.02, rpm: 180 },
  type_a: { velocity: 0.5 },
  type_b: { velocity: 0.5 },
  type_c: { velocity: 0.5 },
  gabor: { velocity: 0.5, frequency: 0.7, oscillations: 2 },
  mavroeidis_papageorgiou: { velocity: 0.5, frequency: 0.7, oscillations: 2 },
  linear_sweep: { acceleration: 1, frequencies: [0.5, 5], length: 40 },
  logarithmic_sweep: { acceleration: 1, frequencies: [0.5, 5], length: 40 },
  record: { scale: 1 },
};

const OF_ANY: Readonly<Record<string, Value>> = { acceleration: 1.5, angular_frequency: 3 };

/** Quantities whose unit is another one in some kinds: an amplitude may be a displacement. */
const UNITS: Readonly<Record<string, Readonly<Record<string, string>>>> = {
  elliptic: { amplitude: "m/s²" },
  harmonic: { amplitude: "m/s²" },
  displacement_amplitude: { amplitude: "m" },
};

/** What is said of a kind in other words than the server's. */
const ABOUT: Readonly<Record<string, string>> = {
  // Columns
  solid: "A solid cylinder. Give its density or its mass.",
  hollow: "A tube with a flat base. Give its density or its mass.",
  frustum: "A column or vase that tapers or widens upwards. Give its density or its mass.",
  dimensionless:
    "Dimensionless: m = g = ω₀ = 1. Accelerations are a/g, frequencies Ω/ω₀ with ω₀ = √(m g h/J₀), times ω₀t.",
  given: "Any round body, by its mass, the height of its centre of mass, and its moments of inertia.",
  // Models
  slender: "Small tilts, no slip, no spin about the axis: the equations of the paper. The fastest.",
  slender_rolling: "Small tilts, no slip; the column may spin about its axis.",
  wobbling: "Any tilt up to lying flat; rolls on its rim and cannot spin about its axis.",
  rolling: "Any tilt; rolls without slip and may spin about its axis.",
  sliding: "Any tilt; the column may also slide, lift off and land. Computed most slowly.",
  planar_rocking: "Rocks in one vertical plane from edge to edge, as a block (Housner).",
  // Motions
  rest: "The base does not move.",
  circular: "The base moves on a horizontal circle without turning; its acceleration has a constant size.",
  straight: "The base moves to and fro along a horizontal line.",
  elliptic: "The base moves on a horizontal ellipse: two straight motions at right angles, out of step by the phase.",
  vertical: "The base moves up and down.",
  harmonic: "Three motions of one frequency, along x, y and z, each with a phase of its own.",
  oblique: "To and fro along a line that rises from the horizontal, as in a vibratory conveyor.",
  displacement_amplitude: "Three motions of one frequency, set by how far the base moves.",
  stroke: "To and fro, set by the stroke from end to end and the frequency.",
  orbit: "The base moves on a circle, set by its diameter and the revolutions per minute.",
  machine_run: "A vibratory machine: it runs up, works and runs down.",
  half_sine: "One push: half a sine of acceleration. The base keeps its speed afterwards.",
  half_cosine: "Half a cosine of acceleration: the base moves on and stops.",
  one_sine: "One full sine of acceleration: the base stops at another place.",
  one_cosine: "One full cosine of acceleration: forward and back.",
  ricker: "A pulse with one main peak, and a lesser one of opposite sign on either side.",
  antisymmetric_ricker: "A pulse with two main peaks of opposite sign.",
  sinusoidal: "A few periods of a sinusoid.",
  type_a: "A near-fault pulse that moves the base forward and leaves it there.",
  type_b: "A near-fault pulse that moves the base forward and back.",
  type_c: "A near-fault pulse with several swings to and fro.",
  gabor: "A near-fault pulse: an oscillation under a bell-shaped envelope.",
  mavroeidis_papageorgiou: "A near-fault pulse: an oscillation that grows and fades.",
  linear_sweep:
    "The frequency rises by the same number of hertz in each second. Set the acceleration or the displacement.",
  logarithmic_sweep: "The frequency rises by the same factor in each second. Set the acceleration or the displacement.",
  record: "A recorded earthquake.",
};

/** Labels of numbers whose names do not explain themselves. */
export const LABELS: Readonly<Record<string, string>> = {
  steady: "Time at full speed",
  vertical: "Vertical part",
  rpm: "Revolutions per minute",
  patch: "Radius of the contact patch",
  tail: "Time after the record",
};

const [SHAKING, SHAKERS, PULSES, NEAR_FAULT, SWEEPS, EARTHQUAKES] = [
  ...["Steady shaking, by acceleration", "Shakers and machines", "Pulses, by acceleration"],
  ...["Near-fault pulses, by velocity", "Sine sweeps", "Earthquakes"],
] as const;

/** Names as the literature has them, and the heading under which a kind is listed. */
const NAMES: Readonly<Record<string, readonly [name: string, group?: string]>> = {
  rest: ["at rest"],
  circular: ["circular", SHAKING],
  straight: ["straight", SHAKING],
  elliptic: ["elliptic", SHAKING],
  harmonic: ["three components", SHAKING],
  vertical: ["vertical", SHAKING],
  oblique: ["oblique (vibratory conveyor)", SHAKERS],
  orbit: ["orbital shaker", SHAKERS],
  stroke: ["straight shaker, by stroke", SHAKERS],
  displacement_amplitude: ["by displacement amplitudes", SHAKERS],
  half_sine: ["half sine", PULSES],
  half_cosine: ["half cosine", PULSES],
  one_sine: ["one sine", PULSES],
  one_cosine: ["one cosine", PULSES],
  ricker: ["Ricker", PULSES],
  antisymmetric_ricker: ["antisymmetric Ricker", PULSES],
  sinusoidal: ["part of a sinusoid", PULSES],
  type_a: ["type A (forward)", NEAR_FAULT],
  type_b: ["type B (forward and back)", NEAR_FAULT],
  type_c: ["type Cₙ (several cycles)", NEAR_FAULT],
  gabor: ["Gabor", NEAR_FAULT],
  mavroeidis_papageorgiou: ["Mavroeidis and Papageorgiou", NEAR_FAULT],
  linear_sweep: ["linear sweep", SWEEPS],
  logarithmic_sweep: ["logarithmic sweep", SWEEPS],
  record: ["record", EARTHQUAKES],
  given: ["given by mass and inertia"],
};

/** What of a record is set by numbers; which record it is has controls of its own. */
const OF_RECORDS = ["scale", "rotation", "tail"];

/** Returns what the server offers in the form in which the page shows it. */
export function offered(about: About): About {
  const all = (kinds: readonly Kind[]): readonly Kind[] => kinds.map(offeredKind);
  return { ...about, shapes: all(about.shapes), models: all(about.models), motions: all(about.motions) };
}

function offeredKind(kind: Kind): Kind {
  const first = FIRST[kind.kind] ?? {};
  const parameters = kind.parameters
    .filter((one) => (kind.kind === "record" ? OF_RECORDS.includes(one.name) : !isPart(one.default)))
    .map((one) => withFirst(one, first, UNITS[kind.kind]?.[one.name]));
  const about = ABOUT[kind.kind] ?? inOneSentence(kind.about ?? "");
  const [name, group] = NAMES[kind.kind] ?? [kind.name];
  return { ...kind, name, about, parameters, ...(group === undefined ? {} : { group }) };
}

/** Returns what a kind is; units and names that follow stand beside the numbers. */
function inOneSentence(text: string): string {
  const [first = ""] = text
    .replaceAll("`", "")
    .replaceAll(/ \[[^\]]*\]/g, "")
    .split(/; |, by its /);
  return first === "" || first.endsWith(".") ? first : `${first}.`;
}

function withFirst(parameter: Parameter, first: Readonly<Record<string, Value>>, unit: string | undefined): Parameter {
  const value = first[parameter.name] ?? (parameter.needed === true ? OF_ANY[parameter.name] : undefined);
  const units = unit === undefined ? {} : { unit };
  if (value !== undefined) return { ...parameter, ...units, default: value };
  return parameter.needed === true
    ? { ...parameter, ...units, default: middle(parameter) }
    : { ...parameter, ...units };
}

/** Returns a value well within the range. */
function middle({ from, to }: Parameter): number {
  const [low, high] = [from ?? 0, to ?? 1];
  return Number((low > 0 ? Math.sqrt(low * high) : (low + high) / 2).toPrecision(2));
}
