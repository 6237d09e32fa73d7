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
  record: "A recorded earthquake.",
  dimensionless:
    "Dimensionless: m = g = ω₀ = 1. Accelerations are a/g, frequencies Ω/ω₀ with ω₀ = √(m g h/J₀), times ω₀t.",
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
