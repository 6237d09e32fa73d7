/** The answers that the page computes itself, as one of its sources. */

import { type Part, isPart, without } from "../page/case/description";
import { isHorizontalHarmonic } from "../page/case/frequency";
import { offBranch } from "../page/case/starting";
import type { Described, ResponseCurves, Start } from "../page/server/schema";
import { type Ask, type Layer, NotMine } from "../page/server/source";
import { columnNumbers, simulated } from "./answer";
import { caseOf, numberOf, refuseOthers } from "./case";
import type { Kernels } from "./kernels";
import { kindOfShaking } from "./shaking";
import { type OnBranch, startMap } from "./plane";
import { asPython, asToml } from "./snippets";
import type { StartWorker } from "./worker-pool";
import { Unknown } from "./refusals";

/** What is smaller over what is larger, of the circles of a motion that is a circle. */
const NO_CIRCLE = 1e-12;
const AVERAGED = "start: averaged branch, approximate; exact orbits of these numbers are not computed here";
const NONE = "motion has no steady rolling on this branch at this frequency";

/** The program of runs that can start on a branch. */
const STARTING = "slender_harmonic";

const SENSES = ["anticlockwise", "clockwise"] as const;
const BRANCHES = ["upper", "lower"] as const;

/** Returns the layer; `startWorker` starts the workers that compute maps. */
export function computing(kernels: Kernels, startWorker: StartWorker): Layer {
  return {
    offers: (ask, question) => isPart(question) && offers(kernels, ask, question),
    simulate: (description) => mine(() => simulated(kernels, description)),
    describe: (description) => mine(() => described(kernels, description)),
    steadyStart: (body) => mine(() => steadyStart(kernels, body)),
    response: (description) => mine(() => response(kernels, description)),
    sendRecord: (upload) => kernels.own.add(upload),
    startJob: (kind, request) =>
      mine(() => {
        if (kind !== "map") throw new Unknown(`${kind} is not computed here`);
        const from: OnBranch = (description, branch) => onBranch(kernels, description, branch);
        return startMap(kernels, request, from, startWorker);
      }),
  };
}

/** Returns whether there are programs for a question. */
function offers(kernels: Kernels, ask: Ask, question: Part): boolean {
  const asked = ask === "map" ? question["description"] : question;
  if (!(ask === "map" || ask === "start") || !isPart(asked)) return false;
  const { model, motion = { kind: "rest" } } = asked;
  if (!isPart(model) || !isPart(motion)) return false;
  const program = `${String(model["kind"] ?? "wobbling")}_${kindOfShaking(kernels, motion)}`;
  const onBranch = ask === "start" || question["start"] !== undefined;
  return onBranch ? program === STARTING && isHorizontalHarmonic(motion) : program in kernels.described.programs;
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
  const shown = kernels.own.shown(description);
  return { toml: asToml(shown), python: asPython(shown), column: columnNumbers(column) };
}

async function steadyStart(kernels: Kernels, body: Part): Promise<Start> {
  const found = await branchOf(kernels, body);
  if (found === null) throw new Unknown(NONE);
  return found;
}

/** Returns the start of steady rolling; null where there is none. */
async function branchOf(kernels: Kernels, body: Part): Promise<Start | null> {
  const { branch = "upper", ...given } = body;
  const { column, numbers, program } = await caseOf(kernels, given);
  if (program !== STARTING || numbers["amplitude_z"] !== 0)
    throw new Unknown("only slender columns start on a branch here");
  const scale = 1 / (column["frequency_scale"] ?? NaN);
  const [x, y, vx, vy, off] = await kernels.called("slender_start", [
    ...[column["slenderness"], numbers["damping"], column["gravity"], scale, branch === "upper" ? 1 : 0],
    ...["x", "y", "z"].map((axis) => numbers[`amplitude_${axis}`]),
    ...["x", "y", "z"].map((axis) => numbers[`phase_${axis}`]),
    ...[numbers["angular_frequency"], numbers["start_phase"]],
  ]);
  if (!Number.isFinite(x)) return null;
  return {
    tilt: [x ?? NaN, y ?? NaN],
    tilt_rate: [vx ?? NaN, vy ?? NaN],
    spin: 0,
    warnings: (off ?? 0) > NO_CIRCLE ? [AVERAGED] : [],
  };
}

/** Returns a description that starts a little off a branch, or null where its motion has none. */
async function onBranch(kernels: Kernels, description: Part, branch: string): Promise<Part | null> {
  const found = await branchOf(kernels, { ...without(description, "tilt", "tilt_rate", "spin", "duration"), branch });
  if (found === null) return null;
  const { warnings, ...start } = found;
  return { ...description, ...offBranch(start) };
}

/** Returns the response of the slender model, which has a closed form. */
async function response(kernels: Kernels, given: Part): Promise<ResponseCurves> {
  const { angular_frequency_range: range, points, ...rest } = given;
  const model = rest["model"] as Part;
  refuseOthers(model, ["kind", "damping"]);
  if (model["kind"] !== "slender") throw new Unknown("only slender columns have curves here");
  const stated = rest["motion"] as Part;
  const ofKind = kernels.described.case.find((one) => one.of === `motion_${String(stated["kind"])}`);
  const free = ofKind?.arguments.some((one) => one.name === "angular_frequency");
  const motion = free ? { ...stated, angular_frequency: 1 } : stated; // the curves have frequencies of their own
  const { column, numbers } = await caseOf(kernels, { ...rest, motion });
  if (numbers["amplitude_z"] !== 0) throw new Unknown("a vertical motion has no curves");
  const [low, high] = range as readonly [number, number];
  const many = numberOf(points, 2, "points");
  const frequency = Array.from({ length: many }, (_, k) => low + (k * (high - low)) / (many - 1));
  const scale = column["frequency_scale"] ?? NaN;
  const { slenderness, gravity } = column;
  const { amplitude_x, amplitude_y, phase_x, phase_y, damping } = numbers;
  const rows: (readonly number[])[] = [];
  for (const one of frequency) {
    const shaken = [amplitude_x, amplitude_y, phase_x, phase_y];
    rows.push(await kernels.called("slender_curves", [slenderness, damping, gravity, one / scale, ...shaken]));
  }
  const { curve } = kernels.described;
  const wide = Object.keys(curve).length;
  const at = (row: readonly number[] | undefined, sense: number, name: string): number =>
    row?.[1 + sense * wide + (curve[name] ?? NaN)] ?? NaN;
  const sizes = SENSES.map((_, sense) => at(rows[0], sense, "size"));
  const present = SENSES.filter((_, sense) => (sizes[sense] ?? 0) > NO_CIRCLE * Math.max(...sizes));
  const columnOf = (sense: (typeof SENSES)[number], name: string): (number | null)[] =>
    rows.map((row) => finite(at(row, SENSES.indexOf(sense), name)));
  return {
    angular_frequency: frequency,
    branches: present.flatMap((sense) =>
      BRANCHES.map((branch) => ({
        ...{ sense, branch },
        amplitude: columnOf(sense, `${branch}_tilt`),
        phase: columnOf(sense, `${branch}_phase`),
        stable: columnOf(sense, `${branch}_stable`).map((value) => value === 1),
      })),
    ),
    backbone: rows.map((row) => row[0] ?? null),
    critical: present.map((sense) => {
      const value = finite(at(rows[0], SENSES.indexOf(sense), "critical"));
      return { sense, angular_frequency: value === null ? null : scale * value };
    }),
    averaged: present.length > 1,
  };
}

function finite(value: number): number | null {
  return Number.isFinite(value) ? value : null;
}
