/** What is looked at: one immutable value, from which the page and its address follow. */

import type { Description, Value } from "../case/description";
import type { HistoryPair } from "../charts/history-kinds";
import { isHistoryName } from "../charts/history-kinds";
import { isPart, isVector } from "../case/description";
import { type Comparison, comparisonRead } from "../case/comparison";
import type { Branch } from "../case/starting";
import { BRANCHES } from "../case/starting";
import type { GRIDS } from "../server/declared";

/** Values of one quantity, evenly spaced. */
export interface Axis {
  readonly name: string;
  readonly from: number;
  readonly to: number;
  readonly number: number;
}

export interface Plane {
  readonly x: Axis;
  readonly y: Axis;
  /** The branch on which each run starts, that of its own motion; without it all start as the case does. */
  readonly start?: Branch;
}

/** The tabs with a plane of cells: a job of the server each. */
export type PlaneKind = keyof typeof GRIDS;

/** By plane: its tab, its heading, and its hint before anything is computed. */
export const PLANES: Readonly<Record<PlaneKind, readonly [tab: string, heading: string, hint: string]>> = {
  map: ["Overturning map", "Overturning map", "The outcome over two quantities. Compute the map"],
  basin: ["Basin", "Basins of attraction", "The long-term motion for each initial condition. Compute the basins"],
};

export const PLANE_KINDS = Object.keys(PLANES) as readonly PlaneKind[];

/** Returns what is made for each plane. */
export function ofPlanes<Made>(make: (kind: PlaneKind) => Made): Readonly<Record<PlaneKind, Made>> {
  return Object.fromEntries(PLANE_KINDS.map((kind) => [kind, make(kind)])) as Record<PlaneKind, Made>;
}

export type Tab = "orbit" | PlaneKind | "numbers";
export const TABS: readonly Tab[] = ["orbit", ...PLANE_KINDS, "numbers"];

export function isPlaneKind(tab: Tab): tab is PlaneKind {
  return tab in PLANES;
}

/** With the axes of each plane; null: chosen to suit the case. */
export interface View extends Readonly<Record<PlaneKind, Plane | null>> {
  readonly description: Description;
  /** Angular frequencies of the response [rad/s]; null: chosen to suit the column. */
  readonly range: readonly [number, number] | null;
  /** What is drawn over time; null: chosen to suit the run. */
  readonly histories: HistoryPair | null;
  readonly tab: Tab;
  /** Whether the plane of the tab has been asked for: a link to it computes it again. */
  readonly filled: boolean;
  /** The branch of steady rolling on which the run starts, whatever changes; null: the start is as it is set. */
  readonly start: Branch | null;
  /** What differs of a second column beside the first; null: there is none. */
  readonly compared: Comparison | null;
  /** The lesson of the tour that is open; null: none. */
  readonly lesson: string | null;
  /** Whether the scene fills the window. */
  readonly scene: boolean;
  /** Where the clock is stopped at first [s]; null: it runs. */
  readonly time: number | null;
  /** Speed of the clock, seconds of the motion in a second; null: chosen to suit the motion. */
  readonly speed: number | null;
}

/** Where a link stops the clock: nowhere, unless it says so. */
const timeIn = (value: Value | undefined): number | null => (typeof value === "number" && value >= 0 ? value : null);

export const SPEEDS = [0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 20] as const;

/** Returns the view of a case with the looks that are given; others are chosen to suit. */
export function viewOf(description: Description, looks: Readonly<Record<string, Value>> = {}): View {
  const tab = TABS.find((one) => one === looks["tab"]) ?? "orbit";
  const range = looks["range"] ?? looks["angular_frequency_range"];
  const speed = looks["speed"];
  return {
    description,
    range: isRange(range) ? range : null,
    ...ofPlanes((kind) => planeFrom(looks[kind])),
    histories: historiesFrom(looks["histories"]),
    tab,
    filled: looks["filled"] === true,
    start: BRANCHES.find((one) => one === looks["start"]) ?? null,
    compared: comparisonRead(looks["beside"]),
    lesson: typeof looks["lesson"] === "string" ? looks["lesson"] : null,
    scene: isScene(looks),
    time: timeIn(looks["time"]),
    speed: typeof speed === "number" && speed > 0 ? speed : null,
  };
}

export function isScene(looks: Readonly<Record<string, Value>>): boolean {
  return looks["view"] === "scene";
}

export function isRange(value: Value | undefined): value is readonly [number, number] {
  if (!isVector(value) || value.length !== 2) return false;
  const [low, high] = value;
  return typeof low === "number" && typeof high === "number" && 0 < low && low < high;
}

export function historiesFrom(value: Value | undefined): HistoryPair | null {
  if (!isVector(value) || value.length !== 2) return null;
  const [above, below] = value;
  const known = (name: Value | undefined) => (typeof name === "string" && isHistoryName(name) ? name : null);
  const [first, second] = [known(above), known(below)];
  return first !== null && second !== null ? [first, second] : null;
}

export function planeFrom(value: Value | undefined): Plane | null {
  if (!isPart(value)) return null;
  const [x, y] = [axisFrom(value["x"]), axisFrom(value["y"])];
  if (x === null || y === null || x.name === y.name) return null;
  const start = BRANCHES.find((one) => one === value["start"]);
  return start === undefined ? { x, y } : { x, y, start };
}

function axisFrom(value: Value | undefined): Axis | null {
  if (!isPart(value)) return null;
  const { name, from, to, number } = value;
  if (typeof name !== "string" || typeof from !== "number" || typeof to !== "number" || !(from < to)) return null;
  const cells = typeof number === "number" && Number.isInteger(number) && number > 1 ? number : DEFAULT_CELLS;
  return { name, from, to, number: cells };
}

export const DEFAULT_CELLS = 65;

type Listener = (view: View, before: View) => void;

/** Holds the view that is shown, and announces every change. */
export class Store {
  #view: View;
  readonly #listeners: Listener[] = [];

  constructor(view: View) {
    this.#view = view;
  }

  get view(): View {
    return this.#view;
  }

  change(changes: Partial<View>): void {
    const before = this.#view;
    this.#view = { ...before, ...changes };
    for (const listener of this.#listeners) listener(this.#view, before);
  }

  onChange(listener: Listener): void {
    this.#listeners.push(listener);
  }
}
