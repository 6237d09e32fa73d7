"""Command lines and TOML files with hostile values, drawn from a grammar with a seed; and how to run one of them."""

import random
import re
import signal
import time
import warnings
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType

from stylobate.cli.commands import COMMANDS
from stylobate.cli.main import run
from stylobate.cli.terminal import _is_importing

PROCESSOR_TIME = 10.0
"""Longest processor time of one command line that shows no progress [s]."""

COLUMN = "--slenderness 0.1 --damping 0.1"
TUBE = "--radius 0.5 --inner-radius 0.2 --height 5 --density 2000"
CIRCULAR = "--motion circular --acceleration 0.06"
DRIVEN = f"{CIRCULAR} --angular-frequency 1.8"
RANGE = "--angular-frequency-range 1 2"
BASES = {
    "simulate": [
        f"{COLUMN} {DRIVEN} --duration 3 --tilt 0.03 0.01",
        f"{TUBE} --model wobbling --motion elliptic --amplitude 2 1 --phase 1 --angular-frequency 3 --duration 2",
        f"{TUBE} --model rolling --motion gabor --pulse-velocity 0.4 --frequency 2 --oscillations 3",
        f"{TUBE} --model sliding --friction-coefficient 0.3 --motion stroke --stroke 0.3 --frequency 1 --duration 1",
        f"{COLUMN} --motion linear-sweep --acceleration 0.1 --frequencies 1 2 --length 4",
    ],
    "hierarchy": [f"{COLUMN} {DRIVEN} --duration 2"],
    "response": [f"{COLUMN} {CIRCULAR} {RANGE} --points 20"],
    "boundary": [f"{COLUMN} --motion straight --acceleration 0.06 {RANGE} --bounds 0.1 0.2"],
    "map": [f"{COLUMN} {DRIVEN} --x damping 0.1 0.2 3 --y start-phase 0 1 2 --periods 3"],
    "basin": [
        f"{COLUMN} {DRIVEN} --x tilt-x -0.1 0.1 3 --y tilt-y -0.1 0.1 3 --periods 9",
        f"{COLUMN} {DRIVEN} --random 5 --over tilt-x -0.1 0.1 --periods 9",
    ],
    "spectrum": [f"{COLUMN} --motion one-sine --angular-frequency 3 --acceleration 0.2 --scales 0.5 2 3"],
    "fragility": [f"{COLUMN} --sample-records EL --scales 0.5 2 3"],
    "records": ["--sample-records EL"],
}
"""Command lines that compute, by command; those of studies are cheap to refuse and are not computed here."""

TABLES = {
    "column": {"shape": "dimensionless", "slenderness": 0.1},
    "model": {"kind": "slender", "damping": 0.1},
    "motion": {"kind": "circular", "acceleration": 0.06, "angular_frequency": 1.8},
    "duration": 30.0,
    "tilt": [0.03, 0.01],
    "samples": 10,
    "map": {"x": {"name": "damping", "from": 0.1, "to": 0.2, "number": 3}, "y": {"name": "delay", "values": [0.0]}},
    "basin": {"x": {"name": "tilt_x", "from": 0.1, "to": 0.2, "number": 3}, "y": {"name": "tilt_y", "values": [0.0]}},
    "angular_frequency_range": [1.0, 2.0],
    "points": 20,
    "rules": {"periods": 5},
}

NUMBERS = (
    *("0", "-0.0", "nan", "inf", "-inf", "1e300", "-1e300", "1e-300", "5e-324", "1.7e308", "-1", "-1e-9", "1e15"),
    *("9223372036854775808", "2147483648", "2000000000", "1e10", "1e9", "3.5", "1e-200", "0.1", "7", "1"),
)
WORDS = ("", "\0", "nonsense", "circular", "1e", "--", "-", " ", "é" * 300, "a\nb", "../..", "{}", "[]", "0x10", "1_0")
DEEP = 10_000
SAMPLE = "el centro 1940"


def words(text: str) -> list[str]:
    """Return the arguments in a text; the name of the sample record has spaces."""
    return [SAMPLE if one == "EL" else one for one in text.split()]


def hostile(draw: random.Random) -> str:
    """Return a value that a command line may be given."""
    return draw.choice(NUMBERS if draw.random() < 0.75 else WORDS)


