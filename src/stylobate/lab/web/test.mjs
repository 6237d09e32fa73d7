// Bundles every test and gives them to the test runner of node.

import { spawnSync } from "node:child_process";
import { readdir, rm } from "node:fs/promises";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const made = join(here, ".tests");

const only = process.argv[2] ?? ""; // part of a path: the tests to run
const files = (await readdir(join(here, "test"), { recursive: true }))
  .filter((name) => name.endsWith(".test.ts") && name.includes(only))
  .map((name) => join(here, "test", name));
if (files.length === 0) {
  console.error(`no test has ${only} in its path`);
  process.exit(2);
}

await rm(made, { recursive: true, force: true });
await build({
  entryPoints: files,
  outdir: made,
  outbase: join(here, "test"),
  outExtension: { ".js": ".mjs" },
  bundle: true,
  packages: "external",
  platform: "node",
  format: "esm",
  sourcemap: "inline",
  logLevel: "warning",
});
const tests = files.map((file) => join(made, relative(join(here, "test"), file).replace(/\.ts$/, ".mjs")));
process.exit(
  spawnSync(process.execPath, ["--enable-source-maps", "--test", ...tests], { stdio: "inherit" }).status ?? 1,
);
