/** The start of the motion and its length. */

import type { Description } from "../case/description";
import { choice, element, newId } from "../frame/dom";
import { capital, words } from "../frame/format";
import type { ColumnScales } from "../case/quantities";
import { startQuantities, valueOf, withValue } from "../case/quantities";
import type { Branch, StartKind } from "../case/starting";
import { BRANCHES, type HasBranch, mayTurn, standing, startKind } from "../case/starting";
import { niceAbove } from "../case/ranges";
import type { Wrong } from "../frame/problems";
import { NumberField } from "./number-field";

const KINDS: readonly (readonly [StartKind, string])[] = [
  ["upper", "upper branch, 0.1 % off"],
  ["lower", "lower branch, 0.1 % off"],
  ["standing", "standing"],
  ["set", "as set"],
];

export class StartForm {
  readonly root = element("div", { class: "fields" });
  readonly #changed: (description: Description, branch: Branch | null) => void;
  readonly #hasBranch: HasBranch;
  readonly #kind: HTMLSelectElement;
  readonly #fields: readonly NumberField[];
  readonly #spin: NumberField;
  #description: Description | null = null;

  constructor(hasBranch: HasBranch, changed: (description: Description, branch: Branch | null) => void) {
    this.#hasBranch = hasBranch;
    this.#changed = changed;
    const id = newId("start");
    this.#kind = choice(KINDS, { id }, (value) => this.#choose(value as StartKind));
    const any: ColumnScales = { slenderness: 0.1, frequency_scale: 1 };
    this.#fields = startQuantities(any).map(
      (one) =>
        new NumberField({ ...one, range: [one.from, one.to], label: capital(words(one.name)) }, (value) =>
          this.#set(one.name, value ?? 0),
        ),
    );
    this.#spin = new NumberField(
      {
        name: "spin",
        label: "Spin",
        symbol: "w_3",
        unit: "rad/s",
        range: [-5, 5],
        hint: "about the axis of the column",
      },
      (value) => this.#set("spin", value ?? 0),
    );
    const kind = element("div", { class: "field choice" }, element("label", { for: id }, "Start"), this.#kind);
    this.root.append(kind, ...this.#fields.map((one) => one.root), this.#spin.root);
  }

  show(description: Description, scales: ColumnScales, branch: Branch | null): void {
    this.#description = description;
    for (const one of this.#kind.options) {
      const of = BRANCHES.find((name) => name === one.value);
      one.disabled = of !== undefined && !this.#hasBranch(description, of);
    }
    this.#kind.value = startKind(description, branch);
    startQuantities(scales).forEach(({ name, from, to }, i) => {
      this.#fields[i]?.setRange(from, to);
      this.#fields[i]?.show(valueOf(description, name) ?? 0);
    });
    const fastest = niceAbove(5 * scales.frequency_scale);
    this.#spin.setRange(-fastest, fastest);
    this.#spin.show(valueOf(description, "spin") ?? 0);
    this.#spin.root.hidden = !mayTurn(description);
  }

  setWrong(wrong: Wrong): void {
    for (const field of this.#fields)
      field.setWrong(wrong.get(field.name) ?? wrong.get(field.name.replace(/_[xy]$/, "")));
    this.#spin.setWrong(wrong.get("spin"));
  }

  #set(name: string, value: number): void {
    if (this.#description !== null) this.#changed(withValue(this.#description, name, value), null);
  }

  #choose(kind: StartKind): void {
    if (this.#description === null) return;
    const [branch] = BRANCHES.filter((one) => one === kind);
    this.#changed(kind === "standing" ? standing(this.#description) : this.#description, branch ?? null);
  }
}
