/** Light or dark: what the reader's system asks for, until the reader says otherwise. */

import type { Theme } from "../../viewer/index";
import { button } from "./dom";

const KEY = "stylobate-theme";

export class ThemeSwitch {
  readonly root: HTMLButtonElement;
  readonly #changed: (theme: Theme) => void;
  #theme: Theme;

  constructor(changed: (theme: Theme) => void) {
    this.#changed = changed;
    const system = matchMedia("(prefers-color-scheme: dark)");
    this.#theme = kept() ?? (system.matches ? "dark" : "light");
    this.root = button("", { class: "icon" }, () => this.#set(this.#theme === "dark" ? "light" : "dark", true));
    system.addEventListener("change", () => {
      if (kept() === null) this.#set(system.matches ? "dark" : "light", false);
    });
    this.#show();
  }

  get theme(): Theme {
    return this.#theme;
  }

  #set(theme: Theme, keep: boolean): void {
    this.#theme = theme;
    if (keep) remember(theme);
    this.#show();
    this.#changed(theme);
  }

  #show(): void {
    document.documentElement.dataset["theme"] = this.#theme;
    const other = this.#theme === "dark" ? "light" : "dark";
    this.root.textContent = this.#theme === "dark" ? "☀" : "☾";
    this.root.setAttribute("aria-label", `Show in ${other} colours`);
    this.root.title = `Show in ${other} colours`;
  }
}

function kept(): Theme | null {
  try {
    const found = localStorage.getItem(KEY);
    return found === "dark" || found === "light" ? found : null;
  } catch {
    return null; // a browser that keeps nothing
  }
}

function remember(theme: Theme): void {
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // the choice lasts as long as the page
  }
}
