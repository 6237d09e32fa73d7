/** One axis of a map: which quantity, from where to where. */

import { element, newId } from "../frame/dom";
import { plain, readNumber, unitWritten, words } from "../frame/format";
import { rangeProblem } from "../frame/number-text";
import type { Quantity } from "../case/quantities";
import { written } from "../case/description";
import type { Axis } from "../view/state";

export interface AxisHearing {
  readonly changed: (axis: Axis) => void;
  /** The ends that are written have become a range, or are one no longer. */
  readonly judged: () => void;
}

export class AxisForm {
  readonly root: HTMLElement;
  readonly #select: HTMLSelectElement;
  readonly #from: HTMLInputElement;
  readonly #to: HTMLInputElement;
  readonly #unit = element("span", { class: "unit" });
  readonly #hearing: AxisHearing;
  #axis: Axis | null = null;
  #names = "";
  #problem = "";

  constructor(place: "x" | "y", hearing: AxisHearing) {
    this.#hearing = hearing;
    const id = newId(`axis-${place}`);
    this.#select = element("select", { id });
    this.#select.addEventListener("change", () => this.#choose());
    [this.#from, this.#to] = [this.#end(`${place} from`), this.#end(`${place} to`)];
    const label = element("label", { for: id }, place === "x" ? "across" : "up");
    this.root = element("div", { class: "axis-form" }, label, this.#select, this.#from, "–", this.#to, this.#unit);
  }

  /** Why the ends that are written are no range; "" if they are one. */
  get problem(): string {
    return this.#problem;
  }

  /** Shows an axis; ends that were refused stay until the axis becomes another one. */
  show(axis: Axis, quantities: readonly Quantity[]): void {
    const same = this.#axis !== null && written({ ...this.#axis }) === written({ ...axis });
    this.#axis = axis;
    const names = quantities.map((one) => one.name).join();
    if (names !== this.#names) {
      this.#names = names;
      this.#select.replaceChildren(...quantities.map((one) => element("option", { value: one.name }, words(one.name))));
    }
    this.#select.value = axis.name;
    this.#unit.textContent = unitWritten(quantities.find((one) => one.name === axis.name)?.unit ?? "");
    if (same && this.#problem !== "") return;
    if (!same || document.activeElement !== this.#from) this.#from.value = plain(axis.from);
    if (!same || document.activeElement !== this.#to) this.#to.value = plain(axis.to);
    this.#judge("");
  }

  #choose(): void {
    if (this.#axis !== null) this.#hearing.changed({ ...this.#axis, name: this.#select.value });
  }

  #change(): void {
    if (this.#axis === null) return;
    this.#judge(rangeProblem(words(this.#axis.name), this.#from.value, this.#to.value, this.#axis));
    if (this.#problem !== "") return;
    const [from, to] = [readNumber(this.#from.value), readNumber(this.#to.value)];
    this.#hearing.changed({ ...this.#axis, from, to });
  }

  #judge(problem: string): void {
    for (const field of [this.#from, this.#to]) field.setAttribute("aria-invalid", String(problem !== ""));
    if (problem === this.#problem) return;
    this.#problem = problem;
    this.#hearing.judged();
  }

  #end(label: string): HTMLInputElement {
    const field = element("input", {
      class: "number tiny",
      type: "text",
      inputmode: "decimal",
      "aria-label": label,
      autocomplete: "off",
    });
    field.addEventListener("change", () => this.#change());
    return field;
  }
}
