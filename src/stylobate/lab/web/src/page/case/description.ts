/** The plain values of a description: the names are those of the TOML files of the command line. */

import { START } from "../server/declared";

export type Value = number | string | boolean | null | readonly Value[] | { readonly [name: string]: Value };

/** A column, a model or a motion: its shape or kind, and its numbers. */
export type Part = Readonly<Record<string, Value>>;

export interface Description extends Readonly<Record<string, Value>> {
  readonly column: Part;
  readonly model: Part;
  readonly motion: Part;
}

export const PARTS = ["column", "model", "motion"] as const;
export type PartName = (typeof PARTS)[number];

/** What tells the members of a part apart: columns have a shape, models and motions a kind. */
export function tagOf(part: PartName): "shape" | "kind" {
  return part === "column" ? "shape" : "kind";
}

export function kindOf(description: Description, part: PartName): string {
  return String(description[part][tagOf(part)] ?? "");
}

export function isPart(value: Value | undefined): value is Part {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

export function isVector(value: Value | undefined): value is readonly Value[] {
  return Array.isArray(value);
}

/** Returns the description with one value of one part changed. */
export function withPartValue(description: Description, part: PartName, name: string, value: Value): Description {
  return { ...description, [part]: { ...description[part], [name]: value } };
}

/** Returns a copy without `name`. */
export function without(part: Part, ...names: readonly string[]): Part {
  return Object.fromEntries(Object.entries(part).filter(([name]) => !names.includes(name)));
}

/** Two values that are written alike are alike, whatever the order in which their names were given. */
export function written(value: Value): string {
  if (isVector(value)) return `[${value.map(written).join()}]`;
  if (!isPart(value)) return JSON.stringify(value);
  const names = Object.keys(value).sort();
  return `{${names.map((name) => `${name}:${written(value[name] ?? null)}`).join()}}`;
}

/** Returns the case in one line: kinds with their numbers. */
export function caseInWords(description: Description): string {
  const written = ([name, value]: [string, Value]): string => `${name.replaceAll("_", " ")} ${String(value)}`;
  const parts = PARTS.map((part) => {
    const tag = tagOf(part);
    const numbers = Object.entries(description[part]).filter(([name, value]) => name !== tag && isSimple(value));
    return [kindOf(description, part).replaceAll("_", " "), ...numbers.map(written)].join(", ");
  });
  const start = START.flatMap((name) => {
    const value = description[name];
    return value === undefined || value === null ? [] : [written([name, value])];
  });
  return `${[...parts, ...start].join("; ")}. SI units.`;
}

function isSimple(value: Value): boolean {
  return typeof value === "number" || typeof value === "string" || isVector(value);
}
