/** The axes of a map or a basin and how many cells it has, folded into one line. */

import { choice, element, newId } from "../frame/dom";
import { formatted, words } from "../frame/format";
import { defaultAxis } from "./planes";
import type { Quantity } from "../case/quantities";
import type { Axis, Plane } from "../view/state";
import type { Description } from "../case/description";
import { BRANCHES, type Branch, type HasBranch } from "../case/starting";
import { AxisForm } from "./axis-form";

export interface AxesHearing {
  readonly axes: (plane: Plane) => void;
  /** Why an axis that is written is none, or nothing any more. */
  readonly judged: () => void;
}

export class AxesForm {
  readonly root = element("details", { class: "axes" });
  readonly #hearing: AxesHearing;
  readonly #hasBranch: HasBranch | null;
  readonly #summary = element("summary", {});
  readonly #forms: { readonly x: AxisForm; readonly y: AxisForm };
  readonly #cells: HTMLSelectElement;
  readonly #start: HTMLSelectElement;
  readonly #startForm: HTMLElement;
  #plane: Plane | null = null;
  #description: Description | null = null;
  #quantities: readonly Quantity[] = [];

  /** `hasBranch` is null where the initial conditions vary: then they are not those of a branch. */
  constructor(hasBranch: HasBranch | null, hearing: AxesHearing) {
    this.#hearing = hearing;
    this.#hasBranch = hasBranch;
    const form = (place: "x" | "y"): AxisForm =>
      new AxisForm(place, { changed: (axis) => this.#changeAxis(place, axis), judged: hearing.judged });
    this.#forms = { x: form("x"), y: form("y") };
    const id = newId("cells");
    this.#cells = choice(
      SIZES.map((size) => [String(size), `${size} × ${size}`]),
      { id },
      (value) => this.#changeSize(Number(value)),
    );
    const size = element("div", { class: "axis-form" }, element("label", { for: id }, "cells"), this.#cells);
    const startId = newId("cells-start");
    this.#start = choice(STARTS, { id: startId }, (value) => this.#changeStart(value));
    this.#startForm = element("div", { class: "axis-form" }, element("label", { for: startId }, "start"), this.#start);
    this.root.append(this.#summary, this.#forms.x.root, this.#forms.y.root, size, this.#startForm);
  }

  /** Why an axis that is written is no range, a line for each. */
  get problems(): readonly string[] {
    return [this.#forms.x.problem, this.#forms.y.problem].filter((one) => one !== "");
  }

  show(plane: Plane, quantities: readonly Quantity[], description: Description): void {
    this.#plane = plane;
    this.#description = description;
    this.#quantities = quantities;
    this.#forms.x.show(plane.x, quantities);
    this.#forms.y.show(plane.y, quantities);
    this.#offerSize(plane.x.number);
    this.#start.value = plane.start ?? "";
    this.#startForm.hidden = !BRANCHES.some((branch) => this.#hasBranch?.(description, branch));
    const axis = ({ name, from, to }: Axis): string => `${words(name)} ${formatted(from)}…${formatted(to)}`;
    this.#summary.textContent = `${axis(plane.x)} × ${axis(plane.y)}`;
  }

  fold(): void {
    this.root.open = false;
  }

  #changeAxis(place: "x" | "y", axis: Axis): void {
    if (this.#plane === null || this.#description === null) return;
    const before = this.#plane[place];
    const quantity = this.#quantities.find((one) => one.name === axis.name);
    const renamed = axis.name !== before.name && quantity !== undefined;
    const found = renamed ? defaultAxis(quantity, this.#description, axis.number) : axis;
    const other = place === "x" ? this.#plane.y : this.#plane.x;
    const swapped = other.name === found.name ? before : other; // both axes must differ
    this.#hearing.axes({ ...this.#plane, ...(place === "x" ? { x: found, y: swapped } : { x: swapped, y: found }) });
  }

  /** Shows how many cells there are; a link may ask for another number than those that are offered. */
  #offerSize(number: number): void {
    const text = String(number);
    if (![...this.#cells.options].some((one) => one.value === text))
      this.#cells.append(element("option", { value: text }, `${text} × ${text}`));
    this.#cells.value = text;
  }

  #changeSize(number: number): void {
    if (this.#plane === null) return;
    const { x, y } = this.#plane;
    this.#hearing.axes({ ...this.#plane, x: { ...x, number }, y: { ...y, number } });
  }

  #changeStart(value: string): void {
    if (this.#plane === null) return;
    const [start] = BRANCHES.filter((one) => one === value);
    const { x, y } = this.#plane;
    this.#hearing.axes(start === undefined ? { x, y } : { x, y, start });
  }
}

/** Where the runs start. */
const STARTS: readonly (readonly [Branch | "", string])[] = [
  ["", "all as the case"],
  ["upper", "each on its upper branch"],
  ["lower", "each on its lower branch"],
];

/** Odd: a cell lies in the middle of an axis, at the start of a column that stands. */
const SIZES = [25, 33, 49, 65, 97, 129, 193] as const;
