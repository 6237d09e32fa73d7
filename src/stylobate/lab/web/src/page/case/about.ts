/** What the server offers: the kinds of columns, models and motions, with the ranges of their numbers. */

import type * as schema from "../server/schema";
import type { Description, Part, PartName, Value } from "./description";
import { isVector } from "./description";

/** Numbers and words of which a control can do without. */
export type Parameter = Partial<Omit<schema.Parameter, "name" | "default">> & {
  readonly name: string;
  readonly default: Value;
};

export type Kind = Omit<schema.Kind, "about" | "parameters"> & {
  readonly about?: string;
  readonly parameters: readonly Parameter[];
  /** Under which heading it is listed. */
  readonly group?: string;
};

export type Preset = Omit<schema.Preset, "description" | "view"> & {
  readonly description: Description;
  readonly view: Readonly<Record<string, Value>>;
};

export type Lesson = Omit<schema.Lesson, "description" | "view" | "control"> & {
  readonly description: Description;
  readonly view: Readonly<Record<string, Value>>;
  readonly control: Omit<schema.LessonControl, "options"> & {
    readonly options?: readonly { readonly text: string; readonly change: Part }[];
  };
};

export type About = Omit<schema.About, "limits" | "shapes" | "models" | "motions" | "presets" | "lessons"> & {
  readonly limits: Partial<schema.About["limits"]>;
  readonly shapes: readonly Kind[];
  readonly models: readonly Kind[];
  readonly motions: readonly Kind[];
  readonly presets: readonly Preset[];
  readonly lessons: readonly Lesson[];
};

const LISTS = { column: "shapes", model: "models", motion: "motions" } as const;

export function kindsOf(about: About, part: PartName): readonly Kind[] {
  return about[LISTS[part]];
}

export function kindNamed(about: About, part: PartName, kind: string): Kind | undefined {
  return kindsOf(about, part).find((one) => one.kind === kind);
}

/** Returns a part of this kind: what it has in common with the part before is kept, the rest is as usual. */
export function partOfKind(kind: Kind, tag: "kind" | "shape", before: Part): Part {
  const numbers = kind.parameters.map(({ name, default: usual }): [string, Value] => {
    const kept = before[name];
    const alike = kept !== undefined && typeof kept === typeof usual && isVector(kept) === isVector(usual);
    const sameLength = !isVector(kept) || (isVector(usual) && kept.length === usual.length);
    return [name, alike && sameLength ? kept : usual];
  });
  return { [tag]: kind.kind, ...Object.fromEntries(numbers.filter(([, value]) => value !== null)) };
}
