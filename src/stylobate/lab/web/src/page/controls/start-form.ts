/** The start of the motion and its length. */

import type { Description } from "../case/description";
import { kindOf } from "../case/description";
import { element } from "../frame/dom";
import { capital, words } from "../frame/format";
import type { ColumnScales } from "../case/quantities";
import { startQuantities, valueOf, withValue } from "../case/quantities";
import { niceAbove } from "../case/ranges";
import { NumberField } from "./number-field";

/** Models of columns that may turn about their axis. */
const TURNING: readonly string[] = ["slender_rolling", "rolling", "sliding"];

export class StartForm {
  readonly root = element("div", { class: "fields" });
  readonly #changed: (description: Description) => void;
  readonly #fields: readonly NumberField[];
  readonly #spin: NumberField;
  #description: Description | null = null;

  constructor(changed: (description: Description) => void) {
    this.#changed = changed;
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
    this.root.append(...this.#fields.map((one) => one.root), this.#spin.root);
  }

  show(description: Description, scales: ColumnScales): void {
    this.#description = description;
    startQuantities(scales).forEach(({ name, from, to }, i) => {
      this.#fields[i]?.setRange(from, to);
      this.#fields[i]?.show(valueOf(description, name) ?? 0);
    });
    const fastest = niceAbove(5 * scales.frequency_scale);
    this.#spin.setRange(-fastest, fastest);
    this.#spin.show(valueOf(description, "spin") ?? 0);
    this.#spin.root.hidden = !TURNING.includes(kindOf(description, "model"));
  }

  setWrong(names: ReadonlySet<string>): void {
    for (const field of this.#fields)
      field.setWrong(names.has(field.name) || names.has(field.name.replace(/_[xy]$/, "")));
    this.#spin.setWrong(names.has("spin"));
  }

  #set(name: string, value: number): void {
    if (this.#description !== null) this.#changed(withValue(this.#description, name, value));
  }
}
