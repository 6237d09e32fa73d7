import assert from "node:assert/strict";
import { test } from "node:test";
import { RimVisits } from "../../src/viewer/rim-visits";
import { attitudeAt, rolling } from "./made-up";

const TURN = 2 * Math.PI;
const SECTORS = 60;

function sectorAt(t: number): number {
  const { azimuth, twist } = attitudeAt(t);
  return Math.floor(((((azimuth - twist) / TURN) % 1) + 1) * SECTORS) % SECTORS;
}

test("the part of the rim that touches now has touched just now", () => {
  const visits = new RimVisits(rolling(), SECTORS);
  for (const t of [0.5, 4.2, 13.7]) {
    const touched = visits.last(sectorAt(t - 0.06), t);
    assert.ok(touched !== null && t - touched < 0.3, `last at ${touched}, now ${t}`);
  }
});

test("nothing has touched before it touches", () => {
  const visits = new RimVisits(rolling(), SECTORS);
  const ahead = sectorAt(3);
  assert.equal(visits.last(ahead, 1), null);
  assert.notEqual(visits.last(ahead, 3.2), null);
});

test("rolling once round touches every sector, however few the samples", () => {
  const visits = new RimVisits(rolling(41), SECTORS); // 0.5 s apart: four sectors at a time
  for (let sector = 0; sector < SECTORS; sector += 1) assert.notEqual(visits.last(sector, 20), null);
});

test("a column that stands or flies touches with no part of the rim alone", () => {
  const motion = rolling();
  const standing = new RimVisits({ ...motion, resting: motion.time.map(() => 1) }, SECTORS);
  const flying = new RimVisits({ ...motion, clearance: motion.time.map(() => 0.01) }, SECTORS);
  for (let sector = 0; sector < SECTORS; sector += 1) {
    assert.equal(standing.last(sector, 20), null);
    assert.equal(flying.last(sector, 20), null);
  }
});
