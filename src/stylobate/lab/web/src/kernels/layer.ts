/** The answers that the page computes itself, as one of its sources. */

import type { Part } from "../page/case/description";
import type { Described, Start } from "../page/server/schema";
import { type Layer, NotMine } from "../page/server/source";
import { columnNumbers, simulated } from "./answer";
import { Unknown, caseOf } from "./case";
import type { Kernels } from "./kernels";
import { asPython, asToml } from "./snippets";

/** What is smaller over what is larger, of the circles of a motion that is a circle. */
const NO_CIRCLE = 1e-12;
const AVERAGED = "start: averaged branch, approximate; exact orbits of these numbers are not computed here";
const NONE = "motion has no steady rolling on this branch at this frequency";

export function computing(kernels: Kernels): Layer {
  return {
    simulate: (description) => mine(() => simulated(kernels, description)),
    describe: (description) => mine(() => described(kernels, description)),
    steadyStart: (body) => mine(() => steadyStart(kernels, body)),
  };
}

/** Asks, and leaves to the next source what no program knows. */
async function mine<Answer>(ask: () => Promise<Answer>): Promise<Answer> {
  try {
    return await ask();
  } catch (error) {
    if (error instanceof Unknown) throw new NotMine(error.message);
    throw error;
  }
}

async function described(kernels: Kernels, description: Part): Promise<Described> {
  const column = await kernels.made("column", description["column"] as Part, "shape");
  return { toml: asToml(description), python: asPython(description), column: columnNumbers(column) };
}

async function steadyStart(kernels: Kernels, body: Part): Promise<Start> {
  const { branch = "upper", ...given } = body;
  const { column, numbers, program } = await caseOf(kernels, given);
  if (program !== "slender_harmonic" || numbers["amplitude_z"] !== 0)
    throw new Unknown("only slender columns start on a branch here");
  const scale = 1 / (column["frequency_scale"] ?? NaN);
  const [x, y, vx, vy, off] = await kernels.called("slender_start", [
    ...[column["slenderness"], numbers["damping"], column["gravity"], scale, branch === "upper" ? 1 : 0],
    ...["x", "y", "z"].map((axis) => numbers[`amplitude_${axis}`]),
    ...["x", "y", "z"].map((axis) => numbers[`phase_${axis}`]),
    ...[numbers["angular_frequency"], numbers["start_phase"]],
  ]);
  if (!Number.isFinite(x)) throw new Unknown(NONE);
  return {
    tilt: [x ?? NaN, y ?? NaN],
    tilt_rate: [vx ?? NaN, vy ?? NaN],
    spin: 0,
    warnings: (off ?? 0) > NO_CIRCLE ? [AVERAGED] : [],
  };
}
