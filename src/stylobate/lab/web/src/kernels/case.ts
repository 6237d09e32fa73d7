/** A described case as the numbers of a program. */

import type { Part, Value } from "../page/case/description";
import { PARTS, isPart, isVector } from "../page/case/description";
import { START } from "../page/server/declared";
import { Refused } from "../page/server/source";
import { filled, general } from "./general";
import type { Declared, Kernels, Numbers } from "./kernels";
import { Unknown } from "./refusals";
import { type Shaking, type Vector, shakingOf } from "./shaking";

export interface Case {
  /** Name of the program. */
  readonly program: string;
  /** The numbers of the column and its derived ones, by name. */
  readonly column: Readonly<Record<string, number>>;
  /** The numbers of a run, by name; those of a tabulated base motion are in its table. */
  readonly numbers: Readonly<Record<string, number>>;
  readonly shaking: Shaking;
}

/** What a description of a run may have besides its case. */
const OF_A_RUN = new Set<string>([...PARTS, ...START, "duration", "friction_coefficient"]);

export async function caseOf(kernels: Kernels, given: Part): Promise<Case> {
  for (const [name, value] of Object.entries(given)) {
    if (!OF_A_RUN.has(name) && value !== null) throw new Unknown(`${name} is not computed here`);
  }
  const column = await kernels.made("column", part(given, "column"), "shape");
  const motion = given["motion"] === undefined ? { kind: "rest" } : part(given, "motion");
  const shaking = await shakingOf(kernels, motion);
  const kind = String(part(given, "model")["kind"] ?? "wobbling");
  const program = `${kind}_${shaking.kind}`;
  const described = kernels.described.programs[program];
  if (!described) throw new Unknown(`the model ${kind} is not computed here`);
  const model: Record<string, number> = {};
  for (const one of described.numbers) {
    const { name, default: usual, choices } = one;
    const value = part(given, "model")[name] ?? usual;
    if (choices.length > 0) model[name] = Math.max(0, choices.indexOf(String(value)));
    else model[name] = value === null ? NaN : checked(numberOf(value, NaN, name), one);
  }
  refuseOthers(part(given, "model"), ["kind", ...Object.keys(model)]);
  const numbers = { ...column, ...model, ...shaking.numbers, ...start(kernels, given) };
  checkStart(kernels, kind, program, numbers, shaking);
  return { program, column, numbers, shaking };
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

/** Returns a number, or refuses one that its declaration does not allow. */
export function checked(value: number, one: Declared): number {
  const { ge, gt, le, lt, choices } = one;
  const high = (le === null || value <= le) && (lt === null || value < lt);
  const low = (ge === null || value >= ge) && (gt === null || value > gt);
  const chosen = choices.length === 0 || choices.includes(value);
  if (low && high && chosen && Number.isFinite(value)) return value;
  if (Number.isNaN(value)) throw new Refused(422, [`${one.name} is missing`]);
  const demand = chosen ? one.demand : `be ${choices.join(" or ")}`;
  throw new Refused(422, [`${one.name} must ${demand}, got ${value} ${one.unit}`.trimEnd()]);
}

/** Refuses initial conditions that the model does not support. */
function checkStart(kernels: Kernels, kind: string, program: string, numbers: Numbers, shaking: Shaking): void {
  const { refusals, programs } = kernels.described;
  const [described, model] = [programs[program], kind.replaceAll("_", " ")];
  const of = (name: string): number => numbers[name] ?? 0;
  const tilt = Math.hypot(of("tilt_x"), of("tilt_y"));
  if (!(tilt < Math.PI / 2)) throw new Refused(422, [`tilt must be below π/2 in length, got ${tilt} rad`]);
  const spin = of("spin");
  if (spin !== 0 && !described?.spins) throw new Refused(422, [filled(refusals.no_spin, { model, spin })]);
  const stands = tilt === 0 && of("tilt_rate_x") === 0 && of("tilt_rate_y") === 0;
  if (spin !== 0 && stands) throw new Refused(422, [filled(refusals.spin_upright, { spin })]);
  if (described?.planar_only && !inOnePlane(of, shaking.vectors())) {
    const vector = (name: string): string => `${name} (${general(of(`${name}_x`), 5)}, ${general(of(`${name}_y`), 5)})`;
    const given = `${vector("tilt")}, ${vector("tilt_rate")}`;
    throw new Refused(422, [filled(refusals.out_of_plane, { model, given })]);
  }
}

const PARALLEL = 1e-12;

function inOnePlane(of: (name: string) => number, shaking: readonly Vector[]): boolean {
  const vectors: readonly Vector[] = [[of("tilt_x"), of("tilt_y")], [of("tilt_rate_x"), of("tilt_rate_y")], ...shaking];
  const sizes = vectors.map(([x, y]) => Math.hypot(x, y));
  const [ux, uy] = vectors[sizes.indexOf(Math.max(...sizes))] ?? [0, 0];
  const longest = Math.hypot(ux, uy);
  return vectors.every(([x, y]) => Math.abs(ux * y - uy * x) <= PARALLEL * longest * longest);
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
