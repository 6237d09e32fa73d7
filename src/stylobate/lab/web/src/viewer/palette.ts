/** Colours of the stage: Okabe and Ito's palette, as in the figures, on a light or a dark ground. */

export type Theme = "light" | "dark";

const BLUE = "#0072B2";
const VERMILION = "#D55E00";
const GREEN = "#009E73";
const SKY = "#56B4E9";

/** One colour, one meaning: what touches, what turns with the body, where the axis points. */
export interface Palette {
  readonly background: string;
  readonly groundLine: string;
  readonly slab: string;
  readonly slabSide: string;
  readonly slabLine: string;
  readonly footprint: string;
  readonly stone: string;
  readonly rim: string;
  readonly mark: string;
  readonly contact: string;
  /** The point that touches now, before the column and the path. */
  readonly contactPoint: string;
  /** Where it touched long ago. */
  readonly contactOld: string;
  readonly tip: string;
  readonly tipOld: string;
  readonly shadow: string;
  readonly shadowStrength: number;
  /** Text over the picture. */
  readonly ink: string;
  /** Light from the sun, from above and from below. */
  readonly sun: number;
  readonly sky: number;
  readonly earth: number;
}

const LIGHT: Palette = {
  background: "#f5f7fa",
  groundLine: "#c3ccd8",
  slab: "#e3e8ef",
  slabSide: "#aeb8c6",
  slabLine: "#aab6c6",
  footprint: "#5d6b7d",
  stone: "#f1ebde",
  rim: "#c9c1b1",
  mark: VERMILION,
  contact: BLUE,
  contactPoint: "#0b1622",
  contactOld: "#9cc3de",
  tip: GREEN,
  tipOld: "#a9d8c9",
  shadow: "#1d2733",
  shadowStrength: 0.3,
  ink: "#3c4856",
  sun: 0.62,
  sky: 0.5,
  earth: 0.3,
};

const DARK: Palette = {
  background: "#11151b",
  groundLine: "#3a4756",
  slab: "#2a333f",
  slabSide: "#4a586a",
  slabLine: "#5d6e82",
  footprint: "#9aa9bb",
  stone: "#dcd5c6",
  rim: "#8d8778",
  mark: VERMILION,
  contact: SKY,
  contactPoint: "#ffffff",
  contactOld: "#2f5f80",
  tip: "#35c79c",
  tipOld: "#1f5a4b",
  shadow: "#000000",
  shadowStrength: 0.5,
  ink: "#b9c5d3",
  sun: 0.6,
  sky: 0.38,
  earth: 0.2,
};

export function paletteOf(theme: Theme): Palette {
  return theme === "dark" ? DARK : LIGHT;
}

/** What the reader's system asks for. */
export function preferredTheme(): Theme {
  return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}
