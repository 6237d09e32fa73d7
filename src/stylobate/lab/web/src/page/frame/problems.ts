/** What is wrong with the case: above the controls, and beside the fields it is about. */

import { element } from "./dom";

const UNREAD = "stylobate-unread";

/** Returns the event by which a field reports a text that is no number; an empty line: it is one again. */
export function unreadEvent(line: string): Event {
  return new CustomEvent<string>(UNREAD, { detail: line, bubbles: true });
}

export class Problems {
  readonly root = element("div", { class: "problems", role: "alert", hidden: true });
  #lines: readonly string[] = [];
  #unread: { readonly line: string; readonly field: Node } | null = null;
  #shown = "";

  /** Shows what the server refused. */
  show(lines: readonly string[]): void {
    this.#lines = lines;
    this.#write();
  }

  /** Shows the line of a field of `host` whose text is no number in place of what the server refused before. */
  listen(host: HTMLElement): void {
    host.addEventListener(UNREAD, (event) => {
      const line = (event as CustomEvent<string>).detail;
      this.#unread = line === "" ? null : { line, field: event.target as Node };
      this.#write();
    });
  }

  #write(): void {
    // A field that another kind of part has replaced says nothing any more.
    const lines = this.#unread?.field.isConnected === true ? [this.#unread.line] : this.#lines;
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
