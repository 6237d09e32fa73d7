/** Shadows of convex bodies: the hull of the shadows of their points, its edge softer the higher what casts it. */

/** A shadow of a point, and how high above the floor the point is. */
export interface Cast {
  readonly x: number;
  readonly y: number;
  readonly height: number;
}

/** Return the convex hull of points, anticlockwise: Andrew's monotone chain. */
export function convexHull(points: readonly Cast[]): Cast[] {
  const ordered = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  const chain = (given: readonly Cast[]): Cast[] => {
    const kept: Cast[] = [];
    for (const point of given) {
      while (kept.length > 1 && turn(kept.at(-2)!, kept.at(-1)!, point) <= 0) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return [...chain(ordered), ...chain(ordered.toReversed())];
}

function turn(a: Cast, b: Cast, c: Cast): number {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/** Return the unit normals that point out of a convex outline, at its corners. */
export function outwardNormals(hull: readonly Cast[]): (readonly [number, number])[] {
  const edge = (i: number): readonly [number, number] => {
    const [a, b] = [hull[i]!, hull[(i + 1) % hull.length]!];
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    return [(b.y - a.y) / length, (a.x - b.x) / length];
  };
  return hull.map((_, i) => {
    const [before, after] = [edge((i + hull.length - 1) % hull.length), edge(i)];
    const sum = [before[0] + after[0], before[1] + after[1]] as const;
    const length = Math.hypot(...sum) || 1;
    return [sum[0] / length, sum[1] / length];
  });
}
