/** Paths drawn up to now: what is recent stands out, what is old pales. */

import { BufferAttribute, BufferGeometry, Color, DoubleSide, LineSegments, Mesh, ShaderMaterial } from "three";
import type { Pair, Triple } from "./drawn-motion";

const VERTEX = /* glsl */ `
  attribute float instant;
  varying float when;
  void main() {
    when = instant;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;

// The future is not drawn: the path ends where the column is now, also between samples.
const FRAGMENT = /* glsl */ `
  uniform float now;
  uniform float memory;
  uniform vec3 recent;
  uniform vec3 past;
  varying float when;
  void main() {
    if (when > now) discard;
    gl_FragColor = vec4(mix(past, recent, exp((when - now) / memory)), 1.0);
    #include <colorspace_fragment>
  }
`;

function pathMaterial(recent: string, past: string, memory: number): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: {
      now: { value: 0 },
      memory: { value: memory },
      recent: { value: new Color(recent) },
      past: { value: new Color(past) },
    },
    side: DoubleSide,
    transparent: true, // drawn after what it lies on
    depthWrite: false,
  });
}

/** A path on the floor, broken where nothing touches. */
export function floorPath(
  time: readonly number[],
  points: readonly Pair[],
  joined: (i: number) => boolean,
  look: { width: number; recent: string; past: string; memory: number },
): Mesh<BufferGeometry, ShaderMaterial> {
  const positions: number[] = [];
  const instants: number[] = [];
  const indices: number[] = [];
  for (let i = 0; i + 1 < points.length; i += 1) {
    if (!joined(i)) continue;
    const first = positions.length / 3;
    for (const k of [i, i + 1]) {
      const [nx, ny] = normalAt(points, k);
      for (const side of [-0.5, 0.5]) {
        positions.push(points[k]![0] + side * look.width * nx, points[k]![1] + side * look.width * ny, 0);
        instants.push(time[k]!);
      }
    }
    indices.push(first, first + 2, first + 1, first + 1, first + 2, first + 3);
  }
  const geometry = pathGeometry(positions, instants);
  geometry.setIndex(indices);
  return new Mesh(geometry, pathMaterial(look.recent, look.past, look.memory));
}

/** A thin path in space. */
export function spacePath(
  time: readonly number[],
  points: readonly Triple[],
  look: { recent: string; past: string; memory: number },
): LineSegments<BufferGeometry, ShaderMaterial> {
  const positions: number[] = [];
  const instants: number[] = [];
  for (let i = 0; i + 1 < points.length; i += 1) {
    positions.push(...points[i]!, ...points[i + 1]!);
    instants.push(time[i]!, time[i + 1]!);
  }
  return new LineSegments(pathGeometry(positions, instants), pathMaterial(look.recent, look.past, look.memory));
}

function pathGeometry(positions: number[], instants: number[]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("instant", new BufferAttribute(new Float32Array(instants), 1));
  return geometry;
}

/** Return the unit normal of a path at one of its points, from its neighbours. */
function normalAt(points: readonly Pair[], k: number): Pair {
  const before = points[Math.max(0, k - 1)]!;
  const after = points[Math.min(points.length - 1, k + 1)]!;
  const [dx, dy] = [after[0] - before[0], after[1] - before[1]];
  const length = Math.hypot(dx, dy);
  return length === 0 ? [1, 0] : [-dy / length, dx / length];
}
