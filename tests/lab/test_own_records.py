"""Records of the user in the page: its reader gives what the server gives for the same files."""

import base64
import gzip
import io
import json
import shutil
import subprocess
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

import stylobate as sb
from stylobate import config
from stylobate.errors import StylobateError
from stylobate.lab import tasks
from stylobate.lab.limits import Limits, RefusedError
from stylobate.lab.requests import Archive, Uploads, problems_of_numbers
from stylobate.lab.runs import remarks
from stylobate.records.contents import _PACKED, LONGEST_LINE
from stylobate.records.reading import write_at2, write_csv

WEB = Path(sb.__file__).parent / "lab" / "web"
BUNDLER = WEB / "node_modules" / ".bin" / "esbuild"

pytestmark = [
    pytest.mark.system,
    pytest.mark.skipif(shutil.which("node") is None or not BUNDLER.exists(), reason="needs Node and esbuild"),
]

TIMES = np.arange(0.0, 4.0, 0.02)
SHAKEN = 2.0 * np.exp(-TIMES) * np.sin(9.0 * TIMES + 0.3)


def in_rows(*columns, between=" ", form=".6g"):
    """Return numbers as lines of text, a column for each argument."""
    return "".join(between.join(format(value, form) for value in row) + "\n" for row in zip(*columns, strict=True))


def at2(direction, values=SHAKEN, *, station="Somewhere", step=".0200", line="NPTS= {count}, DT= {step} SEC", unit="G"):
    """Return the text of an AT2 file."""
    header = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        f"Quake, 1/2/1990, {station}, {direction}",
        f"ACCELERATION TIME SERIES IN UNITS OF {unit}",
        line.format(count=len(values), step=step),
    ]
    numbers = [f"{value:15.7E}" for value in values / 9.80665]
    return "\n".join([*header, *("".join(numbers[at : at + 5]) for at in range(0, len(values), 5)), ""])


def written(write, name, folder, *, samples, step=0.02, **options):
    """Return a file, by its name, that the package writes."""
    path = folder / name
    write(sb.Record(samples=samples, step=step, name="quake"), path, **options)
    return {name: path.read_bytes()}


