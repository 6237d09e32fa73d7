// Bundles the page into ../page and the viewer alone, one script, for pictures that move in a file of their own.
//
//   node build.mjs [viewer] [page] [--watch] [--readable]        without a name: both

import { copyFile, mkdir, readFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build, context } from "esbuild";
import { sourcesDigest } from "./digest.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const page = join(here, "..", "page");
const viewer = join(here, "..", "..", "plots", "animation", "viewer.js");

const words = process.argv.slice(2);
const watch = words.includes("--watch");
const named = words.filter((word) => !word.startsWith("--"));
const unknown = named.filter((word) => word !== "viewer" && word !== "page");
if (unknown.length > 0) {
  console.error(`nothing is called ${unknown.join(", ")}: build viewer, page or both`);
  process.exit(2);
}
const wanted = (name) => named.length === 0 || named.includes(name);

// A bundle that is to be packed states the digest of its sources in its first line.
const stamp = watch || words.includes("--readable") ? "" : `/*! sources ${await sourcesDigest(here)} */\n`;

// What is bundled is passed on: its licences ask to stand in every copy.
async function licences(packages) {
  const texts = await Promise.all(
    packages.map((name) => readFile(join(here, "node_modules", name, "LICENSE"), "utf8")),
  );
  return packages.map((name, i) => `/*! ${name}\n${texts[i].trim().replaceAll("*/", "* /")}\n*/`).join("\n");
}

// The shaders of three for lights, shadows and reflections take a tenth of the page. No material of the viewer has them:
// its own shaders light the scene. They are replaced by empty ones in three's sources, where each is a file.
const UNUSED =
  /[\\/]ShaderChunk[\\/](lights_|shadowmap|transmission|iridescence|clearcoat|bsdfs|cube_uv|envmap|roughness|metalness|bump|displacement|gradient)\w*\.glsl\.js$/;
const unlit = {
  name: "three without lights",
  setup: (run) => {
    const path = join(here, "node_modules", "three", "src", "Three.js");
    run.onResolve({ filter: /^three$/ }, () => ({ path, sideEffects: false }));
    run.onLoad({ filter: UNUSED }, () => ({ contents: 'export default "";' }));
  },
};

const common = {
  absWorkingDir: here,
  bundle: true,
  charset: "utf8",
  target: ["es2022", "chrome110", "firefox115", "safari16.4"],
  minify: !words.includes("--readable"),
  legalComments: "none",
  logLevel: "info",
  plugins: [unlit],
};

async function viewerBundle() {
  return {
    ...common,
    entryPoints: ["src/viewer/standalone.ts"],
    outfile: viewer,
    format: "iife",
    globalName: "stylobateViewer",
    banner: { js: stamp + (await licences(["three"])) },
  };
}

async function pageBundle() {
  return {
    ...common,
    entryPoints: { main: "src/page/main.ts" },
    outdir: page,
    format: "esm",
    sourcemap: words.includes("--readable") && "inline",
    banner: { js: stamp + (await licences(["three", "uplot"])) },
    plugins: [
      ...common.plugins,
      {
        name: "index.html",
        setup: (run) => run.onEnd(() => copyFile(join(here, "index.html"), join(page, "index.html"))),
      },
    ],
  };
}

// What computes maps beside the page: loaded when the first map is computed.
async function workerBundle() {
  return {
    ...common,
    entryPoints: { worker: "src/kernels/worker.ts" },
    outdir: page,
    format: "iife",
    banner: { js: stamp },
  };
}

// What lets the page as static files work without a connection.
async function offlineBundle() {
  return {
    ...common,
    entryPoints: { offline: "src/offline/offline.ts" },
    outdir: page,
    format: "iife",
    banner: { js: stamp },
  };
}

const bundles = [];
if (wanted("viewer")) bundles.push(await viewerBundle());
if (wanted("page")) {
  await mkdir(page, { recursive: true });
  bundles.push(await pageBundle(), await workerBundle(), await offlineBundle());
}
for (const bundle of bundles) {
  if (watch) await (await context(bundle)).watch();
  else await build(bundle).catch(() => process.exit(1)); // what is wrong has been told by then
}
