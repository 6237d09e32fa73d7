"""The document for a reviewer: intended use, theory, verification problems, comparisons, limits and platform."""

import importlib.metadata
import inspect
import platform
import subprocess
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
    "Differences in the tables stay there; the text below a table says what is known of their reasons.",
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
_TITLES = {
    "problems": "Closed forms beside runs. Each row names the input; validation/problems.py has it as code.",
    "frozen": "Transitions and outcomes that others published to many digits.",
    "cylinders": "Peak tilts of solid cylinders under pulse-like motions, by Zhou Xun: laws that they must obey.",
    "engines": "Four motions of a rim by physics engines, steps of 0.1 ms.",
    "opensees": "A rocking block by OpenSees' element RockingBC.",
    "hybrid_orbit": "An orbit with two impacts by a program for the continuation of hybrid systems.",
    "practice": "Rules of practice over records: how often each is safe, unsafe or needlessly strict.",
    "round_bodies": "Round bodies: closed forms beside runs.",
    "shake_table": "Shake-table tests of two granite specimens: fraction of outcomes predicted from other tests.",
    "shake_table_errors": "The same tests: what those that ended against the odds have in common.",
    "objects": "Measured objects: the fraction of outcomes of tests that their numbers do not know.",
    "measures_of_tests": "Intensity measures on the shake-table tests.",
    "measures_held_out": "The same: what each measure alone predicts of earthquakes that its fit does not know.",
    "measures_of_columns": "Intensity measures on simulated columns.",
}
_REASONS = {
    "engines": "Rows that differ: default contacts of MuJoCo and PyBullet are soft or lose energy, so that the column "
    "does not keep its tilt, and smaller steps do not mend it. On the coin, which turns fastest, errors of the other "
    "engines fall with the first power of the step, and are 1.2 % at 0.1 ms.",
    "opensees": "Rows that differ: the element assumes small rotations, which accounts for the time at α = 0.2 to "
    "1.6e-4; its peak tilt is not yet converged in e0, by which it varies more than it differs; its restitution comes "
    "from a damping ratio of its own, not from angular momentum about the new edge.",
}
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
        PageSection("Sources", [_sources(tables)]),
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
            content += [_TITLES[name], _table(tables / f"{name}.txt")]
            content += [_REASONS[name]] if name in _REASONS else []
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


def _sources(tables: Path) -> PageTable:
    """List the sources of the comparisons, with the tables in which they are."""
    found: dict[str, set[str]] = {}
    for path in sorted(tables.glob("*.txt")):
        header, *rows = _rows(path)
        if header[0] == "source":
            for row in rows:
                found.setdefault(row[0], set()).add(path.stem)
    return PageTable(["source", "table"], [[name, ", ".join(sorted(found[name]))] for name in sorted(found)])


def _models() -> PageTable:
    rows = [[make.__name__, inspect.cleandoc(make.__doc__ or "").splitlines()[0]] for make in MODELS.values()]
    return PageTable(["model", "what it describes"], rows)


def _platform() -> PageTable:
    named = [("stylobate", importlib.metadata.version("stylobate")), ("commit", _commit())]
    named.append(("Python", platform.python_version()))
    named += [(name, importlib.metadata.version(name)) for name in _PACKAGES]
    named += [("system", f"{platform.system()} {platform.release()}"), ("machine", platform.machine())]
    return PageTable(["part", "version"], [list(pair) for pair in named])


def _commit() -> str:
    """Return the commit of the clone, and whether files differ from it; "not known" outside of a clone."""
    command = ["git", "describe", "--always", "--abbrev=40", "--dirty=, with changes", "--exclude=*"]
    try:
        done = subprocess.run(command, cwd=Path(__file__).parent, capture_output=True, text=True, check=True)  # noqa: S603
    except (OSError, subprocess.CalledProcessError):
        return "not known"
    return done.stdout.strip()