def written(value: object) -> str:
    """Return a value as TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_quoted(name)} = {written(one)}" for name, one in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return value if isinstance(value, Written) else _quoted(value) if isinstance(value, str) else repr(value)


class Written(str):
    """A text that is TOML already."""

    __slots__ = ()


def _quoted(text: str) -> str:
    return '"' + "".join(f"\\u{ord(one):04x}" if one in '"\\' or one < " " else one for one in text) + '"'


def hostile_toml(draw: random.Random) -> object:
    """Return a value that a TOML file may hold."""
    kind = draw.random()
    if kind < 0.55:
        number = draw.choice(NUMBERS)
        return Written(number if number != "1e" else "0")
    if kind < 0.75:
        return draw.choice(WORDS)
    deep = draw.choice((3, 100, DEEP))
    odd = (
        [],
        {},
        [[]],
        {"kind": []},
        True,
        Written("1979-05-27"),
        [1.0] * 9,
        {"": {"": 1}},
        _nested(deep),
        _tables(deep),
    )
    return draw.choice(odd)


def _nested(deep: int) -> Written:
    return Written("[" * deep + "]" * deep)


def _tables(deep: int) -> Written:
    return Written("{a=" * deep + "1" + "}" * deep)


def options_of(command: str) -> list:
    """Return the options of a command but for those that write or serve, and those that start other processes."""
    left_out = {"help", "figure", "output", "executor", "folder", "runs_figure", "resume", "workers", "store"}
    parsed = COMMANDS[command].load().program(command).params
    return [one for one in parsed if one.opts[0].startswith("--") and one.name not in left_out]


@dataclass(frozen=True)
class Case:
    """A command line, and the TOML file that it reads as study.toml, if any."""

    arguments: tuple[str, ...]
    toml: str | None = None


def case(seed: int, commands: tuple[str, ...] = tuple(BASES)) -> Case:
    """Return the case of this seed."""
    draw = random.Random(seed)  # noqa: S311  not for secrets
    command = draw.choice(commands)
    if draw.random() < 0.4:
        return Case((command, "study.toml"), _study(draw))
    arguments = words(draw.choice(BASES[command]))
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        arguments = _changed(draw, command, arguments)
    return Case((command, *arguments))


def _changed(draw: random.Random, command: str, arguments: list[str]) -> list[str]:
    kind = draw.random()
    values = [place for place, one in enumerate(arguments) if not one.startswith("--")]
    if kind < 0.5 and values:  # another value
        place = draw.choice(values)
        return [*arguments[:place], hostile(draw), *arguments[place + 1 :]]
    if kind < 0.85:  # one more option, perhaps a second time
        option = draw.choice(options_of(command))
        count = 0 if option.is_flag else option.nargs + 2 * (option.name == "over")
        return [*arguments, option.opts[0], *(hostile(draw) for _ in range(count))]
    place = draw.randrange(len(arguments))
    if kind < 0.95:  # a value or an option is missing
        return arguments[:place] + arguments[place + 1 :]
    return [*arguments[:place], draw.choice(("--unknown", "stray", "-x", "study.toml")), *arguments[place:]]


def _study(draw: random.Random) -> str:
    values = {name: dict(one) if isinstance(one, dict) else one for name, one in TABLES.items()}
    for _ in range(draw.choice((1, 1, 2, 3))):
        table = values
        while True:
            name = draw.choice([*table, draw.choice(("kind", "", "unknown", "spin", "motions", "\0"))])
            inner = table.get(name)
            if isinstance(inner, dict) and draw.random() < 0.8:
                table[name] = table = dict(inner)
                continue
            table[name] = hostile_toml(draw)
            break
    text = "\n".join(f"{_quoted(name)} = {written(value)}" for name, value in values.items())
    if draw.random() < 0.1:  # not TOML, or not text
        place = draw.randrange(len(text))
        text = text[:place] + draw.choice(("[", "=", '"', "\0", "\ufeff", "#")) + text[place + 1 :]
    return text


SILENT = "no sign of life"


class TooLongError(BaseException):
    """The case took its processor time and said nothing."""


def _is_in_hdf5(frame: FrameType | None) -> bool:
    while frame is not None:
        if "/h5py/" in frame.f_code.co_filename or "/h5netcdf/" in frame.f_code.co_filename:
            return True
        frame = frame.f_back
    return False


def _stop(number: int, frame: FrameType | None) -> None:
    del number
    if _is_importing(frame) or _is_in_hdf5(frame):
        # Broken off, they would leave half a module, or a file that HDF5 takes for open, to the tests that follow.
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.1)
        return
    raise TooLongError


@dataclass
class Report:
    """What became of the cases: counts of outcomes, the longest processor time, and the cases with a fault."""

    processor_time: float = PROCESSOR_TIME
    counts: Counter = field(default_factory=Counter)
    longest: tuple[float, tuple[str, ...]] = (0.0, ())
    faults: list[tuple[Case, str]] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    def add(self, one: Case, capsys) -> None:
        """Run a case in this process and note its outcome."""
        if one.toml is not None:
            Path("study.toml").write_text(one.toml, encoding="utf-8", errors="surrogatepass")
        began = time.process_time()
        fault = self._fault(one.arguments, capsys)
        taken = time.process_time() - began
        self.counts["cases"] += 1
        self.longest = max(self.longest, (taken, one.arguments))
        if fault:
            self.faults.append((one, fault))

    def _fault(self, arguments: tuple[str, ...], capsys) -> str:
        """Return what is wrong with the way in which a command line ends; nothing if it is right."""
        before = signal.signal(signal.SIGVTALRM, _stop)
        signal.setitimer(signal.ITIMER_VIRTUAL, self.processor_time)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                status = run(arguments)
        except TooLongError:
            self.counts["stopped"] += 1
            return "" if re.search(r"^stylobate: (about )?\d", capsys.readouterr().err, re.MULTILINE) else SILENT
        except BaseException as error:  # noqa: BLE001  each is a fault
            capsys.readouterr()
            return f"{type(error).__name__}: {error}"
        finally:
            signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
            signal.signal(signal.SIGVTALRM, before)
        told = capsys.readouterr().err.splitlines()
        self.told = told
        self.counts["computed" if status == 0 else "refused"] += 1
        if status not in (0, 2):
            return f"status {status}"
        if status == 2 and not (told and all(re.match("stylobate: .", line) for line in told)):
            return f"refused with {told!r}"
        return "a warning of a library" if any("Warning" in line for line in told) else ""
