/** What the server refused, beside the controls, and which fields it is about. */

import { element } from "./dom";

export class Problems {
  readonly root = element("div", { class: "problems", role: "alert", hidden: true });
  #shown = "";

  show(lines: readonly string[]): void {
    const text = lines.join("\n");
    if (text === this.#shown) return; // what has been read out once is not read out again
    this.#shown = text;
    this.root.hidden = lines.length === 0;
    this.root.replaceChildren(...lines.map((line) => element("p", {}, line)));
  }
}

/** Returns the names of quantities in these lines: the words that are written as in a description. */
export function namesIn(lines: readonly string[]): ReadonlySet<string> {
  return new Set(lines.flatMap((line) => line.match(/[a-z]+(?:_[a-z]+)*/g) ?? []));
}
