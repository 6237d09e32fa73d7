/** A number: its name, a slider for the hand and a field for the exact value. */

import { element, newId } from "../frame/dom";
import { plain, withUnit } from "../frame/format";
import type { Scale } from "../case/ranges";
import { POSITIONS, positionOf, scaleAbout, scaleBetween, valueAt } from "../case/ranges";

export interface NumberLooks {
  readonly name: string;
  readonly label: string;
  readonly symbol: string;
  readonly unit: string;
  /** Ends of the slider; null where they are chosen about the value. */
  readonly range: readonly [number, number] | null;
  /** How far a slider reaches whose value is nought. */
  readonly top?: number;
  /** What stands in the empty field of a number that need not be given. */
  readonly empty?: string;
  readonly hint?: string;
  readonly whole?: boolean;
}

export class NumberField {
  readonly root: HTMLElement;
  readonly name: string;
  readonly #field: HTMLInputElement;
  readonly #slider: HTMLInputElement;
  readonly #changed: (value: number | null) => void;
  readonly #looks: NumberLooks;
  #scale: Scale;
  /** What the number is, whatever is being written. */
  #value: number | null = null;
  /** Whether what is being written is no number. */
  #unread = false;

  constructor(looks: NumberLooks, changed: (value: number | null) => void) {
    this.name = looks.name;
    this.#looks = looks;
    this.#changed = changed;
    this.#scale = looks.range === null ? scaleBetween(0, looks.top ?? 1) : scaleBetween(...looks.range);
    const id = newId(looks.name);
    this.#field = element("input", {
      ...{ id, class: "number", type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false" },
      placeholder: looks.empty,
    });
    this.#slider = element("input", {
      ...{ type: "range", min: 0, max: POSITIONS, step: 1, class: "slider" },
      "aria-label": `${looks.label}, slider`,
    });
    this.root = this.#laidOut(id);
    this.#listen();
  }

  /** Shows a value, unless it is being written. */
  show(value: number | null): void {
    this.#value = value;
    if (document.activeElement !== this.#field) this.#write();
    if (!this.#slider.matches(":active")) {
      this.#reachFor(value);
      this.#slider.value = String(value === null ? 0 : positionOf(value, this.#scale));
    }
    this.#slider.setAttribute(
      "aria-valuetext",
      value === null ? (this.#looks.empty ?? "none") : withUnit(value, this.#looks.unit),
    );
  }

  /** Lets the slider run between other ends. */
  setRange(from: number, to: number): void {
    if (from !== this.#scale.from || to !== this.#scale.to) this.#scale = scaleBetween(from, to);
  }

  /** Marks the field as the one that a problem is about, or clears the mark. */
  setWrong(wrong: boolean): void {
    const marked = wrong || this.#unread; // an answer to the number before says nothing of what is being written
    if (marked) this.#field.setAttribute("aria-invalid", "true");
    else this.#field.removeAttribute("aria-invalid");
  }

  /** Moves the ends of a slider that has none of its own, once its value is near or beyond one. */
  #reachFor(value: number | null): void {
    if (this.#looks.range !== null || value === null) return;
    const position = positionOf(value, this.#scale);
    const inside = position > EDGE && position < POSITIONS - EDGE && this.#scale.logarithmic === value > 0;
    if (!inside) this.#scale = scaleAbout(value, this.#looks.top ?? 1);
  }

  #laidOut(id: string): HTMLElement {
    const { label, symbol, unit, hint } = this.#looks;
    const name = element("label", { for: id, title: hint }, label);
    if (symbol !== "") name.append(" ", symbolOf(symbol));
    const value = element("span", { class: "value" }, this.#field, element("span", { class: "unit" }, unit));
    return element("div", { class: "field" }, name, value, this.#slider);
  }

  #listen(): void {
    this.#slider.addEventListener("input", () => {
      const value = this.#tidy(valueAt(Number(this.#slider.value), this.#scale));
      this.#field.value = plain(value, SHOWN);
      this.#slider.setAttribute("aria-valuetext", withUnit(value, this.#looks.unit));
      this.#changed(value);
    });
    this.#slider.addEventListener("change", () => {
      const value = this.#tidy(valueAt(Number(this.#slider.value), this.#scale));
      this.#reachFor(value);
      this.#slider.value = String(positionOf(value, this.#scale));
    });
    this.#field.addEventListener("input", () => this.#read());
    this.#field.addEventListener("blur", () => this.#restore());
    this.#field.addEventListener("keydown", (event) => {
      if (event.key === "ArrowUp" || event.key === "ArrowDown") this.#step(event);
    });
  }

  #read(): void {
    const text = this.#field.value.trim().replace(",", ".").replace("\u2212", "-");
    const value = Number(text);
    const empty = text === "";
    const wrong = empty ? this.#looks.empty === undefined : !Number.isFinite(value);
    this.#unread = wrong;
    this.setWrong(wrong);
    if (wrong) return;
    this.#slider.value = String(empty ? 0 : positionOf(value, this.#scale));
    this.#changed(empty ? null : value);
  }

  /** What is no number is not kept: the field tells what is shown. */
  #restore(): void {
    if (!this.#unread) return;
    this.#unread = false;
    this.setWrong(false);
    this.#write();
  }

  #write(): void {
    this.#field.value = this.#value === null ? "" : plain(this.#value, SHOWN);
  }

  #step(event: KeyboardEvent): void {
    event.preventDefault();
    const wide = event.shiftKey ? 10 : 1;
    const direction = event.key === "ArrowUp" ? wide : -wide;
    const value = this.#tidy(valueAt(Number(this.#slider.value) + direction, this.#scale));
    this.#field.value = plain(value, SHOWN);
    this.#slider.value = String(positionOf(value, this.#scale));
    this.#changed(value);
  }

  #tidy(value: number): number {
    return this.#looks.whole === true ? Math.round(value) : value;
  }
}

/** Significant digits in the field; the value itself has all that it was given. */
const SHOWN = 6;

/** How near an end counts as at it, in positions of the slider. */
const EDGE = 8;

/** Returns a symbol with its index lowered: "I_t". */
function symbolOf(symbol: string): HTMLElement {
  const [letter = "", index] = symbol.split("_");
  return element("i", { class: "symbol" }, letter, ...(index === undefined ? [] : [element("sub", {}, index)]));
}
