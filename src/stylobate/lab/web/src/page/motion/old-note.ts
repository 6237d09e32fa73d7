/** The line under the stage that says why the case that was asked for is not shown. */

import { button, element } from "../frame/dom";

export class OldNote {
  readonly root = element("div", { class: "old-note", hidden: true });
  /** Hidden from readers of the screen, who hear the same lines from the controls. */
  readonly #lines = element("div", { "aria-hidden": "true" });
  readonly #again: HTMLButtonElement;

  /** `again` hears that a run that was cancelled is wanted after all. */
  constructor(again: () => void) {
    this.#again = button("Compute again", { class: "small" }, again);
    this.root.append(this.#lines, this.#again);
  }

  /** Shows the lines, whether an earlier case is seen meanwhile, and whether the case can be computed again. */
  show(lines: readonly string[], { earlier, again = false }: { earlier: boolean; again?: boolean }): void {
    const all = earlier ? [...lines, "Shown: the last case that could be computed."] : lines;
    this.#lines.replaceChildren(...all.map((line) => element("p", {}, line)));
    this.#again.hidden = !again;
    this.root.hidden = !earlier && !again;
  }

  hide(): void {
    this.root.hidden = true;
  }
}
