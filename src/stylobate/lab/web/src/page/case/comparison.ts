/** A second column under the same base motion that differs from the first in one thing. */

import { type About, type Kind, type Parameter, kindNamed, kindsOf, partOfKind } from "./about";
import { type Description, type Part, kindOf, without } from "./description";
import { mayTurn } from "./starting";
import { formatted } from "../frame/format";

/** What may differ, by the name that a link gives it. */
export const DIFFERENCES = ["model", "damping", "size", "slenderness"] as const;
export type Difference = (typeof DIFFERENCES)[number];

/** What differs and what it is of the second column: a kind of model, a number, or a factor of all lengths. */
export type Comparison =
  | { readonly differs: "model"; readonly value: string }
  | { readonly differs: Exclude<Difference, "model">; readonly value: number };

/** Returns what may differ from a column of this case: one with lengths has a size, one without a slenderness. */
export function differencesOf({ column, model }: Description): readonly Difference[] {
  const size = column["shape"] === "dimensionless" ? "slenderness" : "size";
  return typeof model["damping"] === "number" ? ["model", "damping", size] : ["model", size];
}

/** Returns a second column that is worth a look: what differs, differs clearly. */
export function firstComparison(differs: Difference, description: Description, about: About): Comparison {
  const { column, model } = description;
  if (differs === "model") {
    const kinds = otherModels(description, about).map(({ kind }) => kind);
    return { differs, value: [USUAL, ...kinds].find((kind) => kinds.includes(kind)) ?? USUAL };
  }
  if (differs === "size") return { differs, value: 2 };
  if (differs === "slenderness") return { differs, value: twoDigits(1.5 * Number(column["slenderness"] ?? 0.1)) };
  const damping = Number(model["damping"] ?? 0);
  return { differs, value: damping > 0 ? twoDigits(damping / 2) : 0.05 };
}

/** The model that is compared with first: it has a run for every start of any other model. */
const USUAL = "wobbling";

const twoDigits = (value: number): number => Number(value.toPrecision(2));

/** Returns the kinds of models that the case has not. */
export function otherModels(description: Description, about: About): readonly Kind[] {
  return kindsOf(about, "model").filter(({ kind }) => kind !== kindOf(description, "model"));
}

/** Returns why there is no second column of this kind beside that of the case; null: there may be one. */
export function obstacle(description: Description, { differs, value }: Comparison): string | null {
  const bare = description.column["shape"] === "dimensionless";
  if (differs === "model" && value === kindOf(description, "model"))
    return "Both columns have the same model. Choose another model for the second.";
  if (differs === "size" && bare) return "A dimensionless column has no size. Compare with another slenderness.";
  if (differs === "slenderness" && !bare) return "This column has lengths. Compare with another size.";
  return null;
}

/** Returns the case of the second column: the same base motion, and the same start as far as its model has one. */
export function comparedCase(description: Description, comparison: Comparison, about: About): Description {
  const { column, model } = description;
  switch (comparison.differs) {
    case "model":
      return withModel(description, comparison.value, about);
    case "damping":
      return { ...description, model: { ...model, damping: comparison.value } };
    case "slenderness":
      return { ...description, column: { ...column, slenderness: comparison.value } };
    case "size":
      return { ...description, column: resized(column, comparison.value, about) };
  }
}

function withModel(description: Description, kind: string, about: About): Description {
  const found = kindNamed(about, "model", kind);
  const model = found === undefined ? { kind } : partOfKind(found, "kind", description.model);
  const changed = { ...description, model };
  return mayTurn(changed) ? changed : ({ ...without(changed, "spin"), ...parts(changed) } as Description);
}

const parts = ({ column, model, motion }: Description): Part => ({ column, model, motion });

/** Powers of a length by unit: a body of the same material has its mass as the cube of its size. */
const POWERS: Readonly<Record<string, number>> = { m: 1, kg: 3, "kg m²": 5 };

/** Returns the column with all its lengths times a factor, of the same material. */
function resized(column: Part, factor: number, about: About): Part {
  const parameters: readonly Parameter[] = kindNamed(about, "column", String(column["shape"]))?.parameters ?? [];
  const changed = parameters.flatMap(({ name, unit }) => {
    const [value, power] = [column[name], POWERS[unit ?? ""]];
    return typeof value === "number" && power !== undefined ? [[name, value * factor ** power] as const] : [];
  });
  return { ...column, ...Object.fromEntries(changed) };
}

/** Returns what tells the columns apart, in words, for the first and for the second. */
export function labelsOf({ model, column }: Description, comparison: Comparison): readonly [string, string] {
  switch (comparison.differs) {
    case "model":
      return [modelLabel(String(model["kind"])), modelLabel(comparison.value)];
    case "damping":
      return [numberLabel("damping", model["damping"]), numberLabel("damping", comparison.value)];
    case "slenderness":
      return [numberLabel("slenderness", column["slenderness"]), numberLabel("slenderness", comparison.value)];
    case "size":
      return ["as set", `${formatted(comparison.value)} times the size`];
  }
}

const modelLabel = (kind: string): string => `model ${kind.replaceAll("_", " ")}`;
const numberLabel = (name: string, value: unknown): string =>
  `${name} ${typeof value === "number" ? formatted(value, 4) : "not given"}`;

/** Returns a comparison as a link has it: `damping:0.02`. */
export function comparisonWritten({ differs, value }: Comparison): string {
  return `${differs}:${value}`;
}

/** Returns the comparison that is written so; null where it is none. */
export function comparisonRead(text: unknown): Comparison | null {
  if (typeof text !== "string") return null;
  const [name, written = ""] = text.split(":");
  const differs = DIFFERENCES.find((one) => one === name);
  if (differs === undefined) return null;
  if (differs === "model") return /^[a-z_]+$/.test(written) ? { differs, value: written } : null;
  const value = Number(written);
  return written !== "" && Number.isFinite(value) && value >= 0 ? { differs, value } : null;
}
