import assert from "node:assert/strict";
import { test } from "node:test";
import { endHeight, flutedOutline } from "../../src/viewer/shaft";

test("twenty flutes close round the shaft without a gap, one of them marked", () => {
  const strips = flutedOutline();
  assert.equal(strips.filter((strip) => strip[0]!.marked).length, 1);
  strips.forEach((strip, i) => {
    const next = strips[(i + 1) % strips.length]![0]!;
    const gap = Math.sin(0.5 * (next.angle - strip.at(-1)!.angle));
    assert.ok(Math.abs(gap) < 1e-12 && Math.abs(next.radius - strip.at(-1)!.radius) < 1e-12);
  });
  assert.equal(strips.length, 40); // a hollow and an edge each
});

test("normals of the outline stand square to it", () => {
  for (const strip of flutedOutline()) {
    for (let i = 1; i + 1 < strip.length; i += 1) {
      const [a, b] = [strip[i - 1]!, strip[i + 1]!];
      const along = [
        b.radius * Math.cos(b.angle) - a.radius * Math.cos(a.angle),
        b.radius * Math.sin(b.angle) - a.radius * Math.sin(a.angle),
      ];
      const cosine =
        (along[0]! * Math.cos(strip[i]!.normal) + along[1]! * Math.sin(strip[i]!.normal)) / Math.hypot(...along);
      assert.ok(Math.abs(cosine) < 0.03, `cosine ${cosine}`);
    }
  }
});

test("the plain ends leave most of any body to the flutes", () => {
  for (const [radius, height] of [
    [0.5, 10],
    [1, 0.1],
    [0.02, 0.05],
  ] as const) {
    const ends = endHeight({ radius, top_radius: radius, height, mass_height: 0.5 * height, slenderness: 0.1 });
    assert.ok(ends > 0 && 2 * ends < 0.3 * height);
  }
});
