// The digest of the sources of the bundles, by which hatch_build.py refuses bundles that were built from others.

import { createHash } from "node:crypto";
import { readdir, readFile, stat } from "node:fs/promises";
import { basename, join } from "node:path";

const sha256 = (data) => createHash("sha256").update(data).digest("hex");

// Covers the files of the folder and those below src, without hidden ones.
export async function sourcesDigest(folder) {
  const below = (await readdir(join(folder, "src"), { recursive: true })).map((name) => join("src", name));
  const names = [...(await readdir(folder)), ...below].map((name) => name.replaceAll("\\", "/")).sort();
  const lines = [];
  for (const name of names) {
    const path = join(folder, name);
    if (basename(name).startsWith(".") || !(await stat(path)).isFile()) continue;
    lines.push(`${name} ${sha256(await readFile(path))}\n`);
  }
  return sha256(lines.join(""));
}
