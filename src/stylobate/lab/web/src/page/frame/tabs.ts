/** Panels of which one is seen, chosen by tabs. */

import { element, newId } from "./dom";
import { enlarging } from "./enlarging";

export interface TabLooks<Name extends string> {
  readonly name: Name;
  readonly title: string;
  readonly panel: HTMLElement;
}

export class Tabs<Name extends string> {
  readonly root: HTMLElement;
  readonly #tabs: readonly { readonly name: Name; readonly tab: HTMLButtonElement; readonly panel: HTMLElement }[];

  constructor(label: string, tabs: readonly TabLooks<Name>[], chosen: (name: Name) => void) {
    this.#tabs = tabs.map(({ name, title, panel }) => {
      const [id, panelId] = [newId("tab"), newId("panel")];
      const tab = element("button", { type: "button", id, role: "tab", "aria-controls": panelId }, title);
      tab.addEventListener("click", () => chosen(name));
      const held = element("div", { id: panelId, role: "tabpanel", "aria-labelledby": id, class: "tab-panel" }, panel);
      return { name, tab, panel: held };
    });
    const list = element(
      "div",
      { role: "tablist", class: "tabs", "aria-label": label },
      ...this.#tabs.map((one) => one.tab),
    );
    list.addEventListener("keydown", (event) => this.#key(event, chosen));
    this.root = element(
      "section",
      { class: "panel chart tabbed", "aria-label": label },
      element(
        "div",
        { class: "tab-bar" },
        list,
        enlarging(() => this.root, "this panel"),
      ),
      ...this.#tabs.map((one) => one.panel),
    );
  }

  /** Shows a tab, or the first where it is not offered. */
  show(name: Name, offered: (name: Name) => boolean): void {
    const shown = offered(name) ? name : this.#tabs[0]?.name;
    for (const one of this.#tabs) {
      const selected = one.name === shown;
      one.tab.hidden = !offered(one.name);
      one.tab.setAttribute("aria-selected", String(selected));
      one.tab.tabIndex = selected ? 0 : -1;
      one.panel.hidden = !selected;
    }
  }

  #key(event: KeyboardEvent, chosen: (name: Name) => void): void {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    const tabs = this.#tabs.filter((one) => !one.tab.hidden);
    const at = tabs.findIndex((one) => one.tab === document.activeElement);
    const next = tabs[(at + step + tabs.length) % tabs.length];
    if (step === 0 || at < 0 || next === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    chosen(next.name);
    next.tab.focus();
  }
}
