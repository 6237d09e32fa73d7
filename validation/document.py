"""The document for a reviewer: intended use, theory, verification problems, comparisons, limits and platform."""

import importlib.metadata
import inspect
import platform
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from matplotlib.figure import Figure

from stylobate.models.declared import MODELS
from stylobate.plots.page import PageSection, PageTable, Picture, page

Content = list[str | Picture | PageTable]

_INTENDED = (
    "stylobate computes the motion of one free-standing rigid body of revolution with a flat circular base on a "
    "rigid base that moves: whether it stays, rocks, rolls round its rim, slips or overturns, with tilts, forces "
    "on the base, and the probability of overturning for uncertain records, properties and dissipation.",
    "It is intended for engineers who assess tanks, columns, statues, casks and equipment, for makers of "
    "conveyors, and for research. A person who knows rocking dynamics must choose model, dissipation and records,"
    " and judge the result.",
)
_NOT_INTENDED = (
    "Not covered: flexible or anchored bodies; bodies of several drums; bases that are neither circular nor, in "
    "PlanarRocking, two edges; uneven or soft ground; liquids that slosh; damage of the rim.",
)
_THEORY = (
    "All models are equations of motion of a rigid body with a constraint at its lowest point. The page Equations"
    " of the documentation derives them; the page Models states the assumptions of each. Newton's and Euler's "
    "equations of a body with a quaternion, which share no coordinates with the models, confirm their "
    "accelerations to nine digits.",
    "Runs use a Runge-Kutta method of order 8 with error control, or Taylor series of order 16; events such as "
    "uplift, impact and slip are located within the step. The same run gives the same bits alone and in "
    "ensembles.",
)
_CLASSES = (
    "Each row states its class. Mathematics: a closed form, or a number printed to many digits, within 1e-6 of it"
    " unless the row has another bound. Code: another program with its own errors, within 1 %. Experiment: a "
    "measurement, judged by the statistics in the row; it has no bound. Rule: a rule of practice, whose safety is "
    "stated, not judged. Data: a check of published data. Regression: a result of an earlier version.",
)
_LIMITS = (
    "No round column has been compared with a shake-table test: the two measured specimens rock about two edges. "
    "Single rocking motions are hard to repeat, in tests and in computation; probabilities over records and "
    "properties are the result to rely on.",
    "Dissipation is the number that is known least: compute with three levels of it, as assess does.",
    "Differences in the tables stay there, with their reasons where they are known.",
)
_REPEAT = (
    "make test runs the tests that hold these laws; make validation computes the tables of this document, from a "
    "clone of the repository. Other programs, and data that may not be passed on, are left out unless they are "
    "installed or their folder is named; the program says how.",
)
_MEASURED = (
    "round_bodies",
    "shake_table",
    "shake_table_errors",
    "objects",
    "measures_of_tests",
    "measures_held_out",
    "measures_of_columns",
)
_PACKAGES = ("numpy", "scipy", "llvmlite", "xarray", "matplotlib")


def write(into: Path, tables: Path, computed: Sequence[str] = ()) -> Path:
    """Write the document from the tables and figures in a folder; return its path.

    `computed` are the parts that were computed for it; the tables of others are named as older ones.
    """
    sections = [
        PageSection("Intended use", [*_INTENDED, *_NOT_INTENDED]),
        PageSection("Theory", [*_THEORY, _models()]),
        PageSection("Classes of comparisons", [*_CLASSES, _summary(tables)]),
        PageSection("Verification problems", _part(tables, "problems")),
        PageSection("Numbers published by others", _part(tables, "frozen", "cylinders")),
        PageSection("Other programs", _part(tables, "engines", "opensees", "hybrid_orbit")),
        PageSection("Rules of practice", _part(tables, "practice")),
        PageSection("Measurements", _part(tables, *_MEASURED)),
        PageSection("Limits", list(_LIMITS)),
        PageSection("Version and platform", [_platform(), *_REPEAT]),
    ]
    version = importlib.metadata.version("stylobate")
    lead = [f"stylobate {version}, written on {datetime.now(UTC):%Y-%m-%d}. For a reviewer."]
    older = ", ".join(sorted({path.stem for path in tables.glob("*.txt")} - set(computed)))
    if older:
        lead.append(f"Computed earlier, on a machine that this document does not name: the tables {older}.")
    into.write_text(page("Verification and validation of stylobate", lead, sections), encoding="utf-8")
    return into


def _part(tables: Path, *names: str) -> Content:
    content: Content = []
    for name in names:
        if (tables / f"{name}.txt").is_file():
            content.append(_table(tables / f"{name}.txt"))
        drawn, caption = _FIGURES.get(name, ("", ""))
        if drawn and (tables / drawn).is_file():
            content.append(Picture(Figure(), caption, (tables / drawn).read_bytes()))
    return content or ["Not computed."]


_FIGURES = {
    "engines": ("engines.png", "Relative error against processor time per simulated second, four motions of a rim."),
    "round_bodies": ("settling.png", "Settling disks under six laws of loss."),
    "shake_table": ("shake_table.png", "Tests that overturned, over the probability predicted from other tests."),
}


def _rows(path: Path) -> list[list[str]]:
    lines = path.read_text("utf-8").splitlines()
    cells = [[cell.strip().replace("**", "") for cell in line.strip("|").split("|")] for line in lines if line]
    return [cells[0], *cells[2:]]


def _table(path: Path) -> PageTable:
    header, *rows = _rows(path)
    return PageTable(header, rows)


def _summary(tables: Path) -> PageTable:
    """Count the comparisons of each class."""
    counted: dict[str, list[int]] = {}
    for path in sorted(tables.glob("*.txt")):
        header, *rows = _rows(path)
        if header[-1] != "class":
            continue
        for row in rows:
            name = row[-1].partition(",")[0]
            count = counted.setdefault(name, [0, 0, 0])
            count[2 if ":" not in row[-1] else 0 if row[-1].endswith("agrees") else 1] += 1
    header = ["class", "agree", "differ", "without a bound"]
    return PageTable(header, [[name, *map(str, count)] for name, count in sorted(counted.items())])


def _models() -> PageTable:
    rows = [[make.__name__, inspect.cleandoc(make.__doc__ or "").splitlines()[0]] for make in MODELS.values()]
    return PageTable(["model", "what it describes"], rows)


def _platform() -> PageTable:
    named = [("stylobate", importlib.metadata.version("stylobate")), ("Python", platform.python_version())]
    named += [(name, importlib.metadata.version(name)) for name in _PACKAGES]
    named += [("system", f"{platform.system()} {platform.release()}"), ("machine", platform.machine())]
    return PageTable(["part", "version"], [list(pair) for pair in named])
