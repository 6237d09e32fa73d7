/** A described case as the numbers of a program. */

import type { Part, Value } from "../page/case/description";
import { PARTS, isPart, isVector } from "../page/case/description";
import { START } from "../page/server/declared";
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
const OF_A_RUN = new Set<string>([...PARTS, ...START, "duration"]);

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
    numbers: { ...column, ...model, ...moves, ...start(kernels, given) },
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

/** Returns the initial conditions: those that are given, and 0 for the others. */
function start(kernels: Kernels, given: Part): Numbers {
  const found: Record<string, number> = {};
  for (const name of kernels.described.common.given) found[name] = 0;
  for (const name of START) {
    const value = given[name];
    if (!isVector(value)) found[name] = numberOf(value, 0, name);
    else value.forEach((one, axis) => (found[`${name}_${"xyz"[axis]}`] = numberOf(one, 0, name)));
  }
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
