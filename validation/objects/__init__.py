"""Measured objects: a folder for each, which is a page of the gallery of objects and an acceptance test at once.

`object.toml` describes the object, the tests with their outcomes, and what is expected of the model; `page.md` tells of
it. The page "Your object, your test" of the documentation says how to add one.
"""

import csv
import importlib
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc, truncnorm

import stylobate as sb
from stylobate.base_motions import BaseMotion
from stylobate.config import SimulationConfig
from stylobate.earthquakes import scores
from stylobate.models import Model
from validation.finding import Finding, Kind

FOLDER = Path(__file__).parent
_DRAWS, _SEED = 256, 20261128

Tests = tuple[Sequence[BaseMotion], npt.NDArray[np.bool_]]


@dataclass(frozen=True, kw_only=True)
class MeasuredObject:
    """An object with tests in which it stood or fell, and what is expected of its model.

    Parameters
    ----------
    folder
        Folder with `object.toml`.
    title, source
        What it is, and who tested it.
    model
        Column and equations of motion, with the numbers that do not vary.
    numbers
        Normal distribution between tests of each number that varies, by the name of a parameter: mean, standard
        deviation, smallest and largest value.
    lapse
        Share of the tests with other reasons for their outcome.
    tests
        A table in the folder with the columns `motion` and `overturned`, or "module:function" that returns motions and
        outcomes, or None where its data are not at hand.
    same_outcome, tolerance
        Fraction of the tests with the outcome that the model calls more probable, and how far it may differ.
    tail
        Time after the end of each motion in which the object may still fall [s].
    """

    folder: Path
    title: str
    source: str
    model: Model
    numbers: Mapping[str, tuple[float, float, float, float]]
    lapse: float
    tests: str
    same_outcome: float
    tolerance: float
    tail: float = 2.0

    @classmethod
    def read(cls, folder: Path) -> "MeasuredObject":
        """Read the description of a folder."""
        given = tomllib.loads((folder / "object.toml").read_text("utf-8"))
        case = {name: given.pop(name) for name in ("column", "model")}
        model = SimulationConfig.parse(case | {"motion": _ANY_MOTION}).build().model
        given["numbers"] = {name: (one["mean"], one["spread"], *one["range"]) for name, one in given["numbers"].items()}
        return cls(folder=folder, model=model, **given)

    def outcomes(self) -> Tests | None:
        """Return the motions and outcomes of the tests; None if they are not at hand."""
        if ":" in self.tests:
            module, _, function = self.tests.partition(":")
            found: Tests | None = getattr(importlib.import_module(module), function)(self.folder.name)
            return found
        with (self.folder / self.tests).open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        motions = [sb.read_record(self.folder / row["motion"]) for row in rows]
        return motions, np.array([row["overturned"] == "1" for row in rows])

    def probabilities(self, motions: Sequence[BaseMotion]) -> npt.NDArray[np.float64]:
        """Return the probability that the object overturns under each motion, shape (n,)."""
        shares = qmc.Sobol(len(self.numbers), rng=np.random.default_rng(_SEED)).random(_DRAWS).T
        drawn: dict[str, Any] = {}
        for share, (name, (mean, spread, low, high)) in zip(shares, self.numbers.items(), strict=True):
            drawn[name] = truncnorm.ppf(share, (low - mean) / spread, (high - mean) / spread, loc=mean, scale=spread)
        fell = np.empty(len(motions))
        for place, motion in enumerate(motions):
            length = motion.duration + self.tail
            runs = sb.simulate_ensemble(self.model, motion, duration=length, parameters=drawn, progress=False)
            fell[place] = np.mean(runs["outcome"].values == sb.Outcome.OVERTURNED)
        return 0.5 * self.lapse + (1.0 - self.lapse) * fell

    def finding(self) -> Finding | None:
        """Compare the fraction of tests with the measured outcome with the expected one; None without data."""
        known = self.outcomes()
        if known is None:
            return None
        motions, overturned = known
        found = scores(self.probabilities(motions), overturned)
        return Finding(
            source=self.source,
            compared=f"{self.title}: fraction of {len(overturned)} tests with the measured outcome; "
            "theirs of the version that learnt its numbers",
            theirs=self.same_outcome,
            ours=found["same_outcome"],
            kind=Kind.REGRESSION,
            scale=1.0,
            allowed=self.tolerance,
            remark=f"Brier score {found['brier']:.3f}",
        )


# A description of a run needs a motion; those of the tests replace it.
_ANY_MOTION = {"kind": "one_sine", "acceleration": 1.0, "angular_frequency": 6.0}


def objects(folder: Path = FOLDER) -> list[MeasuredObject]:
    """Return the measured objects by the names of their folders."""
    return [MeasuredObject.read(path.parent) for path in sorted(folder.glob("*/object.toml"))]


def findings() -> Iterator[Finding]:
    """Yield the comparison of each object whose data are at hand."""
    for one in objects():
        found = one.finding()
        if found is None:
            print(f"{one.title}: left out; its page says where to get the data")
        else:
            yield found
