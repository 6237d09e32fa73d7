import assert from "node:assert/strict";
import { test } from "node:test";
import { inWordsOfForm } from "../../src/page/controls/record-form";

test("what the server asks for is named as the form names it", () => {
  const said = {
    'a.txt: the file names no unit: state units, "g", "m/s²" or "cm/s²"':
      "a.txt: the file names no unit: choose its unit above.",
    "a.AT2: units must be left out or 'g', which the file states, got 'm/s2'":
      "a.AT2: the file states the unit g; choose “unit: from the file”.",
    "a.txt, line 2: a single column has no time step: state step, in s":
      "a.txt, line 2: a single column has no time step: enter the time step above.",
    "a: one horizontal component (a.AT2). List the files of the event together, or set single if one component is meant":
      "a: one horizontal component (a.AT2). Choose all files of the event together, if it has more",
    "a: the headers name different events or stations: b, c. List the files of each event together":
      "a: the headers name different events or stations: b, c. Choose the files of one event only",
    "a: a.AT2 loses 3 % of its Arias intensity. Set lengths to pad, or check that the files are of one event":
      "a: a.AT2 loses 3 % of its Arias intensity. Check that the files are of one event",
    "a.AT2: if the file is in another unit, such as cm/s², name that (units)":
      "a.AT2: if the file is in another unit, such as cm/s², choose that above",
    "a.txt, line 3: not a number: 'x'": "a.txt, line 3: not a number: 'x'",
  };
  for (const [line, here] of Object.entries(said)) assert.equal(inWordsOfForm(line), here);
});
