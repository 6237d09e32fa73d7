import assert from "node:assert/strict";
import { test } from "node:test";
import { convexHull, outwardNormals } from "../../src/viewer/shadow";

const CORNERS = [
  [0, 0],
  [2, 0],
  [2, 1],
  [0, 1],
] as const;
const INSIDE = [
  [1, 0.5],
  [0.2, 0.9],
  [1, 0],
] as const;
const points = [...CORNERS, ...INSIDE].map(([x, y]) => ({ x, y, height: 0 }));

test("the hull of a rectangle and points in it is its corners, anticlockwise", () => {
  assert.deepEqual(
    convexHull(points).map(({ x, y }) => [x, y]),
    CORNERS.map((corner) => [...corner]),
  );
});

test("normals of a hull have unit length and point away from its middle", () => {
  const hull = convexHull(points);
  outwardNormals(hull).forEach(([nx, ny], i) => {
    assert.ok(Math.abs(Math.hypot(nx, ny) - 1) < 1e-14);
    assert.ok(nx * (hull[i]!.x - 1) + ny * (hull[i]!.y - 0.5) > 0);
  });
});
