import assert from "node:assert/strict";
import { test } from "node:test";
import { OwnRecords } from "../../src/kernels/own-records";
import { readUpload } from "../../src/kernels/records/upload";
import { isAt2, readAt2 } from "../../src/kernels/records/at2";
import { alongAxes, inWords, isOneSet, parsedDirection, splitName, stemOf } from "../../src/kernels/records/directions";
import { floatOf, repr } from "../../src/kernels/records/python";
import { readComponent } from "../../src/kernels/records/reading";
import { RecordText } from "../../src/kernels/records/text";
import { equalSteps } from "../../src/kernels/records/time-steps";
import { inSeconds, timeUnitOf, unitOf } from "../../src/kernels/records/units";
import { Refused } from "../../src/page/server/source";

const named = (name: string) => parsedDirection(name);

test("tokens are numbers where Python reads them as numbers", () => {
  for (const token of ["1", "-.5", "+1.", "1e-3", "1_000.5", " 2 "]) assert.ok(Number.isFinite(floatOf(token)), token);
  for (const token of ["nan", "-inf", "Infinity"]) assert.ok(!Number.isFinite(floatOf(token) ?? 0), token);
  for (const token of ["", "0x10", "1,5", "1d5", "1__0", "_1", ".", "e5"]) assert.equal(floatOf(token), null, token);
});

test("texts and numbers are written as repr writes them", () => {
  const known: readonly (readonly [string | number | null, string])[] = [
    ["a", "'a'"],
    ["it's", `"it's"`],
    [`'"\\`, `'\\'"\\\\'`],
    ["\t\x01\xa0\u3000", "'\\t\\x01\\xa0\\u3000'"],
    [null, "None"],
    [0, "0.0"],
    [-0.02, "-0.02"],
    [1e-5, "1e-05"],
    [1.5e-7, "1.5e-07"],
    [123456, "123456.0"],
    [1e16, "1e+16"],
  ];
  for (const [value, text] of known) assert.equal(repr(value), text);
});

test("units are known by their usual spellings only", () => {
  assert.deepEqual(["CM/SEC**2", "gal", "m/s^2", "m s⁻2", "volt"].map(unitOf), [
    "cm/s²",
    "cm/s²",
    "m/s²",
    "m/s²",
    null,
  ]);
  assert.deepEqual(
    ["Sec.", "ms", "μs", "samples"].map((unit) => timeUnitOf(unit)?.symbol),
    ["s", "ms", "µs", undefined],
  );
  assert.equal(inSeconds(35, { symbol: "ms", seconds: 1e-3 }), 0.035);
});

test("directions are parsed from names", () => {
  const azimuths = ["360", "090", "N10E", "S80E", "S61W", "N20W", "HNE", "north"];
  assert.deepEqual(
    azimuths.map((name) => named(name)?.azimuth),
    [0, 90, 10, 100, 241, 340, 90, 0],
  );
  assert.deepEqual(
    ["up", "DWN", "HGZ"].map((name) => named(name)?.vertical),
    [1, -1, 1],
  );
  assert.deepEqual(
    ["L1", "H2", "HN1", "fp"].map((name) => named(name)?.axis),
    ["x", "y", "x", "y"],
  );
  assert.deepEqual(["Corralitos", "361", "N190E", "HN3"].map(named), [null, null, null, null]);
});

test("names of files are split into event and direction", () => {
  const stems = ["ALH-UP", "site_N-S", "NS_quake", "PAE000_scaled", "El Centro", "quake20160117", "q_HNE_2"];
  assert.deepEqual(
    stems.map((stem) => splitName(stem).event),
    ["ALH", "site", "quake", "PAE_scaled", "El Centro", "quake20160117", "q_2"],
  );
  assert.deepEqual(splitName("PRPCS").direction, null);
  assert.deepEqual(splitName("PRPCS", true).event, "PRPC");
  const files = ["PAE000.AT2.txt", "AKT023.EW", "IU.ANMO.00.HNE", "q.090", "q.dat.gz", "AKT.EW2"];
  assert.deepEqual(files.map(stemOf), ["PAE000", "AKT023.EW", "IU.ANMO.00.HNE", "q", "q", "AKT.EW2"]);
});

