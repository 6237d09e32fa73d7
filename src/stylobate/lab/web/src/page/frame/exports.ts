/** The menu of what can be taken along: pictures, the same run as Python or TOML, a link. */

import type { Stage } from "../../viewer/index";
import type { Part } from "../case/description";
import type { Described } from "../server/schema";
import { Job, problemsIn } from "../server/job";
import type { Source } from "../server/source";
import { button, download, element, themeColour } from "./dom";

const LETTERS = 14; // px of a picture 800 px wide
const WIDTH = 800;

/** Returns `picture` as PNG with `lines` below it, broken where they are too long. */
export async function captioned(picture: Blob, lines: readonly string[]): Promise<Blob> {
  const drawn = await createImageBitmap(picture);
  const unit = Math.max(drawn.width / WIDTH, 1);
  const [size, margin] = [LETTERS * unit, 12 * unit];
  const canvas = document.createElement("canvas");
  const pen = canvas.getContext("2d");
  if (pen === null) throw new Error("This browser cannot save the canvas as a picture. Take a screenshot instead");
  const font = `${size}px system-ui, sans-serif`;
  pen.font = font;
  const room = drawn.width - 2 * margin;
  const broken = lines.flatMap((line) => brokenAt(line, (text) => pen.measureText(text).width <= room));
  const height = 1.4 * size;
  canvas.width = drawn.width;
  canvas.height = Math.ceil(drawn.height + 2 * margin + broken.length * height);
  pen.fillStyle = themeColour("panel");
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(drawn, 0, 0);
  pen.font = font; // a canvas that changes its size forgets it
  pen.fillStyle = themeColour("ink");
  pen.textBaseline = "top";
  broken.forEach((line, i) => pen.fillText(line, margin, drawn.height + margin + i * height));
  return new Promise((done, failed) => {
    canvas.toBlob(
      (blob) => (blob === null ? failed(new Error("The browser could not write the picture as PNG")) : done(blob)),
      "image/png",
    );
  });
}

/** Returns `text` in lines of whole words that fit; a word that is too long has a line of its own. */
export function brokenAt(text: string, fits: (line: string) => boolean): readonly string[] {
  const lines: string[] = [];
  let line = "";
  for (const word of text.split(" ")) {
    const longer = line === "" ? word : `${line} ${word}`;
    if (line !== "" && !fits(longer)) {
      lines.push(line);
      line = word;
    } else line = longer;
  }
  return line === "" ? lines : [...lines, line];
}

/** A text to copy or to save. */
class TextDialog {
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

export interface Exported {
  readonly source: Source;
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
    this.#menu.addEventListener("toggle", () => {
      const offered = exported.source.offers("animation", { description: exported.description() });
      this.#gif.hidden = !offered && this.#job === null;
    });
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
    const job = new Job(
      this.#exported.source,
      "animation",
      { description: this.#exported.description() },
      {
        report: ({ done, total }) => {
          if (total > 0) this.#report(`Animation: ${Math.round((100 * done) / total)} %`);
        },
        ended: (last, error) => {
          if (last?.state === "done") void this.#save(job);
          else this.#finished(problemsIn(last, error).join(" "));
        },
      },
    );
    this.#job = job;
  }

  async #save(job: Job): Promise<void> {
    try {
      download(await job.file(), "stylobate.gif");
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
    this.#dialog.show("A link to this view; it works where this page can be opened", this.#exported.link(), null);
  }
}
