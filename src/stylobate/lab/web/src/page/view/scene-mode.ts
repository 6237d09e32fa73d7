/** The scene alone in the window: the picture with its lesson, and charts where the reader asks for them. */

import { button, element } from "../frame/dom";

export interface SceneHearing {
  /** The scene is to fill the window, or to stand among the panels again. */
  readonly set: (scene: boolean) => void;
  /** The case is to begin again. */
  readonly reset: () => void;
}

export class SceneMode {
  /** Buttons over the picture. */
  readonly root: HTMLElement;
  readonly #host: HTMLElement;
  readonly #hearing: SceneHearing;
  readonly #fill: HTMLButtonElement;
  readonly #charts: HTMLButtonElement;
  #scene = false;

  /** `host` is the grid of the panels. */
  constructor(host: HTMLElement, hearing: SceneHearing) {
    this.#host = host;
    this.#hearing = hearing;
    this.#fill = button("", {}, () => this.toggle());
    this.#charts = button("Charts", { class: "of-scene", "aria-pressed": "false" }, () => this.#bringCharts());
    const reset = button("Reset", { class: "of-scene", title: "Begin again as at first" }, hearing.reset);
    this.root = element("div", { class: "scene-bar" }, this.#fill, this.#charts, reset);
    document.addEventListener("keydown", (event) => {
      const other = event.defaultPrevented || document.querySelector("dialog[open], .chart.large") !== null;
      if (event.key === "Escape" && this.#scene && !other) hearing.set(false);
    });
    this.show(false);
  }

  toggle(): void {
    this.#hearing.set(!this.#scene);
  }

  show(scene: boolean): void {
    this.#scene = scene;
    this.#host.classList.toggle("scene", scene);
    document.body.classList.toggle("scene-only", scene);
    this.#fill.textContent = scene ? "All panels" : "Scene";
    this.#fill.title = scene ? "All panels (F or Escape)" : "Scene only (F)";
  }

  #bringCharts(): void {
    const charted = this.#host.classList.toggle("charted");
    this.#charts.setAttribute("aria-pressed", String(charted));
  }
}
