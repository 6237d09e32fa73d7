/** A server's word of itself, and a view, for tests. */

import type { About } from "../../src/page/case/about";
import type { View } from "../../src/page/view/state";
import { viewOf } from "../../src/page/view/state";

const number = (name: string, usual: number, from: number | null = null, to: number | null = null, unit = "") => ({
  name,
  unit,
  default: usual,
  from,
  to,
  varies: true,
});

const rate = (name: string, usual: number, unit: string) => number(name, usual, null, null, unit);

export const ABOUT: About = {
  version: "0",
  limits: {},
  shapes: [
    {
      kind: "dimensionless",
      name: "dimensionless",
      parameters: [number("slenderness", 0.1, 0.02, 0.5), number("inertia_ratio", 0.75)],
    },
    { kind: "solid", name: "solid", parameters: [number("radius", 0.5), number("height", 5), number("density", 2700)] },
  ],
  models: [
    { kind: "slender", name: "slender", parameters: [number("damping", 0, 0, 0.5)] },
    {
      kind: "sliding",
      name: "sliding",
      parameters: [number("damping", 0, 0, 0.5), number("friction_coefficient", 0.5, 0.02, 1.2)],
    },
  ],
  motions: [
    {
      kind: "circular",
      name: "circular",
      parameters: [number("acceleration", 1), rate("angular_frequency", 2, "rad/s")],
    },
    {
      kind: "elliptic",
      name: "elliptic",
      parameters: [{ name: "amplitude", default: [1, 0.5] }, rate("angular_frequency", 2, "rad/s")],
    },
    { kind: "orbit", name: "orbit", parameters: [number("diameter", 0.01), rate("rpm", 200, "1/min")] },
    { kind: "record", name: "record", parameters: [number("scale", 1, 0.1, 4)] },
    { kind: "sum", name: "sum", parameters: [] },
    { kind: "rest", name: "rest", parameters: [] },
  ],
  samples: ["el centro 1940"],
  presets: [],
  lessons: [],
};

export const VIEW: View = viewOf({
  column: { shape: "dimensionless", slenderness: 0.1 },
  model: { kind: "slender", damping: 0.1 },
  motion: { kind: "circular", acceleration: 0.065, angular_frequency: 1.8 },
  tilt: [0.0386, -0.004],
  tilt_rate: [-0.0075, 0.0695],
  duration: 60,
});
