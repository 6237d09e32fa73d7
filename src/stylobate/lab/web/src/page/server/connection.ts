/** Whether the server answers: asked now and then, and every two seconds while it does not. */

import { button, element } from "../frame/dom";
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
    setInterval(() => void this.#watch(), WATCH);
  }

  /** Says that the server does not answer, or not without its token, and asks until it does. */
  lose(error: Unreachable): void {
    this.#say(error.locked);
    if (this.#lost) return;
    this.#lost = true;
    this.root.hidden = false;
    void this.#ask();
  }

  #say(locked: boolean): void {
    const said = locked ? "locked" : "gone";
    if (this.root.dataset["said"] === said) return; // what has been read out once is not read out again
    this.root.dataset["said"] = said;
    const command = element("code", {}, "stylobate lab");
    if (locked) {
      // The server answers a page that is loaded again with a form, and the address keeps the case.
      const enter = button("Enter the token", { class: "small" }, () => location.reload());
      this.root.replaceChildren("The laboratory was started again and has a new token. ", enter);
      this.root.append(" or open the address that ", command, " printed; this page then continues by itself.");
    } else {
      this.root.replaceChildren("The server does not answer. Start it again with ", command);
      this.root.append("; the page then continues by itself.");
    }
  }

  /** A page at which nobody pulls asks nothing else, and should be notified all the same. */
  async #watch(): Promise<void> {
    if (this.#lost || document.hidden) return;
    try {
      await this.#source.alive();
    } catch (error) {
      if (error instanceof Unreachable) this.lose(error);
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
      } catch (error) {
        if (error instanceof Unreachable) this.#say(error.locked); // else not yet
      }
    }
  }
}
