/** What is seen on the page, and what its words and letters mean. */

import { button, element } from "./dom";

type Entry = readonly [mark: string, text: string];

const SEEN: readonly Entry[] = [
  ["blue", "path of the point of the rim that touches the base; the dark dot is where it touches now"],
  ["green", "path of the tip of the axis"],
  ["muted", "ring: the circle of the rim's contact, about the centre of the footprint"],
  ["vermilion", "marked flute and radius of the top: they show spin about the axis"],
];

const TICKS: readonly Entry[] = [
  ["blue", "uplift: the column leaves its stand"],
  ["green", "it comes to rest"],
  ["purple", "it leaves the base, or lands"],
  ["vermilion", "it is certain that it overturns"],
  ["muted", "any other event: an impact, the beginning or end of a slip"],
];

const WORDS: readonly Entry[] = [
  [
    "c",
    "slenderness r/h = tan α: radius of the base over the height of the centre of mass. Tilts are shown in units of c.",
  ],
  ["c g", "the horizontal acceleration that makes the standing column lift off: weaker shaking leaves it standing."],
  ["η", "damping of the tilt; ζ: damping of the spin about the axis. Both dimensionless."],
  ["Ω", "angular frequency of the base motion."],
  ["ω₀", "√(m g h/J₀), the column’s own frequency scale, with J₀ about the centre of the base."],
  ["θ, β", "tilt from the vertical, and its azimuth. The tilt vector is θ (cos β, sin β)."],
  ["rolling", "the tilted column goes round on its rim, once in each period of the base."],
  ["branch", "one family of steady rolling over the frequency. Drag the marker along the bold, stable one."],
  ["basin", "the set of starts that lead to the same motion in the long run."],
  [
    "overturned",
    "the tilt is beyond the point of no return. The fall that follows is drawn pale and was not computed.",
  ],
];

export class Help {
  readonly root: HTMLElement;
  readonly #dialog = element("dialog", { class: "text-dialog help" });

  constructor() {
    const close = button("Close", { class: "primary" }, () => this.#dialog.close());
    this.#dialog.append(
      element("h2", {}, "What is seen here"),
      element(
        "p",
        {},
        "A round column stands free on a base that shakes: does it stay, rock, roll or overturn? " +
          "Set the case on the left, watch the motion, and see on the right why it goes as it does. " +
          "Everything is drawn to scale; no tilt is exaggerated.",
      ),
      element("h3", {}, "In the picture"),
      list(SEEN, true),
      element("h3", {}, "Ticks above the time"),
      list(TICKS, true),
      element("h3", {}, "Letters and words"),
      list(WORDS, false),
      element("h3", {}, "Keys"),
      element(
        "p",
        {},
        "Space plays and pauses, arrows step, N goes to the next event. In a number field, up and down step.",
      ),
      element("div", { class: "dialog-bar" }, close),
    );
    this.#dialog.addEventListener("click", (event) => {
      if (event.target === this.#dialog) this.#dialog.close(); // beside the box
    });
    const open = button("?", { class: "icon", "aria-label": "Help", title: "What is seen here" }, () =>
      this.#dialog.showModal(),
    );
    this.root = element("div", { class: "help-button" }, open, this.#dialog);
  }
}

function list(entries: readonly Entry[], coloured: boolean): HTMLElement {
  return element(
    "dl",
    { class: "glossary" },
    ...entries.flatMap(([mark, text]) => [
      coloured
        ? element("dt", {}, element("span", { class: `key line ${mark}`, "aria-label": mark, role: "img" }))
        : element("dt", {}, mark),
      element("dd", {}, text),
    ]),
  );
}
