/** What the server refused: above the controls, and beside the fields it is about. */

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

/** The first line about each quantity, by the quantity's name in a description. */
export type Wrong = ReadonlyMap<string, string>;

/** Returns the lines by the names of quantities in them: the words that are written as in a description. */
export function wrongIn(lines: readonly string[]): Wrong {
  const found = lines.flatMap((line) => (line.match(/[a-z]+(?:_[a-z]+)*/g) ?? []).map((name) => [name, line] as const));
  return new Map(found.reverse());
}
