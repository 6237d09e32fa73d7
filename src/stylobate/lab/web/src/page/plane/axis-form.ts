/** One axis of a map: which quantity, from where to where. */

import { element, newId } from "../frame/dom";
import { plain, readNumber, unitWritten, words } from "../frame/format";
import type { Quantity } from "../case/quantities";
import type { Axis } from "../view/state";

export class AxisForm {
  readonly root: HTMLElement;
  readonly #select: HTMLSelectElement;
  readonly #from: HTMLInputElement;
  readonly #to: HTMLInputElement;
  readonly #unit = element("span", { class: "unit" });
  readonly #changed: (axis: Axis) => void;
  #axis: Axis | null = null;
  #names = "";

  constructor(place: "x" | "y", changed: (axis: Axis) => void) {
    this.#changed = changed;
    const id = newId(`axis-${place}`);
    this.#select = element("select", { id });
    this.#select.addEventListener("change", () => this.#change());
    [this.#from, this.#to] = [this.#end(`${place} from`), this.#end(`${place} to`)];
    const label = element("label", { for: id }, place === "x" ? "across" : "up");
    this.root = element("div", { class: "axis-form" }, label, this.#select, this.#from, "–", this.#to, this.#unit);
  }

  show(axis: Axis, quantities: readonly Quantity[]): void {
    this.#axis = axis;
    const names = quantities.map((one) => one.name).join();
    if (names !== this.#names) {
      this.#names = names;
      this.#select.replaceChildren(...quantities.map((one) => element("option", { value: one.name }, words(one.name))));
    }
    this.#select.value = axis.name;
    if (document.activeElement !== this.#from) this.#from.value = plain(axis.from);
    if (document.activeElement !== this.#to) this.#to.value = plain(axis.to);
    this.#unit.textContent = unitWritten(quantities.find((one) => one.name === axis.name)?.unit ?? "");
  }

  #change(): void {
    if (this.#axis === null) return;
    const [from, to] = [readNumber(this.#from.value), readNumber(this.#to.value)];
    const right = Number.isFinite(from) && Number.isFinite(to) && from < to;
    for (const field of [this.#from, this.#to]) field.setAttribute("aria-invalid", String(!right));
    if (right) this.#changed({ ...this.#axis, name: this.#select.value, from, to });
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