test("components are rotated to x along the lower azimuth and y anticlockwise from x", () => {
  const along = (name: string, ...samples: number[]) => {
    const direction = named(name);
    assert.ok(direction);
    return { label: name, direction, samples: Float64Array.from(samples) };
  };
  const { axes, origin } = alongAxes("q", [along("090", 2, 3), along("000", 1, -1), along("DOWN", 5, 5)]);
  assert.deepEqual(
    [axes.x, axes.y, axes.z].map((values) => [...(values ?? [])]),
    [
      [1, -1],
      [-2, -3],
      [-5, -5],
    ],
  );
  assert.equal(origin, "x at azimuth 0°, from 000; y at azimuth 270°, from 090 (azimuth 90°); z up, from DOWN (down)");
  const [slanted, other] = [along("000", 1), along("060", 1)];
  assert.ok(Math.abs((alongAxes("q", [slanted, other]).axes.y?.[0] ?? NaN) + 1 / Math.sqrt(3)) < 1e-15);
  assert.throws(() => alongAxes("q", [along("000", 1), along("010", 1)]), Refused);
  assert.throws(() => alongAxes("q", [along("UP", 1), along("DOWN", 1)]), Refused);
  assert.deepEqual(isOneSet([slanted.direction, other.direction]), true);
  assert.equal(inWords(along("T", 1).direction), "second of two perpendicular axes");
});

test("rounded times give the step of the even grid, and gaps are refused", () => {
  const text = new RecordText("q.txt", "");
  const steps = (times: readonly number[]) => equalSteps(text, Float64Array.from(times), [...times.keys()], null);
  const even = Array.from({ length: 100 }, (_, k) => k);
  assert.deepEqual(steps(even.map((k) => k * 0.1)), [0, 0.1]);
  assert.deepEqual(steps(even.map((k) => Number((k / 128).toFixed(3)))), [0, 1 / 128]);
  assert.deepEqual(steps(even.map((k) => Number((k * 0.005).toFixed(2)))), [0, 0.005]);
  assert.throws(() => steps(even.filter((k) => k !== 50).map((k) => k * 0.01)), /unequal time steps: 0.49 s to 0.51 s/);
  assert.throws(() => steps([0]), /one sample/);
});

test("both headers of AT2 are read", () => {
  const file = (line: string) =>
    new RecordText("q.AT2", `PEER\nQuake, 1/2/1990, Here, 360\nACCELERATION IN UNITS OF G\n${line}\n 0.1 0.2\n-.3\n`);
  for (const line of ["NPTS=   3, DT=   .0050 SEC", "   3   0.0050    NPTS, DT"]) {
    const text = file(line);
    assert.ok(isAt2(text));
    const { columns, step, unit, direction, title } = readAt2(text, null);
    assert.deepEqual(
      [columns.map((values) => [...values]), step, unit, direction?.azimuth],
      [[[0.1, 0.2, -0.3]], 0.005, "g", 0],
    );
    assert.equal(title, "Quake, 1/2/1990, Here, 360");
  }
  assert.throws(
    () => readAt2(file("NPTS= 4, DT= .005 SEC"), null),
    /q.AT2, line 6: the header states 4 samples, the file has 3/,
  );
});

test("files that only the package reads are refused in one line", () => {
  const refused: readonly (readonly [string, RegExp])[] = [
    ["Origin Time       2011/03/11\n1 2\n", /K-NET files/],
    ["NDATA: 2\nUNITS: cm/s^2\n1\n2\n", /ASC files/],
    ['"time","x"\n0,1\n1,2\n', /quotation marks/],
  ];
  for (const [text, what] of refused) {
    assert.throws(
      () => readComponent(new RecordText("q.txt", text), null),
      (error: Refused) =>
        what.test(error.problems[0] ?? "") && /Install stylobate and run/.test(error.problems[0] ?? ""),
    );
  }
});

const sent = (name: string, text: string) => ({ files: [{ name, content: btoa(text) }], units: "g", step: null });

const identityOf = async (body: ReturnType<typeof sent>): Promise<string> => (await readUpload(body)).received.upload;

test("the identity of an upload depends on contents and options", async () => {
  const body = sent("q.txt", "0.0 0.1\n0.5 0.2\n");
  const { received, samples } = await readUpload(body);
  assert.deepEqual([...samples.values], [0.1 * 9.80665, 0, 0, 0.2 * 9.80665, 0, 0]);
  assert.deepEqual([samples.step, received.step, received.name], [0.5, 0.5, "q"]);
  const { upload } = received;
  assert.equal(await identityOf(body), upload);
  for (const other of [
    { ...body, units: "m/s2" },
    sent("r.txt", "0.0 0.1\n0.5 0.2\n"),
    sent("q.txt", "0 0.1\n0.5 0.2\n"),
  ]) {
    assert.notEqual(await identityOf(other), upload);
  }
});

test("uploads that are not held and times that begin later are refused", async () => {
  const records = new OwnRecords(() => assert.fail("no worker is needed"));
  const missing = "motion.upload: record '0123456789ab' is not stored (any more). Upload its files again.";
  assert.throws(
    () => records.samples("0123456789abcdef"),
    (error: Refused) => error.status === 422 && error.problems[0] === missing,
  );
  await assert.rejects(
    readUpload(sent("q.txt", "0.5 0.1\n1.0 0.2\n")),
    /does not read times that begin at 0.5 s and not at 0 s/,
  );
});
