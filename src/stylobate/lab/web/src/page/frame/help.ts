/** What is seen on the page, and what its words and letters mean. */

import { button, element } from "./dom";

type Entry = readonly [mark: string, text: string];

const SEEN: readonly Entry[] = [
  ["blue", "path of the contact point of the rim on the base; the dark dot is the present contact point"],
  ["green", "path of the top end of the axis"],
  ["muted", "ring: the circle of the rim, about the centre of the footprint"],
  ["vermilion", "marked flute and radius of the top face: they show the rotation about the axis"],
];

const TICKS: readonly Entry[] = [
  ["blue", "uplift: the column tips onto its rim"],
  ["green", "the column comes to rest"],
  ["purple", "the column leaves the base, or lands"],
  ["vermilion", "overturning is certain"],
  ["muted", "any other event: an impact, the beginning or end of slip"],
];

const WORDS: readonly Entry[] = [
  [
    "c",
    "slenderness r/h, the tangent of the tipping angle: radius of the base over the height of the centre of mass. Tilts are shown as θ/c.",
  ],
  [
    "c g",
    "the horizontal acceleration at which a standing column tips onto its rim (uplift). Under weaker shaking it stays at rest.",
  ],
  ["η", "damping of the tilt; ζ: damping of the spin. Both are dimensionless."],
  ["Ω", "angular frequency of the base motion."],
  ["ω₀", "√(m g h/J₀), the frequency scale of the column, with J₀ about a diameter of the base."],
  ["θ, β", "tilt angle from the vertical, and the azimuth of the lean. The tilt vector is θ (cos β, sin β)."],
  ["rolling", "the tilted column rolls round its rim, once per period of the base."],
  [
    "modulated",
    "rolling at the mean rate of the base, while the tilt swings with a period of its own; it neither grows nor decays.",
  ],
  ["periodic", "the motion repeats after one to eight periods of the base, and is neither rolling nor rocking."],
  [
    "aperiodic",
    "a lasting motion that does not repeat within eight periods of the base: chaotic, or of two periods at once.",
  ],
  ["at rest", "the column stands on its base, and the rest of the base motion cannot lift it."],
  ["survived", "it still rocks or rolls after the base motion, with too little energy to overturn."],
  ["still moving", "undecided: the motion still changes at the end of the run."],
  ["failed", "the run could not be computed to its end; the reason says why."],
  [
    "numerically uncertain",
    "repeated with other tolerances, the run ends differently: rounding decides, so ask for a probability.",
  ],
  [
    "critical frequency",
    "below it, steady rolling is unstable: a small disturbance grows. The dotted line in the response, with its value.",
  ],
  [
    "branch",
    "one family of steady rolling over the frequency: the upper with the larger tilt, the lower with the smaller. Drag the marker along it.",
  ],
  ["stable, unstable", "after a small disturbance the motion returns (bold line) or leaves (thin, dashed line)."],
  [
    "0.1 % off",
    "a run that starts on a branch begins with a tilt that is a thousandth larger, so that an unstable motion is left.",
  ],
  ["backbone", "steady rolling of the free column without damping: about it the response bends."],
  ["ψ", "phase: by how much the lean of the column is ahead of the base acceleration."],
  [
    "averaged",
    "straight or elliptic shaking is two circles, one with the rolling and one against it. Averaging keeps the first.",
  ],
  [
    "exact orbit",
    "a motion that repeats after each period, found by computation without averaging; dots, rings where unstable.",
  ],
  [
    "bifurcation",
    "a frequency at which the number or the stability of motions changes. Pitchfork: two motions without the symmetry of the first. Period doubling: it repeats after two periods only. Neimark-Sacker: a swing with another period begins.",
  ],
  ["friction demand", "friction force over normal force. Above the friction coefficient a real contact would slip."],
  ["pivoting demand", "moment about the vertical that the contact has to bear, over normal force and radius."],
  ["restitution e", "the part of the angular velocity that is left after an impact on the base face."],
  ["κ, i_a", "inertia ratio m h²/J₀ and axial ratio I_a/(m r²): how mass is spread along and about the axis."],
  ["basin", "basin of attraction: the set of initial conditions that lead to the same long-term motion."],
  [
    "overturned",
    "the tilt is beyond the point of no return. The fall that follows is drawn pale; it was not computed.",
  ],
];

const PULL =
  "Drag the column to pull it, by mouse, or by a finger sideways. When you let go, the run starts from rest at that tilt. " +
  "The tilt fields under “Initial condition” do the same. Drag beside the column to turn the view.";

export class Help {
  readonly root: HTMLElement;
  readonly #dialog = element("dialog", { class: "text-dialog help" });

  constructor() {
    const close = button("Close", { class: "primary" }, () => this.#dialog.close());
    const title = element("h2", { tabindex: -1, autofocus: true }, "Legend and glossary"); // it opens at its top
    this.#dialog.append(
      title,
      element(
        "p",
        {},
        "A free-standing round column on a shaking base: does it stay, rock, roll or overturn? " +
          "Follow the lessons, or set a case of your own, watch the motion, and read which curves and maps explain it. " +
          "Everything is drawn to scale, without exaggeration.",
      ),
      element("h3", {}, "In the picture"),
      list(SEEN, true),
      element("p", {}, PULL),
      element("h3", {}, "Ticks above the time"),
      list(TICKS, true),
      element("h3", {}, "Symbols and terms"),
      list(WORDS, false),
      element("h3", {}, "Keys"),
      element(
        "p",
        {},
        "Space: play and pause. Arrow keys: step. N: next event. F: the scene alone. In a number field, up and down change the number.",
      ),
      element("div", { class: "dialog-bar" }, close),
    );
    this.#dialog.addEventListener("click", (event) => {
      if (event.target === this.#dialog) this.#dialog.close(); // beside the box
    });
    const open = button("?", { class: "icon", "aria-label": "Help", title: "Legend and glossary" }, () =>
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
