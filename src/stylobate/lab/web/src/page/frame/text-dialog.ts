/** A text to copy or to save. */

import { button, download, element } from "./dom";

export class TextDialog {
  readonly root = element("dialog", { class: "text-dialog" });
  readonly #title = element("h2", {});
  readonly #text = element("pre", { tabindex: 0 });
  readonly #copy = button("Copy", { class: "primary" }, () => void this.#copied());
  readonly #save = button("Save", {}, () => download(new Blob([this.#content], { type: "text/plain" }), this.#name));
  #content = "";
  #name = "";

  constructor() {
    const close = button("Close", {}, () => this.root.close());
    const bar = element("div", { class: "dialog-bar" }, this.#copy, this.#save, close);
    this.root.append(this.#title, this.#text, bar);
    this.root.addEventListener("click", (event) => {
      if (event.target === this.root) this.root.close(); // beside the box
    });
  }

  /** Opens with a text; one without a file name is not to be saved. */
  show(title: string, content: string, name: string | null): void {
    this.#title.textContent = title;
    this.#text.textContent = content;
    this.#content = content;
    this.#name = name ?? "";
    this.#save.hidden = name === null;
    this.#copy.textContent = "Copy";
    this.root.showModal();
  }

  async #copied(): Promise<void> {
    try {
      await navigator.clipboard.writeText(this.#content);
      this.#copy.textContent = "Copied";
    } catch {
      // Browsers may refuse; then the text is chosen, and the user's own keys copy it.
      getSelection()?.selectAllChildren(this.#text);
      this.#copy.textContent = "Press Ctrl+C to copy";
    }
  }
}
