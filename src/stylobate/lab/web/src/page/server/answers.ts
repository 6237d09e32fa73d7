/** The server's answers by the names that the page uses; their types follow from `stylobate.lab.answers`. */

import type * as schema from "./schema";

export type {
  Attractor,
  ColumnNumbers,
  Described,
  ExactOrbits as ExactResponse,
  Job as JobReport,
  OrbitFamily as ExactFamily,
  PlaneAxis as ComputedAxis,
  PlaneBegun as AxesEvent,
  PlaneCells as CellsEvent,
  Run as Answer,
  Series,
  Start as BranchStart,
  UploadedRecord as Received,
} from "./schema";

export type Numbers = readonly (number | null)[];

/** A branch of a response, or two of opposite senses that look the same. */
export type ResponseBranch = Omit<schema.CurveBranch, "sense" | "branch" | "stable"> & {
  readonly sense: string;
  readonly branch: string;
  readonly stable: readonly (boolean | null)[];
};

export type ResponseCurves = Omit<schema.ResponseCurves, "branches"> & { readonly branches: readonly ResponseBranch[] };

/** The result of a plane of any kind: `codes` and `names` of basins and of contact maps. */
export type PlaneResult = Partial<schema.BasinResult>;