def cases(folder):
    """Return the files and options of each case by its name."""
    three = np.stack([SHAKEN, 0.7 * SHAKEN[::-1], 0.3 * SHAKEN], axis=-1)
    pair = {"quake_000.AT2": at2(0), "quake_090.AT2": at2(90, 0.5 * SHAKEN)}
    table = in_rows(TIMES, SHAKEN)
    old = "{count}    {step}    NPTS, DT"
    rounded = in_rows(np.round(np.arange(200) * 0.005, 2), SHAKEN, form=".5f").replace("000 ", " ")
    yield "three AT2 files", {**pair, "quake_UP.AT2": at2("UP", 0.2 * SHAKEN)}, {}
    yield "AT2 files in another order", dict(reversed(pair.items())), {}
    yield "AT2 of the package", written(write_at2, "quake.AT2", folder, samples=three, axis="z"), {}
    yield "CSV of the package", written(write_csv, "quake.csv", folder, samples=three), {}
    yield "CSV of the package, one axis", written(write_csv, "x.csv", folder, samples=SHAKEN, step=0.0125), {}
    yield "old header", {"quake.AT2": at2(360, line=old)}, {}
    yield "step with the exponent D", {"quake.AT2": at2(270, step="2.0D-02")}, {}
    yield "step in ms", {"quake.AT2": at2("DWN", line="NPTS= {count}, DT= 35 MSEC")}, {}
    yield "unit in the header", {"quake.AT2": at2("N10E", unit="CM/SEC**2")}, {}
    yield "no line of NPTS", {"q.AT2": at2(0, line="")}, {"step": 0.01}
    yield "slanted azimuths", {"q_030.AT2": at2(30), "q_110.AT2": at2(110, SHAKEN[::-1])}, {}
    yield "azimuths 90 and 360", {"q_090.AT2": at2(90), "q_360.AT2": at2(360, SHAKEN[::-1])}, {}
    yield "unequal lengths", {"q_000.AT2": at2(0), "q_090.AT2": at2(90, SHAKEN[:190])}, {}
    yield "lost shaking", {"q_000.AT2": at2(0), "q_090.AT2": at2(90, SHAKEN[:30])}, {}
    yield "two stations", {"a_000.AT2": at2(0), "b_090.AT2": at2(90, station="Elsewhere")}, {}
    yield "tabs", {"q.txt": in_rows(TIMES, SHAKEN, between="\t")}, {"units": "cm/s2"}
    yield "one column", {"q.txt": in_rows(SHAKEN)}, {"units": "gal", "step": 0.005}
    yield "directions in names", {f"q_{way}.dat": table for way in ("NS", "EW", "UP")}, {"units": "mm/s²"}
    yield "perpendicular axes", {f"q-{way}.dat": table for way in ("L1", "T1")}, {"units": "m/s2"}
    yield "channels", {f"q.{way}.dat": table for way in ("HNE", "HNN", "HNZ")}, {"units": "m/s2"}
    yield "single letters", {f"PRPC{way}.txt": table for way in "SWZ"}, {"units": "m/s2"}
    yield "marks of processing", {f"q_{way}_scaled.txt": table for way in ("H1", "h2")}, {"units": "m/s2"}
    yield "bearings", {"q N10E.txt": table, "q S80E.txt": table}, {"units": "m/s2"}
    yield "comments and Windows", {"q.txt": "# a\r\n% b\r\n" + table.replace("\n", "\r\n")}, {"units": "m/s2"}
    yield "Latin-1", {"q.txt": f"# Größe\n{table}".encode("latin-1")}, {"units": "m/s2"}
    yield "UTF-16", {"q.csv": f"time [s],a [cm/s²]\n{in_rows(TIMES, SHAKEN, between=',')}".encode("utf-16")}, {}
    yield "mark of UTF-8", {"q.csv": f"\ufefft,a\n{in_rows(TIMES, SHAKEN, between=',')}"}, {"units": "m/s2"}
    yield "gzip", {"q.txt.gz": gzip.compress(table.encode())}, {"units": "m/s2"}
    yield "decimal commas", {"q.txt": in_rows(TIMES, SHAKEN, between=";").replace(".", ",")}, {"units": "m/s2"}
    plain = in_rows(SHAKEN, form=".4f").replace(".", ",")
    yield "decimal commas in a column", {"q.txt": plain}, {"units": "g", "step": 0.01}
    named = {
        "times and an acceleration": ("time,acc", 1, ","),
        "units in brackets": ("time [ms];NS [cm/s²];EW [cm/s²];UD [cm/s²]", 3, ";"),
        "axes": ("t\tax\tay", 2, "\t"),
        "directions": ("time acc_NS acc_EW", 2, " "),
        "units below": ("time  x  y\n[s]  [g]  [g]", 2, " "),
        "a title above": ("My shaking table\ntime (s)  acceleration (m/s2)", 1, "  "),
        "no times": ("x [g],y [g]", 1, ","),
        "one name": ("acc [g]", 0, ","),
    }
    for name, (header, count, between) in named.items():
        columns = (TIMES, *(SHAKEN * scale for scale in (1.0, 0.5, 0.2)))[: count + 1]
        options = {"step": 0.02} if name in ("no times", "one name") else {}
        units = {} if "[g]" in header or "cm/s" in header or "m/s2" in header else {"units": "g"}
        yield f"named: {name}", {"q.csv": f"{header}\n{in_rows(*columns, between=between)}"}, {**options, **units}
    yield "three columns without names", {"q.txt": in_rows(TIMES, SHAKEN, SHAKEN[::-1])}, {"units": "m/s2"}
    yield "four columns", {"q.txt": in_rows(TIMES, SHAKEN, SHAKEN[::-1], 0.3 * SHAKEN)}, {"units": "m/s2"}
    yield "rounded times", {"q.txt": rounded}, {"units": "g"}
    yield "rounded times of a known step", {"q.txt": rounded}, {"units": "g", "step": 0.005}
    yield "strong and long", {"q.txt": in_rows(np.arange(200), 50.0 * SHAKEN)}, {"units": "m/s2"}
    yield "only vertical", {"q_UP.AT2": at2("UP")}, {}
    yield "no acceleration", {"q.txt": in_rows(TIMES, 0.0 * SHAKEN)}, {"units": "g"}
    yield from refusals(pair, table)


