/** A described case as the numbers of a program. */

import type { Part, Value } from "../page/case/description";
import { isPart } from "../page/case/description";
import type { Kernels, Numbers } from "./kernels";

/** The case has something that no program knows. */
export class Unknown extends Error {}

export interface Case {
  /** Name of the program. */
  readonly program: string;
  /** The numbers of the column and its derived ones, by name. */
  readonly column: Readonly<Record<string, number>>;
  /** The numbers of a run, by name. */
  readonly numbers: Readonly<Record<string, number>>;
  /** Period of the base motion [s]; null if it rests. */
  readonly period: number | null;
}

/** What a description of a run may have besides its case. */
const OF_A_RUN = new Set(["column", "model", "motion", "tilt", "tilt_rate", "spin", "twist", "position", "duration"]);

export async function caseOf(kernels: Kernels, given: Part): Promise<Case> {
  for (const [name, value] of Object.entries(given)) {
    if (!OF_A_RUN.has(name) && value !== null) throw new Unknown(`${name} is not computed here`);
  }
  const column = await kernels.made("column", part(given, "column"), "shape");
  const motion = given["motion"] === undefined ? { kind: "rest" } : part(given, "motion");
  const rests = motion["kind"] === "rest";
  const moves = rests ? {} : await harmonic(kernels, motion);
  const kind = String(part(given, "model")["kind"] ?? "wobbling");
  const program = `${kind}_${rests ? "rest" : "harmonic"}`;
  const described = kernels.described.programs[program];
  if (!described) throw new Unknown(`the model ${kind} is not computed here`);
  const model: Record<string, number> = {};
  for (const { name, default: usual, choices } of described.numbers) {
    const value = part(given, "model")[name] ?? usual;
    model[name] = choices.length > 0 ? Math.max(0, choices.indexOf(String(value))) : numberOf(value, NaN, name);
  }
  refuseOthers(part(given, "model"), ["kind", ...Object.keys(model)]);
  const frequency = moves["angular_frequency"];
  return {
    program,
    column,
    numbers: { ...column, ...model, ...moves, ...start(given) },
    period: frequency === undefined ? null : (2 * Math.PI) / frequency,
  };
}

async function harmonic(kernels: Kernels, motion: Part): Promise<Numbers> {
  const [ax, ay, az, px, py, pz, frequency, phase, ramp] = Object.values(await kernels.made("motion", motion, "kind"));
  if (ramp !== 0) throw new Unknown("a ramp is not computed here");
  const [amplitude, phases] = [named("amplitude", [ax, ay, az]), named("phase", [px, py, pz])];
  return { ...amplitude, ...phases, angular_frequency: frequency ?? NaN, start_phase: phase ?? NaN };
}

function named(name: string, values: readonly (number | undefined)[]): Numbers {
  return Object.fromEntries(values.map((value, axis) => [`${name}_${"xyz"[axis]}`, value ?? NaN]));
}

function start(given: Part): Numbers {
  const vectors = { tilt: 2, tilt_rate: 2, position: 2, velocity: 3 };
  const found: Record<string, number> = {};
  for (const [name, length] of Object.entries(vectors)) {
    const values = Array.isArray(given[name]) ? (given[name] as readonly Value[]) : [];
    for (let axis = 0; axis < length; axis += 1) found[`${name}_${"xyz"[axis]}`] = numberOf(values[axis], 0, name);
  }
  for (const name of ["spin", "twist", "clearance"]) found[name] = numberOf(given[name], 0, name);
  return found;
}

export function numberOf(value: Value | undefined, usual: number, name: string): number {
  if (value === undefined || value === null) return usual;
  if (typeof value !== "number") throw new Unknown(`${name} is not a number here`);
  return value;
}

export function refuseOthers(given: Part, known: readonly string[]): void {
  const other = Object.entries(given).find(([name, value]) => value !== null && !known.includes(name));
  if (other) throw new Unknown(`${other[0]} is not computed here`);
}

function part(given: Part, name: string): Part {
  const found = given[name];
  if (!isPart(found)) throw new Unknown(`${name} is missing`);
  return found;
}
