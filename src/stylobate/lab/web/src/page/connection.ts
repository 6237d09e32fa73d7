/** Whether the server answers; while it does not, it is asked every two seconds. */

import { about } from "./api";
import { element } from "./dom";

const PAUSE = 2000; // ms

export class Connection {
  readonly root = element("div", { class: "banner", role: "alert", hidden: true });
  readonly #back: () => void;
  #lost = false;

  constructor(back: () => void) {
    this.#back = back;
    this.root.append("The server does not answer. Start it again with ", element("code", {}, "stylobate lab"), "; the page goes on by itself.");
  }

  get lost(): boolean {
    return this.#lost;
  }

  /** Says that the server does not answer, and asks until it does. */
  lose(): void {
    if (this.#lost) return;
    this.#lost = true;
    this.root.hidden = false;
    void this.#ask();
  }

  async #ask(): Promise<void> {
    while (this.#lost) {
      await new Promise((resolve) => setTimeout(resolve, PAUSE));
      try {
        await about();
        this.#lost = false;
        this.root.hidden = true;
        this.#back();
      } catch {
        // not yet
      }
    }
  }
}
