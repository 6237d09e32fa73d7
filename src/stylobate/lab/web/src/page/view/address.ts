/** The address bar follows the view: at every change, and with an entry in the history at every jump. */

import { linkOf } from "./link";
import type { View } from "./state";

/** Browsers refuse more than some hundred changes in half a minute: while a slider is dragged, a few a second do. */
const PAUSE = 250; // ms

export class Address {
  #due: ReturnType<typeof setTimeout> | null = null;
  #view: View | null = null;

  /** Writes the view into the address, soon. */
  replace(view: View): void {
    this.#view = view;
    this.#due ??= setTimeout(() => this.flush(), PAUSE);
  }

  /** Writes the view into the address, as a new entry of the history. */
  push(view: View): void {
    this.flush();
    history.pushState(null, "", `#${linkOf(view)}`);
  }

  /** Writes at once what is due. */
  flush(): void {
    if (this.#due !== null) clearTimeout(this.#due);
    this.#due = null;
    if (this.#view !== null) history.replaceState(null, "", `#${linkOf(this.#view)}`);
    this.#view = null;
  }
}
