"""Files spoilt at random are read or refused: nothing but the package's own errors leaves a reader."""

import gzip
import warnings

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import StylobateError
from stylobate.records import RecordFormat, Steps

TABLE = "".join(f"{0.01 * at:.2f} {value}\n" for at, value in enumerate((0.0, 0.5, -0.25, 1e-3, 0.125, 0.0)))
ROWS = "0,00;0,5\n0,01;-0,25\n0,02;0,125\n0,03;0,5\n"
AT2 = "PEER\nQuake, 1/2/1990, Site, 90\nACCELERATION IN UNITS OF G\nNPTS=  6, DT= .005 SEC\n .1 -.2 .3E-01 .4 .5\n .6\n"
ASC = "SAMPLING_INTERVAL_S: 0.005\nNDATA: 3\nSTREAM: HNE\nUNITS: cm/s^2\nDATA_TYPE: ACCELERATION\n1\n2\n3\n"
SEEDS = {
    "a.AT2": AT2,
    "b.AT2": AT2.replace("NPTS=  6, DT= .005 SEC\n", ""),
    "c.txt": TABLE,
    "d.txt": ROWS,
    "e.csv": "time [s],x [g],y [g]\n" + TABLE.replace(" ", ",").replace("\n", ",0.5\n"),
    "f.csv": "time [s];a [m/s²]\n" + ROWS,
    "g.txt": "Time\tAcceleration\tVelocity\n[sec]\t[g]\t[cm/sec]\n" + TABLE.replace(" ", "\t").replace("\n", "\t1\n"),
    "h.ASC": ASC,
    "i.txt": "# remark\n" + "\n".join(f"{0.005 * at:.2f} {at}" for at in range(12)),
}
# Characters on which the readers decide something, and some that surprise them.
PIECES = (
    *"0123456789.,;:\t -+eEdD#%!\n\r\"'[]()=²१\x00\x1a",
    "\r\n",
    "nan",
    "inf",
    "1e308",
    "9" * 30,
    "NPTS",
    "DT=",
    "UNITS",
)
FORMATS = (RecordFormat.AT2, RecordFormat.ASC, RecordFormat.TABLE, RecordFormat.CSV)
OPTIONS = (
    {},
    {"units": "g"},
    {"units": "g", "step": 0.01},
    {"columns": {"time": "time", "x": "x"}},
    {"units": "m/s2", "axis": "z"},
    *({"units": "g", "step": 0.01, "format": one} for one in FORMATS),
)


def spoilt(content, rng):
    for _ in range(rng.integers(1, 5)):
        at, length = int(rng.integers(len(content) + 1)), int(rng.integers(0, 12))
        piece = str(rng.choice(PIECES))
        match rng.integers(5):
            case 0:
                content = content[:at] + content[at + length :]
            case 1:
                content = content[:at] + piece + content[at:]
            case 2:
                content = content[:at] + piece + content[at + len(piece) :]
            case 3:
                content = content[:at] + content[at : at + length] + content[at:]
            case 4:
                lines = content.split("\n")
                rng.shuffle(lines[1:])
                content = "\n".join(lines[: int(rng.integers(1, len(lines) + 1))])
    raw = content.encode(rng.choice(["utf-8", "utf-8", "utf-16"]), errors="replace")
    if rng.random() < 0.1:
        raw = bytes(np.frombuffer(raw, np.uint8) ^ (rng.random(len(raw)) < 0.02).astype(np.uint8) * 255)
    return gzip.compress(raw)[: int(rng.integers(20, 400))] if rng.random() < 0.05 else raw


def refusal(path, options):
    """Return what a reader says of a file that it refuses, or None."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            record = sb.read_record(path, **options)
            sb.read_records(path.parent, options.get("units"), step=options.get("step"), steps=Steps.RESAMPLE)
    except StylobateError as error:
        return str(error)
    except Exception as error:  # noqa: BLE001  any other is what is looked for
        pytest.fail(f"{type(error).__name__}: {error}, of {path.read_bytes()!r} with {options}")
    assert np.all(np.isfinite(record.samples))
    return None


@pytest.mark.parametrize("name", SEEDS)
def test_a_spoilt_file_raises_nothing_but_the_errors_of_the_package(tmp_path, name):
    rng = np.random.default_rng(sum(name.encode()))
    path = tmp_path / name
    outcomes = {"read": 0, "refused": 0}
    for trial in range(400):
        content = spoilt(SEEDS[name], rng)
        path.write_bytes(content)
        options = OPTIONS[int(rng.integers(len(OPTIONS)))]
        message = refusal(path, options)
        outcomes["read" if message is None else "refused"] += 1
        assert message is None or "\n" not in message, (trial, content, options)
    # both ways were tried
    assert min(outcomes.values()) > 10, outcomes
