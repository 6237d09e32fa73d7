/** A description as a file for the command line, and as a Python program. */

import { type Part, type Value, isPart } from "../page/case/description";

/** Returns a description as TOML; keys that are null are left out. */
export function asToml(values: Part): string {
  const given = Object.entries(values).filter(([, value]) => value !== null && value !== undefined);
  const plain = given.filter(([, value]) => !isPart(value)).map(([name, value]) => `${name} = ${inToml(value)}\n`);
  const tables = given.flatMap(([name, value]) => (isPart(value) ? [`[${name}]\n${asToml(value)}`] : []));
  return [plain.join(""), ...tables].filter((text) => text !== "").join("\n");
}

function inToml(value: Value): string {
  if (Array.isArray(value)) return `[${(value as readonly Value[]).map(inToml).join(", ")}]`;
  if (typeof value === "number" && Number.isFinite(value) && !Number.isInteger(value)) return String(value);
  return JSON.stringify(value);
}

/** Returns a Python program that computes and draws the described run. */
export function asPython(values: Part): string {
  return [
    "import tomllib",
    "",
    "import stylobate as sb",
    "",
    `values = tomllib.loads("""\n${asToml(values)}""")`,
    "case = sb.config.SimulationConfig.parse(values).build()",
    "run = sb.simulate(case.model, case.motion, **case.options)",
    'print(run.outcome.name, "-", run.reason)',
    'sb.plot(run).savefig("run.png")',
    "",
  ].join("\n");
}
