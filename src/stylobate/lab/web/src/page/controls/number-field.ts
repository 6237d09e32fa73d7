/** A number: its name, a slider for the hand and a field for the exact value. */

import { element, newId } from "../frame/dom";
import { plain, readNumber, unitWritten, withUnit } from "../frame/format";
import { lineStart, numberProblem } from "../frame/number-text";
import { unreadEvent } from "../frame/problems";
import type { Scale } from "../case/ranges";
import { POSITIONS, positionOf, scaleAbout, scaleBetween, valueAt } from "../case/ranges";

export interface NumberLooks {
  readonly name: string;
  readonly label: string;
  readonly symbol: string;
  readonly unit: string;
  /** Ends of the slider; null where they are chosen about the value. */
  readonly range: readonly [number, number] | null;
  /** How far a slider reaches whose value is zero. */
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
  readonly #problem = element("p", { id: newId("problem"), class: "field-problem", hidden: true });
  readonly #unit = element("span", { class: "unit" });
  readonly #changed: (value: number | null) => void;
  readonly #looks: NumberLooks;
  #scale: Scale;
  /** What the number is, whatever is being written. */
  #value: number | null = null;
  /** The last value that the server did not refuse: an example of what can be written. */
  #right: number | null = null;
  /** Why what is being written is no number; "" if it is one. */
  #unread = "";
  /** What the server refused of the number. */
  #refused = "";

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
      tabindex: -1, // the arrows do the same in the field beside it
    });
    this.root = this.#laidOut(id);
    this.#listen();
  }

  /** Shows a value, unless it is being written. */
  show(value: number | null): void {
    const moved = value !== this.#value;
    this.#value = value;
    this.#unit.textContent = unitWritten(this.#looks.unit);
    // What is being written stays, unless the number becomes another one than is written, as after a step back.
    const written = readNumber(this.#field.value);
    const other =
      moved && this.#unread === "" && !(Number(plain(value ?? NaN, SHOWN)) === Number(plain(written, SHOWN)));
    if (document.activeElement !== this.#field || other) this.#write();
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

  /** Marks the field as the one that a problem is about and shows the problem's line, or clears both. */
  setWrong(problem: string | undefined): void {
    this.#refused = problem ?? "";
    if (problem === undefined) this.#right = this.#value;
    this.#mark();
  }

  #mark(): void {
    // An answer to the number before says nothing of what is being written.
    const line = this.#unread || this.#refused;
    this.#problem.textContent = line;
    this.#problem.hidden = line === "";
    if (line === "") this.#field.removeAttribute("aria-invalid");
    else this.#field.setAttribute("aria-invalid", "true");
  }

  /** Moves the ends of a slider that has none of its own, once its value is near or beyond one. */
  #reachFor(value: number | null): void {
    if (this.#looks.range !== null || value === null) return;
    const position = positionOf(value, this.#scale);
    const inside = position > EDGE && position < POSITIONS - EDGE && this.#scale.logarithmic === value > 0;
    if (!inside) this.#scale = scaleAbout(value, this.#looks.top ?? 1);
  }

  #laidOut(id: string): HTMLElement {
    const { label, symbol, hint } = this.#looks;
    const name = element("label", { for: id, title: hint }, label);
    if (symbol !== "") name.append(" ", symbolOf(symbol));
    const value = element("span", { class: "value" }, this.#field, this.#unit);
    this.#field.setAttribute("aria-describedby", this.#problem.id);
    return element("div", { class: "field" }, name, value, this.#problem, this.#slider);
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
    const value = readNumber(this.#field.value);
    const empty = this.#field.value.trim() === "";
    const missing = empty && this.#looks.empty !== undefined;
    this.#setUnread(missing ? "" : numberProblem(lineStart(this.#looks.label), this.#field.value, this.#right));
    if (this.#unread !== "") return;
    this.#refused = "";
    this.#mark();
    this.#slider.value = String(empty ? 0 : positionOf(value, this.#scale));
    this.#changed(empty ? null : value);
  }

  /** What is no number is not kept: the field shows what counts. */
  #restore(): void {
    if (this.#unread === "") return;
    this.#setUnread("");
    this.#write();
  }

  /** Marks the field, and has the line read out where the problems of the case stand. */
  #setUnread(line: string): void {
    if (line === this.#unread) return;
    this.#unread = line;
    this.#mark();
    this.root.dispatchEvent(unreadEvent(line));
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
