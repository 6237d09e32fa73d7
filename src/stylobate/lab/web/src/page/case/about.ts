/** What the server offers: the kinds of columns, models and motions, with the ranges of their numbers. */

import type { Description, PartName, Value } from "./description";

export interface Parameter {
  readonly name: string;
  readonly symbol?: string | null;
  readonly unit?: string | null;
  readonly default: Value;
  readonly needed?: boolean;
  /** Whether maps can vary it. */
  readonly varies?: boolean;
  readonly from?: number | null;
  readonly to?: number | null;
  readonly about?: string | null;
  readonly choices?: readonly (string | number)[] | null;
}

export interface Kind {
  readonly kind: string;
  readonly name: string;
  readonly about?: string | null;
  readonly parameters: readonly Parameter[];
  /** Under which heading it is listed. */
  readonly group?: string;
  /** Of motions: whether it comes to an end, so that a run needs no duration. */
  readonly ends?: boolean;
}

export interface Preset {
  readonly id: string;
  readonly title: string;
  readonly about?: string | null;
  readonly description: Description;
  readonly view?: Readonly<Record<string, Value>> | null;
}

export interface About {
  readonly version: string;
  readonly limits: Readonly<Record<string, Value>>;
  readonly shapes: readonly Kind[];
  readonly models: readonly Kind[];
  readonly motions: readonly Kind[];
  readonly samples: readonly { readonly name: string; readonly about?: string | null }[];
  readonly presets: readonly Preset[];
  readonly outcomes: readonly { readonly name: string; readonly value: string; readonly code: number }[];
}

const LISTS = { column: "shapes", model: "models", motion: "motions" } as const;

export function kindsOf(about: About, part: PartName): readonly Kind[] {
  return about[LISTS[part]];
}

export function kindNamed(about: About, part: PartName, kind: string): Kind | undefined {
  return kindsOf(about, part).find((one) => one.kind === kind);
}
