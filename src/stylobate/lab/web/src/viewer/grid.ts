/** Lines at round distances on a plane z = const. */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  LineBasicMaterial,
  LineSegments,
  ShaderMaterial,
  Vector2,
} from "three";

/** Return the ends of the lines at multiples of `spacing` inside a rectangle, its edges left out. */
export function gridLines(
  [fromX, fromY, toX, toY]: readonly [number, number, number, number],
  spacing: number,
): (readonly [number, number])[] {
  const ends: (readonly [number, number])[] = [];
  for (const x of multiples(fromX, toX, spacing)) ends.push([x, fromY], [x, toY]);
  for (const y of multiples(fromY, toY, spacing)) ends.push([fromX, y], [toX, y]);
  return ends;
}

function multiples(from: number, to: number, spacing: number): number[] {
  const close = 1e-6; // of a spacing: an edge of the rectangle
  const first = Math.floor(from / spacing + close) + 1;
  const last = Math.ceil(to / spacing - close) - 1;
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => (first + i) * spacing);
}

export function gridOn(
  edges: readonly [number, number, number, number],
  spacing: number,
  colour: string,
): LineSegments {
  return new LineSegments(
    linesGeometry(gridLines(edges, spacing)),
    new LineBasicMaterial({ color: colour, depthWrite: false }),
  );
}

const VERTEX = /* glsl */ `
  varying vec2 place;
  void main() {
    place = position.xy;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;
const FRAGMENT = /* glsl */ `
  uniform vec3 colour;
  uniform vec2 middle;
  uniform float reach;
  varying vec2 place;
  void main() {
    gl_FragColor = vec4(colour, 1.0 - smoothstep(0.35, 1.0, distance(place, middle) / reach));
    #include <colorspace_fragment>
  }
`;

/** A grid that fades out towards `reach` from `middle`: ground without an end. */
export function fadingGrid(
  middle: readonly [number, number],
  reach: number,
  spacing: number,
  colour: string,
): LineSegments {
  const [x, y] = middle;
  const material = new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: { colour: { value: new Color(colour) }, middle: { value: new Vector2(x, y) }, reach: { value: reach } },
    transparent: true,
    depthWrite: false,
  });
  return new LineSegments(linesGeometry(gridLines([x - reach, y - reach, x + reach, y + reach], spacing)), material);
}

function linesGeometry(ends: readonly (readonly [number, number])[]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends.flatMap(([x, y]) => [x, y, 0])), 3));
  return geometry;
}