def zipped(files, method=zipfile.ZIP_DEFLATED):
    """Return a zip archive of files."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", method) as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return {"PEER.zip": content.getvalue()}


def archives():
    """Return the cases of archives."""
    pair = {"quake_000.AT2": at2(0), "quake_090.AT2": at2(90, 0.5 * SHAKEN)}
    others = {"quake_000.VT2": "velocities", "_SearchResults.csv": "Result", ".hidden": "", "__MACOSX/._q": "x"}
    events = {f"RSN{k}_Q_A{way}.AT2": at2(way, SHAKEN / k) for k in (1, 2) for way in ("000", "090")}
    yield "archive of one event", zipped({**pair, **others}), {}
    yield "archive without compression", zipped(pair, zipfile.ZIP_STORED), {}
    yield "archive of one file", zipped({"folder/quake_000.AT2": pair["quake_000.AT2"]}), {}
    yield "archive of two events", zipped({**events, "read me.txt": "Some words."}), {}
    yield "archive of two events, the second", zipped(events), {"record": "RSN2_Q_A"}
    yield "archive with folders", zipped({f"{way}/{name}": text for way in "ab" for name, text in pair.items()}), {}
    yield "archive of gzip", zipped({"q.txt.gz": gzip.compress(in_rows(TIMES, SHAKEN).encode())}), {"units": "g"}
    yield "refused: no such record", zipped(events), {"record": "RSN3_Q_A"}
    yield "refused: no record in an archive", zipped({"read me.txt": "Some words."}), {}
    yield "refused: an archive cut short", {"PEER.zip": zipped(pair)["PEER.zip"][:-30]}, {}
    yield "refused: an archive among others", {**zipped(pair), **pair}, {}


def refusals(pair, table):
    """Return the cases that are refused."""
    plain = {"units": "g"}
    wrong = {
        "no number": "0.00 0.1\n0.02 O.1\n0.04 0.2\n",
        "not finite": "0.00 0.1\n0.02 nan\n0.04 0.2\n",
        "a decimal comma": "0.00 0.1\n0.02 0,2\n0.04 x\n",
        "unequal steps": in_rows(np.delete(TIMES, [7, 20]), np.delete(SHAKEN, [7, 20])),
        "times backwards": "0.2 1\n0.1 1\n0.0 1\n",
        "five columns": "0 1 2 3 4\n1 1 2 3 4\n",
        "velocities": in_rows(TIMES, SHAKEN, np.cumsum(SHAKEN) * 0.02),
        "a short line": "0 1\n1 1\n2\n",
        "one row": "0.0 0.1\n",
        "no step": "0.1\n0.2\n",
        "empty": "\n \n",
        "comments only": "# nothing\n# at all\n",
        "other comments only": "% nothing\n",
        "words": "some words\nand more\n",
        "names alone": "time,acc\n",
        "ambiguous commas": "1,05\n2,10\n3,15\n",
        "commas and points": "0.0;1,5\n0.1;1.5\n",
        "an unknown unit": "time [s],x [volt]\n0,1\n1,2\n",
        "an unknown unit of time": "time [fortnights],x [g]\n0,1\n1,2\n",
        "two units": "time,x [g],y [m/s2]\n0,1,1\n1,2,1\n",
        "two of one name": "time,x,x\n0,1,1\n1,2,1\n",
        "no acceleration": "time,p,q\n0,1,1\n1,2,1\n",
        "a short line of names": "time,x,y\n0,1,1\n1,2\n",
        "one row of a column": "x [g]\n0.1\n",
        "a spoilt first row": "time,x\n0.0,?\n0.1,2\n",
        "huge numbers": "0 1e40\n1 2e40\n",
        "a zip archive": b"PK\x03\x04 and more",
        "a workbook": b"PK\x03\x04 xl/workbook",
        "a PDF": b"%PDF-1.4",
        "a long line": "0.1\n" + "0.1 " * (LONGEST_LINE // 4) + " 0.1\n0.1\n",
        "a long line of UTF-16": ("0.1\n" + "\xb5" * (LONGEST_LINE // 2 + 1) + "\n0.1\n").encode("utf-16"),
        "a line almost as long": "0.1\n" + "0.1 " * (LONGEST_LINE // 4 - 1) + "\n0.1\n",
        "a long word": f"0.1\n{'7x' * 5000}\n0.2\n",
        "many opening brackets": f"{'[' * 16000}\n0.1 0.2\n0.2 broken\n",
        "many blanks in a name": f"a{' ' * 16000}b,x\n0.1,0.2\n0.2,broken\n",
        "many blanks behind a count": f"200{' ' * 16000}b\n0.1\n0.2\n",
        "many counts": f"{'NPTS=' * 3200}\n0.1\n0.2\n",
        **{f"packed, {begin[:3]!r}": begin + bytes(50) for begin in _PACKED},
    }
    for name, content in wrong.items():
        yield f"refused: {name}", {"q.txt": content}, {**plain, **({"step": 0.01} if "of a column" in name else {})}
    yield "refused: no unit", {"q.txt": table}, {}
    yield "refused: no such unit", {"q.txt": table}, {"units": "furlong"}
    yield "refused: the unit of the file", {"q.AT2": at2(0)}, {"units": "cm/s2"}
    yield "refused: another step", {"q.txt": table}, {"units": "g", "step": 0.01}
    yield "refused: no step at all", {"q.txt": in_rows(SHAKEN)}, {"units": "g", "step": 0}
    yield "refused: a tiny step", {"q.txt": in_rows(SHAKEN)}, {"units": "g", "step": 1e-31}
    yield "refused: a small step", {"q.txt": in_rows(SHAKEN)}, {"units": "g", "step": 1e-12}
    yield "refused: a step in words", {"q.txt": in_rows(SHAKEN)}, {"units": "g", "step": "soon"}
    headers = {
        "the count": "NPTS= 201, DT= .02 SEC",
        "a count of words": "NPTS= many, DT= .02 SEC",
        "a count of one": "NPTS= 1, DT= .02 SEC",
        "no DT": "NPTS= {count}, DT= SEC",
        "a negative DT": "NPTS= {count}, DT= -.02 SEC",
        "no header": "",
    }
    for name, line in headers.items():
        yield f"refused: {name}", {"q.AT2": at2(0, line=line)}, {}
    yield "refused: velocities", {"q.AT2": at2(0).replace("ACCELERATION", "VELOCITY")}, {}
    yield "refused: binary", {"q.AT2": b"\x00\x01\x02"}, {}
    yield "refused: steps differ", {**pair, "quake_UP.AT2": at2("UP", step=".01")}, {}
    yield "refused: three horizontal", {**pair, "quake_180.AT2": at2(180)}, {}
    yield "refused: parallel", {"q_000.AT2": at2(0), "q_010.AT2": at2(10)}, {}
    yield "refused: unknown direction", {"q_000.txt": table, "other.txt": table}, plain
    yield "refused: whole records", dict.fromkeys(("q_1.csv", "q_NS.csv"), "time,x,y\n0,1,1\n1,2,1\n"), plain
    yield "refused: a whole record of two", {"q_NS.csv": "time,x,y\n0,1,1\n1,2,1\n", "q_EW.txt": table}, plain
    yield "refused: one of two", {"q_000.AT2": at2(0), "q_090.AT2": at2(90) + " x"}, {}


def sent(files, options):
    """Return what the page sends for these files."""
    contents = {name: text if isinstance(text, bytes) else text.encode() for name, text in files.items()}
    files = [{"name": name, "content": base64.b64encode(text).decode()} for name, text in contents.items()]
    return {"files": files, "units": None, "step": None, **options}


with TemporaryDirectory() as _folder:
    CASES = {name: sent(files, options) for name, files, options in (*cases(Path(_folder)), *archives())}


@pytest.fixture(scope="module")
def in_page(tmp_path_factory):
    """Return the answers of the page, by name."""
    folder = tmp_path_factory.mktemp("reader")
    return dict(zip(CASES, answers_of_page(list(CASES.values()), folder), strict=True))


def answers_of_page(bodies, folder):
    """Return the answers of the page's reader."""
    made, script = folder / "read-records.mjs", WEB / "test" / "kernels" / "read-records.ts"
    options = ["--bundle", "--platform=node", "--format=esm", "--log-level=error", f"--outfile={made}"]
    subprocess.run([str(BUNDLER), str(script), *options], check=True, timeout=60)
    (folder / "sent.json").write_text(json.dumps(bodies))
    subprocess.run(["node", str(made), str(folder)], check=True, timeout=120)
    return json.loads((folder / "answers.json").read_text())


