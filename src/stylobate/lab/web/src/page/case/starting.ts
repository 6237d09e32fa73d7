/** Where a run begins: as set, standing, or on a branch of steady rolling that is followed when the case changes. */

import type { Source } from "../server/source";
import type { Description, Part, Value } from "./description";
import { isVector, kindOf, written } from "./description";
import { isHorizontalHarmonic } from "./frequency";
import { isPlanar } from "./in-one-plane";
import { OFF_BRANCH, START, TURNING } from "../server/declared";

export const BRANCHES = ["upper", "lower"] as const;
export type Branch = (typeof BRANCHES)[number];

/** The kinds of start that a reader chooses from. */
export type StartKind = Branch | "standing" | "set";

/** Returns a start on a branch or an orbit, a little off it. */
export function offBranch<Start extends { readonly tilt: readonly [number, number] }>(start: Start): Start {
  const [x, y] = start.tilt;
  return { ...start, tilt: [x * (1 + OFF_BRANCH), y * (1 + OFF_BRANCH)] };
}

/** Returns what the start on a branch depends on. */
export function startedFrom({ column, model, motion }: Description): Part {
  return { column, model, motion };
}

/** Returns whether two cases have the same start on a branch. */
export function startAlike(one: Description, other: Description): boolean {
  return written(startedFrom(one)) === written(startedFrom(other));
}

/** Returns what of a case its start is. */
export function startOf(description: Description): Part {
  return Object.fromEntries(START.map((name) => [name, description[name] ?? null]));
}

/** Returns the case with a column that stands at first. */
export function standing(description: Description): Description {
  return Object.fromEntries(Object.entries(description).filter(([name]) => !START.includes(name))) as Description;
}

export function isStanding(description: Description): boolean {
  return START.every((name) => isZero(description[name]));
}

function isZero(value: Value | undefined): boolean {
  return isVector(value) ? value.every((one) => one === 0) : value === undefined || value === null || value === 0;
}

export function startKind(description: Description, branch: Branch | null): StartKind {
  return branch ?? (isStanding(description) ? "standing" : "set");
}

export function mayTurn(description: Description): boolean {
  return TURNING.includes(kindOf(description, "model"));
}

/** Whether a case may roll steadily on this branch, so that a run can start there. */
export type HasBranch = (description: Description, branch: Branch) => boolean;

/** Returns how it is known which branches a case has that a source finds. */
export function branchesOf({ offers }: Pick<Source, "offers">): HasBranch {
  return (description, branch) =>
    isHorizontalHarmonic(description.motion) &&
    !isPlanar(description) &&
    offers("start", { ...startedFrom(description), branch });
}
