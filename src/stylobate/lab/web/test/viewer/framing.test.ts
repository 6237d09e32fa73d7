import assert from "node:assert/strict";
import { test } from "node:test";
import { PerspectiveCamera, Vector3 } from "three";
import { frame } from "../../src/viewer/look";

const BOXES = [
  [0.3, 0.3, 10],
  [2, 2, 0.2],
  [0.01, 0.02, 0.02],
] as const;

test("a camera shows every point, fills the picture one way and has the points in the middle", () => {
  for (const [a, b, c] of BOXES) {
    for (const aspect of [0.6, 1.4]) {
      const points = [-1, 1].flatMap((x) =>
        [-1, 1].flatMap((y) => [0, 1].map((z) => new Vector3(a * x, b * y, c * z))),
      );
      const camera = new PerspectiveCamera(28, aspect);
      camera.up.set(0, 0, 1);
      const target = frame(camera, points, new Vector3(0.3, -1, 0.4));
      camera.lookAt(target);
      camera.updateMatrixWorld();
      const seen = points.map((point) => point.clone().project(camera));
      const [x, y] = [seen.map((point) => point.x), seen.map((point) => point.y)];
      const reach = Math.max(...x.map(Math.abs), ...y.map(Math.abs));
      assert.ok(reach > 0.85 && reach < 0.97, `reach ${reach}`);
      assert.ok(Math.abs(Math.max(...y) + Math.min(...y)) < 0.02 && Math.abs(Math.max(...x) + Math.min(...x)) < 0.02);
      assert.ok(seen.every((point) => Math.abs(point.z) < 1));
    }
  }
});
