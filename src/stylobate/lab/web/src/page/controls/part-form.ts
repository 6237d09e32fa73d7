/** The controls of a column, a model or a motion: which kind, and the numbers that this kind has. */

import type { Kind, Parameter } from "../case/about";
import type { Part, Value } from "../case/description";
import { isVector } from "../case/description";
import { choice, element, newId } from "../frame/dom";
import { capital, words } from "../frame/format";
import { LABELS } from "../case/offered";
import { firstTop } from "../case/quantities";
import { niceAbove } from "../case/ranges";
import type { Wrong } from "../frame/problems";
import { NumberField } from "./number-field";

interface Control {
  readonly name: string;
  readonly root: HTMLElement;
  readonly show: (part: Part) => void;
  readonly setWrong: (problem: string | undefined) => void;
}

export interface PartHearing {
  readonly chosen: (kind: Kind) => void;
  readonly changed: (name: string, value: Value) => void;
}

export class PartForm {
  readonly root: HTMLElement;
  readonly #kinds: readonly Kind[];
  readonly #hearing: PartHearing;
  readonly #select: HTMLSelectElement;
  readonly #about = element("p", { class: "hint" });
  readonly #fields = element("div", { class: "fields" });
  #shown: string | null = null;
  #part: Part = {};
  #controls: readonly Control[] = [];

  constructor(label: string, kinds: readonly Kind[], hearing: PartHearing) {
    this.#kinds = kinds;
    this.#hearing = hearing;
    const id = newId("kind");
    const options = kinds.map(({ kind, name, group }) => [kind, capital(name), group] as const);
    this.#select = choice(options, { id }, (value) => {
      const kind = kinds.find((one) => one.kind === value);
      if (kind) hearing.chosen(kind);
    });
    const name = element("label", { for: id, class: "visually-hidden" }, label);
    this.root = element("div", { class: "part" }, name, this.#select, this.#about, this.#fields);
  }

  show(part: Part, kind: string): void {
    this.#part = part;
    if (this.#shown !== kind) this.#rebuild(kind);
    for (const control of this.#controls) control.show(part);
  }

  /** Marks the fields that a problem names. */
  setWrong(wrong: Wrong): void {
    for (const control of this.#controls) control.setWrong(wrong.get(control.name));
  }

  #rebuild(kind: string): void {
    this.#shown = kind;
    this.#select.value = kind;
    const known = this.#kinds.find((one) => one.kind === kind);
    this.#about.textContent = known?.about ?? "";
    this.#about.hidden = this.#about.textContent === "";
    this.#controls = (known?.parameters ?? []).flatMap((parameter) => this.#controlsOf(parameter));
    this.#fields.replaceChildren(...this.#controls.map((control) => control.root));
  }

  #controlsOf(parameter: Parameter): readonly Control[] {
    if (parameter.choices && parameter.choices.length > 0) return [this.#choiceOf(parameter, parameter.choices)];
    if (parameter.name === "sense") return [this.#choiceOf(parameter, [1, -1])];
    if (isVector(parameter.default)) return parameter.default.map((_, index) => this.#numberOf(parameter, index));
    if (typeof parameter.default === "number" || parameter.default === null) return [this.#numberOf(parameter, null)];
    return [];
  }

  #numberOf(parameter: Parameter, index: number | null): Control {
    const { name, symbol, unit, about } = parameter;
    const axis = index === null ? "" : ` ${(name === "frequencies" ? ENDS : AXES)[index] ?? index + 1}`;
    const optional = parameter.default === null;
    const field = new NumberField(
      {
        name,
        label: (LABELS[name] ?? capital(words(name))) + axis,
        symbol: symbol ?? "",
        unit: unit ?? "",
        range: rangeOf(parameter),
        top: firstTop(parameter),
        whole: name === "cycles" && Number.isInteger(parameter.default),
        ...(about ? { hint: about } : {}),
        ...(optional ? { empty: EMPTY[name] ?? "automatic" } : {}),
      },
      (value) => this.#hearing.changed(name, index === null ? value : this.#withComponent(parameter, index, value)),
    );
    return {
      name,
      root: field.root,
      show: (part) => field.show(componentOf(part[name] ?? parameter.default, index)),
      setWrong: (problem) => field.setWrong(problem),
    };
  }

  #withComponent(parameter: Parameter, index: number, value: Value): Value {
    const given = this.#part[parameter.name] ?? parameter.default;
    return isVector(given) ? given.map((one, i) => (i === index ? value : one)) : given;
  }

  #choiceOf(parameter: Parameter, choices: readonly (string | number)[]): Control {
    const { name } = parameter;
    const id = newId(name);
    const options = choices.map(
      (one) => [String(one), name === "sense" ? (SENSES[String(one)] ?? String(one)) : words(String(one))] as const,
    );
    const select = choice(options, { id }, (text) => {
      const value = choices.find((one) => String(one) === text);
      if (value !== undefined) this.#hearing.changed(name, value);
    });
    const label = element("label", { for: id, title: parameter.about ?? undefined }, capital(words(name)));
    return {
      name,
      root: element("div", { class: "field choice" }, label, select),
      show: (part) => (select.value = String(part[name] ?? parameter.default)),
      setWrong: (problem) => select.setAttribute("aria-invalid", String(problem !== undefined)),
    };
  }
}

/** How the components of a number are told apart: those of a vector, and the ends of a sweep. */
const [AXES, ENDS] = [
  ["x", "y", "z"],
  ["at the start", "at the end"],
];

/** What it means to leave a number out. */
const EMPTY: Readonly<Record<string, string>> = {
  ...{ rotation: "none", scale: "1", tail: "20/p", restitution: "Housner’s", static_friction_coefficient: "as μ" },
};

function rangeOf({ from, to, default: usual }: Parameter): readonly [number, number] | null {
  const vector = isVector(usual); // components may be negative
  if (typeof from !== "number" || typeof to !== "number") return vector ? symmetric(usual) : null;
  return [from, to];
}

function symmetric(values: readonly Value[]): readonly [number, number] {
  const largest = Math.max(...values.map((value) => (typeof value === "number" ? Math.abs(value) : 0)));
  const end = largest > 0 ? niceAbove(3 * largest) : 1;
  return [-end, end];
}

const SENSES: Readonly<Record<string, string>> = { "1": "anticlockwise", "-1": "clockwise" };

function componentOf(value: Value, index: number | null): number | null {
  const found = index !== null && isVector(value) ? value[index] : value;
  return typeof found === "number" ? found : null;
}
