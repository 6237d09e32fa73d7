/** Whether the server answers: asked now and then, and every two seconds while it does not. */

import { element } from "../frame/dom";
import { type Source, Unreachable } from "./source";

/** Between two questions [ms]: while it does not answer, and while all is well. */
const [PAUSE, WATCH] = [2000, 4000];

export class Connection {
  readonly root = element("div", { class: "banner", role: "alert", hidden: true });
  readonly #source: Source;
  readonly #back: () => void;
  #lost = false;

  constructor(source: Source, back: () => void) {
    this.#source = source;
    this.#back = back;
    this.root.append(
      "The server does not answer. Start it again with ",
      element("code", {}, "stylobate lab"),
      "; the page then continues by itself.",
    );
    setInterval(() => void this.#watch(), WATCH);
  }

  /** Says that the server does not answer, and asks until it does. */
  lose(): void {
    if (this.#lost) return;
    this.#lost = true;
    this.root.hidden = false;
    void this.#ask();
  }

  /** A page at which nobody pulls asks nothing else, and should be notified all the same. */
  async #watch(): Promise<void> {
    if (this.#lost || document.hidden) return;
    try {
      await this.#source.alive();
    } catch (error) {
      if (error instanceof Unreachable) this.lose();
    }
  }

  async #ask(): Promise<void> {
    while (this.#lost) {
      await new Promise((resolve) => setTimeout(resolve, PAUSE));
      try {
        await this.#source.alive();
        this.#lost = false;
        this.root.hidden = true;
        this.#back();
      } catch {
        // not yet
      }
    }
  }
}