def answer_of_server(body, folder):
    """Return the answer of the server to an upload, as `Api.upload` forms it, and the record."""
    limits = Limits()
    uploads = Uploads(folder, limits.uploads, limits.unpacked)
    if problems := problems_of_numbers({name: body[name] for name in ("units", "step")}, limits):
        return {"problems": problems}, None
    try:
        upload = uploads.add(body)
    except RefusedError as error:
        return {"problems": list(error.problems)}, None
    place = f"{upload.folder}/"
    archive = Archive({}, ())
    try:
        if upload.is_archive:
            archive = tasks.archive(upload.first_read(), lambda _: None)
            upload = uploads.choose(upload, archive, body.get("record"))
        received = tasks.record(upload.first_read(), lambda _: None)
    except RefusedError as error:
        return {"problems": list(error.problems)}, None
    except StylobateError as error:
        return {"problems": [line.replace(place, "") for line in str(error).splitlines()]}, None
    received |= {"records": list(archive.records), "warnings": [*archive.warnings, *received["warnings"]]}
    with remarks(upload.motion()):
        return received, config.RecordMotion.parse(upload.motion()).build()


def compare(page, body, folder):
    """Compare the answers of page and server to one upload."""
    received, record = answer_of_server(body, folder)
    if record is None:
        assert page == received
        return
    assert page.get("problems") is None
    assert page["received"].pop("upload").startswith("page-")
    peaks = received.pop("peaks").model_dump(exclude_none=True)
    assert page["received"].pop("peaks") == pytest.approx(peaks, rel=1e-15, abs=0.0)
    assert page["received"] == received
    assert page["step"] == record.step
    largest = np.abs(record.samples).max()
    assert np.abs(np.reshape(page["values"], (-1, 3)) - record.samples).max() <= 1e-15 * largest


@pytest.mark.parametrize("name", CASES)
def test_the_page_reads_what_the_server_reads(name, in_page, tmp_path):
    refused = "problems" in in_page[name]
    assert refused == name.startswith("refused"), in_page[name]
    compare(in_page[name], CASES[name], tmp_path)
