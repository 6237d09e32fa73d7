/** The menu of what can be taken along: pictures, the same run as Python or TOML, a link. */

import type { Stage } from "../../viewer/index";
import type { Described } from "../server/answers";
import { jobFile } from "../server/api";
import { captioned } from "./captioned";
import type { Part } from "../case/description";
import { button, download, element } from "./dom";
import { Job, problemsIn } from "../server/job";
import { TextDialog } from "./text-dialog";

export interface Exported {
  /** The stage of which pictures are taken. */
  readonly stage: Stage | null;
  /** What they show, in lines that stand below them. */
  readonly caption: () => readonly string[];
  /** The description as it is sent. */
  readonly description: () => Part;
  /** A link to the view, with the time at which a clock that is stopped stands. */
  readonly link: () => string;
  /** The description in the languages of the package. */
  readonly described: () => Promise<Described>;
}

export class ExportMenu {
  readonly root: HTMLElement;
  readonly #exported: Exported;
  readonly #dialog = new TextDialog();
  readonly #note = element("span", { class: "export-note", "aria-live": "polite" });
  readonly #menu: HTMLDetailsElement;
  readonly #gif: HTMLButtonElement;
  #job: Job | null = null;

  constructor(exported: Exported) {
    this.#exported = exported;
    this.#gif = this.#item("Animation (GIF)", () => this.#animate());
    const items = [
      this.#item("Picture of the motion (PNG)", () => void this.#picture()),
      this.#gif,
      this.#item("Python…", () => void this.#text("python")),
      this.#item("TOML for the command line…", () => void this.#text("toml")),
      this.#item("Link to this view…", () => this.#link()),
    ];
    this.#menu = element(
      "details",
      { class: "menu" },
      element("summary", { class: "button" }, "Export"),
      element("div", { class: "menu-items" }, ...items),
    );
    this.#menu.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.#close();
    });
    document.addEventListener("pointerdown", (event) => {
      if (event.target instanceof Node && !this.#menu.contains(event.target)) this.#menu.open = false;
    });
    this.root = element("div", { class: "export" }, this.#note, this.#menu, this.#dialog.root);
  }

  #item(text: string, pressed: () => void): HTMLButtonElement {
    return button(text, { class: "menu-item" }, () => {
      this.#close();
      pressed();
    });
  }

  #close(): void {
    if (!this.#menu.open) return;
    this.#menu.open = false;
    this.#menu.querySelector("summary")?.focus();
  }

  async #picture(): Promise<void> {
    try {
      const { stage, caption } = this.#exported;
      if (stage !== null) download(await captioned(await stage.png(), caption()), "stylobate.png");
    } catch (error) {
      this.#report(error instanceof Error ? error.message : String(error));
    }
  }

  #animate(): void {
    if (this.#job !== null) {
      this.#job.cancel();
      this.#finished("The animation was cancelled.");
      return;
    }
    this.#gif.textContent = "Cancel the animation";
    this.#report("Rendering the animation…");
    this.#job = new Job("animation", this.#exported.description(), {
      report: ({ done, total }) => {
        if (total > 0) this.#report(`Animation: ${Math.round((100 * done) / total)} %`);
      },
      ended: (last, error) => {
        if (last?.state === "done") void this.#save(last.id);
        else this.#finished(problemsIn(last, error).join(" "));
      },
    });
  }

  async #save(id: string): Promise<void> {
    try {
      download(await jobFile(id), "stylobate.gif");
      this.#finished("");
    } catch (error) {
      this.#finished(error instanceof Error ? error.message : String(error));
    }
  }

  #finished(text: string): void {
    this.#job = null;
    this.#gif.textContent = "Animation (GIF)";
    this.#report(text);
  }

  #report(text: string): void {
    this.#note.textContent = text;
  }

  async #text(language: "python" | "toml"): Promise<void> {
    try {
      const described = await this.#exported.described();
      this.#report("");
      if (language === "python") this.#dialog.show("The same run in Python", described.python, "run.py");
      else
        this.#dialog.show("The same run for the command line: stylobate simulate run.toml", described.toml, "run.toml");
    } catch (error) {
      this.#report(error instanceof Error ? error.message : String(error));
    }
  }

  #link(): void {
    this.#dialog.show("A link to this view; it works while the laboratory runs here", this.#exported.link(), null);
  }
}
