/** Where a camera stands so that it shows given points, large and in the middle. */

import { type PerspectiveCamera, Vector3 } from "three";

const MARGIN = 1.08;
const ROUNDS = 4; // of moving to the middle and stepping back

/** Turn `camera` to look along −`direction` at all `points`; return what it looks at. */
export function frame(camera: PerspectiveCamera, points: readonly Vector3[], direction: Vector3): Vector3 {
  const back = direction.clone().normalize();
  const right = new Vector3(0, 0, 1).cross(back).normalize();
  const up = back.clone().cross(right);
  const high = Math.tan((camera.fov * Math.PI) / 360) / MARGIN;
  const wide = high * camera.aspect;

  const target = new Vector3();
  let distance = 0;
  for (let round = 0; round < ROUNDS; round += 1) {
    const seen = points.map((point) => {
      const from = point.clone().sub(target);
      return { x: from.dot(right), y: from.dot(up), z: from.dot(back) };
    });
    distance = Math.max(...seen.map(({ x, y, z }) => z + Math.max(Math.abs(x) / wide, Math.abs(y) / high)));
    const across = seen.map(({ x, z }) => x / (distance - z));
    const along = seen.map(({ y, z }) => y / (distance - z));
    target.addScaledVector(right, 0.5 * distance * (Math.max(...across) + Math.min(...across)));
    target.addScaledVector(up, 0.5 * distance * (Math.max(...along) + Math.min(...along)));
  }
  camera.position.copy(target).addScaledVector(back, distance);
  camera.near = 0.02 * distance;
  camera.far = 20 * distance;
  camera.updateProjectionMatrix();
  return target;
}
