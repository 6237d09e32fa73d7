import assert from "node:assert/strict";
import { test } from "node:test";
import { axisOf } from "../../src/viewer/attitude";
import type { Pair, Triple } from "../../src/viewer/drawn-motion";
import { extentOf } from "../../src/viewer/extent";
import { gridLines } from "../../src/viewer/grid";
import { slabOutline } from "../../src/viewer/slab";
import { rolling } from "./made-up";

test("the room holds the middle of the top at every sample, and no more than a column's width beyond", () => {
  const motion = rolling();
  const { room } = extentOf(motion);
  motion.rotation.forEach((rotation, i) => {
    const tip = axisOf(rotation).map((value, k) => motion.centre[i]![k]! + motion.column.height * value);
    for (const k of [0, 1, 2]) assert.ok(tip[k]! >= room.low[k]! && tip[k]! <= room.high[k]!);
  });
  assert.ok(room.high[2] < motion.column.height + 2 * motion.column.radius);
});

test("the slab lies under the whole path, in whole cells of the grid", () => {
  const motion = rolling();
  const { slab, spacing } = extentOf(motion);
  for (const [x, y] of motion.contact_point) assert.ok(x > slab[0] && y > slab[1] && x < slab[2] && y < slab[3]);
  for (const edge of slab) assert.ok(Math.abs(edge / spacing - Math.round(edge / spacing)) < 1e-9);
});

test("a camera goes along with a column or a base that goes far, not with one that shakes in place", () => {
  const motion = rolling();
  const far = motion.time.map((t): Pair => [3 * t, 0]);
  const swept = motion.time.map((t): Triple => [0, 3 * t, 0]);
  assert.deepEqual([extentOf(motion).followsColumn, extentOf(motion).followsBase], [false, false]);
  assert.equal(extentOf({ ...motion, footprint: far, contact_point: far }).followsColumn, true);
  assert.equal(extentOf({ ...motion, base: swept }).followsBase, true);
});

test("a grid has the lines at multiples of its spacing inside, none on the edge", () => {
  const lines = gridLines([-0.4, -0.2, 0.4, 0.2], 0.2);
  const along = lines
    .filter((_, i) => i % 2 === 0)
    .map(([x, y]) => [Number(x.toFixed(9)) + 0, Number(y.toFixed(9)) + 0]);
  assert.deepEqual(along, [
    [-0.2, -0.2],
    [0, -0.2],
    [0.2, -0.2],
    [-0.4, 0],
  ]);
});

test("a slab is convex, anticlockwise and reaches its edges", () => {
  const outline = slabOutline([-1, -2, 3, 4], 0.5);
  const turns = outline.map(([x, y], i) => {
    const [a, b] = [outline[(i + 1) % outline.length]!, outline[(i + 2) % outline.length]!];
    return (a[0] - x) * (b[1] - a[1]) - (a[1] - y) * (b[0] - a[0]);
  });
  assert.ok(Math.min(...turns) > -1e-12);
  assert.deepEqual(
    [Math.min, Math.max].map((end) => end(...outline.map(([x]) => x))),
    [-1, 3],
  );
});
