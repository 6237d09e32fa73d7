import assert from "node:assert/strict";
import { test } from "node:test";
import { Cells, UNKNOWN } from "../../src/page/plane/cells";
import { looksOf } from "../../src/page/plane/looks";

test("a coarse cell stands for its block until finer ones come", () => {
  const cells = new Cells(5, 3);
  cells.take({
    stride: 4,
    cells: [
      [0, 0, 7],
      [4, 0, 8],
    ],
  });
  assert.deepEqual([cells.at(3, 2), cells.at(4, 2)], [7, 8]);
  cells.take({ stride: 1, cells: [[3, 2, 9]] });
  assert.deepEqual([cells.at(3, 2), cells.at(2, 2), cells.at(3, 1)], [9, 7, 7]);
});

test("cells that nothing is known of say so, and all cells are counted", () => {
  const cells = new Cells(6, 4);
  cells.take({ stride: 2, cells: [[0, 0, 1]] });
  assert.deepEqual(
    [...cells.counts()].sort(),
    [
      [1, 4],
      [UNKNOWN, 20],
    ].sort(),
  );
});

test("a whole plane comes with its first index along x", () => {
  const cells = new Cells(2, 3);
  cells.takeAll([
    [1, 2, 3],
    [4, 5, 6],
  ]);
  assert.deepEqual([cells.at(0, 2), cells.at(1, 0)], [3, 4]);
});

test("no two classes of a picture look the same", () => {
  const names = [
    ...[
      "at rest",
      "rolling anticlockwise",
      "rolling anticlockwise 2",
      "rolling clockwise",
      "rocking",
      "rocking 2",
      "rocking 3",
    ],
    ...["modulated anticlockwise", "aperiodic", "overturned", "not settled", "something new"],
  ];
  const looks = looksOf(names).map(({ colour, texture }) => {
    const pixels = Array.from({ length: 144 }, (_, i) => (texture?.(i % 12, Math.floor(i / 12)) ? 1 : 0));
    return colour + pixels.join("");
  });
  assert.equal(new Set(looks).size, names.length);
});
