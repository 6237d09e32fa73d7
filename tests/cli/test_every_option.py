"""An option that is given is used or refused, whatever the command: nothing is dropped without a word."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import wraps
from pkgutil import resolve_name
from typing import get_args

import pytest

from stylobate.cli.command import Command
from stylobate.cli.command import _chosen as chosen_by
from stylobate.cli.commands import COMMANDS
from stylobate.cli.main import run
from stylobate.cli.simulate import VerdictOfCase
from stylobate.config.options import kinds_in_files
from stylobate.config.parts import MotionConfig

pytestmark = pytest.mark.long


def words(text):
    return tuple(text.split())


COLUMN = ("--slenderness", "0.1", "--damping", "0.1")
TUBE = words("--radius 0.5 --inner-radius 0.2 --height 5 --density 2000")
CONE = words("--radius 0.5 --top-radius 0.4 --height 5 --density 2000")
BODY = words("--radius 1 --mass-height 5 --mass 1 --transverse-inertia 20 --axial-inertia 0.5")
CIRCULAR = ("--motion", "circular", "--acceleration", "0.06")
DRIVEN = (*CIRCULAR, "--angular-frequency", "1.8")
STRAIGHT = ("--motion", "straight", "--acceleration", "0.06")
SLIDING = ("--model", "sliding")
PULSE = words("--motion one-sine --angular-frequency 3 --acceleration 0.2")
RECORD = ("--sample-record", "el centro 1940")
AXES = words("--x damping 0.1 0.2 3 --y start-phase 0 1 2")
STARTS = words("--x tilt-x -0.1 0.1 3 --y tilt-y -0.1 0.1 3")
SAMPLE = words("--random 5 --over tilt-x -0.1 0.1")
RANGE = ("--angular-frequency-range", "1", "2")
SCALES = ("--scales", "0.5", "2", "3")

MOTIONS = {
    "circular": DRIVEN,
    "straight": (*STRAIGHT, "--angular-frequency", "1.8"),
    "elliptic": words("--motion elliptic --amplitude 0.1 0.2 --phase 1 --angular-frequency 2"),
    "oblique": words("--motion oblique --acceleration 0.1 --angle 0.5 --angular-frequency 2"),
    "stroke": words("--motion stroke --stroke 0.01 --frequency 2"),
    "orbit": words("--motion orbit --diameter 0.01 --rpm 60"),
    "sinusoidal": words("--motion sinusoidal --acceleration 0.1 --angular-frequency 2 --cycles 2"),
    "type-a": words("--motion type-a --pulse-velocity 0.1 --angular-frequency 2"),
    "gabor": words("--motion gabor --pulse-velocity 0.1 --frequency 2 --oscillations 3"),
    "machine": words("--motion machine-run --stroke 0.01 --frequency 2 --run-up 1 --run-down 2"),
    "sweep": words("--motion linear-sweep --acceleration 0.1 --frequencies 1 2 --length 4"),
    "long sweep": words("--motion logarithmic-sweep --displacement 0.1 --frequencies 1 2 --length 4"),
    "record": RECORD,
}

BASES = {
    "simulate": [
        *((*COLUMN, *motion, "--duration", "9") for motion in MOTIONS.values()),
        (*TUBE, *DRIVEN, "--duration", "9", "--model", "wobbling"),
        (*CONE, *DRIVEN, "--duration", "9", "--model", "rolling"),
        (*TUBE, *DRIVEN, "--duration", "9", *SLIDING, "--friction-coefficient", "0.3"),
        (*BODY, *DRIVEN, "--duration", "9"),
    ],
    "hierarchy": [(*COLUMN, *DRIVEN, "--duration", "9"), (*TUBE, *PULSE)],
    "response": [(*COLUMN, *CIRCULAR, *RANGE), (*COLUMN, *STRAIGHT, *RANGE, "--model", "wobbling", "--exact")],
    "boundary": [(*COLUMN, *STRAIGHT, *RANGE, "--bounds", "0.1", "0.2")],
    "map": [
        (*COLUMN, *DRIVEN, *AXES, "--periods", "3"),
        (*TUBE, *DRIVEN, *AXES, "--duration", "3", *SLIDING),
        (*TUBE, *PULSE, *words("--x damping 0.1 0.2 3 --y acceleration 1 2 2")),
    ],
    "basin": [(*COLUMN, *DRIVEN, *STARTS, "--periods", "3"), (*COLUMN, *DRIVEN, *SAMPLE, "--periods", "3")],
    "drift": [words("--radius 0.02 --height 0.03 --density 7800 --x acceleration 2 3 2") + MOTIONS["oblique"]],
    "upright": [words("--radius 0.02 --height 0.03 --density 7800") + MOTIONS["oblique"]],
    "feeder": [words("--radius 0.02 --height 0.03 --density 7800") + MOTIONS["oblique"]],
    "spectrum": [
        (*COLUMN, *PULSE, *SCALES),
        (*COLUMN, *PULSE, "--rocking", *words("--x size 1 2 3")),
        (*TUBE, *RECORD, *SCALES, *SLIDING),
    ],
    "fragility": [
        (*COLUMN, "--sample-records", "el centro 1940", *SCALES),
        (*TUBE, "--sample-records", "el centro 1940", *SCALES, *SLIDING),
    ],
    "records": [("--sample-records", "el centro 1940"), ("study.toml",), ("study.toml", "--figure", "records.png")],
    "select": [("--sample-records", "el centro 1940", "--target", "target.csv")],
    "assess": [("study.toml",)],
    "inventory": [("objects.csv", "--sample-records", "el centro 1940"), ("inventory.toml",)],
    "paper": [()],
    "lab": [()],
}

COMPUTING = (
    *("engine.simulate", "studies.model_hierarchy", "studies.response_curves", "studies.exact_response"),
    *("studies.stability_boundary", "studies.overturning_map", "studies.basins"),
    *(
        "conveying.drift",
        "conveying.upright",
        "conveying.sheet",
        "earthquakes.overturning_intervals",
        "earthquakes.rocking_spectrum",
        "earthquakes.fragility_study.FragilityStudy.runs",
    ),
    *(
        "earthquakes.record_selection.select_records",
        "earthquakes.assess",
        "earthquakes.inventory",
        "paper.check_paper",
        "lab.serving.serve",
        "lab.static_site.write",
    ),
    *("cli.records._horizontal", "records.response_spectra"),
)

STUDY = """
friction_coefficient = 0.6
scales = [1.0]
columns.tank = {radius = 0.2, height = 2.0, density = 2700.0}
dissipation = {low = {damping = 0.01}, central = {damping = 0.05}, high = {damping = 0.1}}
records = {samples = ["el centro 1940"]}
"""

OBJECTS = "name,radius,height,density,damping,friction_coefficient\nvase,0.05,0.4,2200,0.05,0.5\n"

INVENTORY = """
objects = "objects.csv"
[sites.""]
records = {samples = ["el centro 1940"]}
"""

MEMBERS = get_args(get_args(MotionConfig)[0])
# What changes the form of what is printed only.
_OF_PRINTING = ("as_json", "pdf")


def exactly(value):
    """Return all numbers of a value; the text of an object has four digits of those that decide."""
    if is_dataclass(value) and not isinstance(value, type):
        return type(value).__name__, [(one.name, exactly(getattr(value, one.name))) for one in fields(value)]
    if isinstance(value, Mapping):
        return [(name, exactly(one)) for name, one in value.items()]
    return [exactly(one) for one in value] if isinstance(value, list | tuple) else value


class ComputedError(Exception):
    """What is to be computed, instead of computing it."""


@pytest.fixture(autouse=True, scope="module")
def parsers_are_kept():
    """Make options and parser of a command once for each choice of kinds: they are asked for a thousand times."""
    kept, made, parsers, parser = {}, Command.options, {}, Command.program

    def options(self, chosen):
        key = id(self), repr(chosen)
        if key not in kept:
            kept[key] = made(self, chosen)
        return kept[key]

    def program(self, name, arguments=()):
        key = name, repr(chosen_by(arguments))
        if key not in parsers:
            parsers[key] = parser(self, name, arguments)
        return parsers[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Command, "options", options)
        patch.setattr(Command, "program", program)
        yield


@pytest.fixture(autouse=True)
def nothing_is_computed(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    (tmp_path / "target.csv").write_text("period [s], Sa [g]\n0.1, 0.9\n3.0, 0.2\n", encoding="utf-8")
    (tmp_path / "objects.csv").write_text(OBJECTS, encoding="utf-8")
    (tmp_path / "inventory.toml").write_text(INVENTORY, encoding="utf-8")
    (tmp_path / VALUES[0]).touch()  # no folder can have this name
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)

    def stop(*arguments, progress=None, started=None, **options):
        del progress
        if started is not None:
            started("an address")
        raise ComputedError(repr(exactly((arguments, sorted(options.items()), opened, cases))))

    cases, of = [], VerdictOfCase.of

    def asked(*arguments):
        cases.append(of(*arguments))  # a verdict follows the run
        return cases[-1]

    monkeypatch.setattr(VerdictOfCase, "of", asked)

    for name in COMPUTING:
        real = resolve_name(f"stylobate.{name}")
        monkeypatch.setattr(f"stylobate.{name}", declared_as(real, stop) if hasattr(real, "study") else stop)


def declared_as(real, stop):
    """Return a function that stops, with the declaration of a study."""

    @wraps(real)
    def stopped(*arguments, **options):
        return stop(*arguments, **options)

    return stopped


def outcome(arguments, capsys):
    """Return what would be computed, or the lines that refuse it; nothing where the command did neither."""
    capsys.readouterr()
    try:
        status = run(arguments)
    except ComputedError as would:
        return str(would), []
    lines = capsys.readouterr().err.splitlines()
    assert status == 2, f"{arguments} ended with status {status}"
    assert lines
    assert all(line.startswith("stylobate: ") for line in lines), lines
    return "", lines


# A number, a whole number, a tolerance, and a word that no option knows.
VALUES = ("0.375", "7", "0.00375", "nonsense")
OTHERS = ("valid integer", "must be a whole number", "must lie between 1e-13 and 0.01")


def with_option(arguments, option, capsys):
    """Return the outcome with this option at the first of the values that its type can have."""
    for value in [[]] if option.is_flag else [[one] * option.nargs for one in VALUES]:
        more = ["0.1", "0.2"] if option.name == "over" else []
        found = outcome([*arguments, option.opts[0], *value, *more], capsys)
        if not any(other in line for other in OTHERS for line in found[1]):
            return found
    return found


def options_of(command):
    kept = [one for one in COMMANDS[command].load().program(command).params if one.opts[0].startswith("--")]
    return [one for one in kept if one.name not in ("help", *_OF_PRINTING)]


@pytest.mark.parametrize(
    ("command", "bases"),
    [
        *((command, bases) for command, bases in BASES.items() if command != "simulate"),
        ("simulate", BASES["simulate"][::5]),
        pytest.param("simulate", BASES["simulate"], marks=pytest.mark.slow),
    ],
)
def test_an_option_that_is_given_is_used_or_refused(command, bases, capsys):
    dropped = []
    for base in bases:
        plain, refused = outcome([command, *base], capsys)
        assert not refused
        for option in (one for one in options_of(command) if not (one.is_flag and one.opts[0] in base)):
            would, lines = with_option([command, *base], option, capsys)
            if not lines and would == plain:
                dropped.append(f"{command} {' '.join(base)} {option.opts[0]}")
    assert dropped == []


@pytest.mark.slow
def test_no_option_of_a_run_is_refused_with_every_column_model_and_motion(capsys):
    never = {one.name: one for one in options_of("simulate")}
    for base in BASES["simulate"]:
        for option in list(never.values()):
            if not with_option(["simulate", *base], option, capsys)[1]:
                del never[option.name]
    # Words, files and options that belong to files, and a sign: none of the values above.
    words = {"shape", "model", "constraint", "couples", "motion"}
    files = {
        "record",
        "record_direction",
        "one_component",
        "sample_record",
        "units",
        "step",
        "figure",
        "output",
        "animation",
        "speed",
        "verdict_figure",
        "verdict_output",
    }
    assert set(never) == {*words, *files, "sense"}


def test_every_command_has_options_to_try():
    assert set(BASES) == set(COMMANDS)


@pytest.mark.parametrize("command", ["map", "spectrum", "fragility"])
def test_a_coefficient_of_friction_that_changes_no_run_is_refused_with_a_remedy(command, capsys):
    base = [command, *BASES[command][0]]
    assert outcome([*base, "--friction-coefficient", "0.3"], capsys)[1] == [
        "stylobate: --friction-coefficient: model 'wobbling' does not use it (got 0.3). "
        "Remove it, or choose --model sliding."
    ]
    assert not outcome([*base, "--model", "sliding", "--friction-coefficient", "0.3"], capsys)[1]


@pytest.mark.parametrize(
    ("command", "more", "told"),
    [
        ("spectrum", "--duration 9 --free-tail 3", "spectrum.tail: contradicts duration"),
        ("fragility", "--years 10", "--years: fragility does not use it (got 10.0)"),
        ("basin", "--seed 3", "--seed: basin does not use it (got 3)"),
        (
            "map",
            "--threads 2 --executor dask://",
            "--threads: the workers of dask:// have one thread each (got 2)",
        ),
    ],
)
def test_an_option_that_another_one_or_its_absence_makes_useless_is_refused(command, more, told, capsys):
    (line,) = outcome([command, *BASES[command][0], *words(more)], capsys)[1]
    assert told in line


def test_every_kind_of_motion_is_in_the_help_and_runs_from_options_or_needs_a_file(capsys):
    motion = next(one for one in options_of("simulate") if one.name == "motion")
    options, in_files = motion.help.replace(" or ", ", ").split("; in a file also")
    listed = {word.strip() for word in options.partition(" (")[0].split(",")}
    listed_in_files = {word.strip() for word in in_files.split(",")}
    kinds = {kind.replace("_", "-") for one in MEMBERS for kind in get_args(one.model_fields["kind"].annotation)}
    assert listed | listed_in_files == kinds
    assert listed_in_files == {kind.replace("_", "-") for kind in kinds_in_files()}
    for kind in listed_in_files:
        (line,) = outcome(["simulate", *COLUMN, "--motion", kind, "--duration", "9"], capsys)[1]
        assert line.startswith("stylobate: --motion: no options state the numbers of this motion")
    names = {one.opts[0] for one in options_of("simulate")}
    for kind in listed - {"record"}:
        for line in outcome(["simulate", *COLUMN, "--motion", kind, "--duration", "9"], capsys)[1]:
            needed = line.removeprefix("stylobate: motion").split()[0].strip(".:").replace("_", "-")
            assert f"--{needed}" in names, line
