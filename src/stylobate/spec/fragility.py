"""The description of a fragility: records, their scales, uncertain properties, how it is fitted, and the hazard."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field

from stylobate.errors import (
    FileError,
    ParameterError,
    require_finite,
    require_not_negative,
    require_positive,
    require_whole,
)
from stylobate.models import Model
from stylobate.motions import Record
from stylobate.spec.description import Description, built
from stylobate.spec.many_runs import ManyRuns
from stylobate.spec.records import RecordsDescription
from stylobate.spec.spectrum import Scales


class Lognormal(Description):
    """The logarithm is normal with this `dispersion`; `median` by default as the model has it."""

    kind: Literal["lognormal"]
    dispersion: float
    median: float | None = None


class Normal(Description):
    """Normal with this standard `deviation`, cut at `least` and `most`; `mean` by default as the model has it."""

    kind: Literal["normal"]
    deviation: float
    mean: float | None = None
    least: float = 0.0
    most: float | None = None


class Uniform(Description):
    """Even from `least` to `most`."""

    kind: Literal["uniform"]
    least: float
    most: float


AnySpread = Annotated[Lognormal | Normal | Uniform, Field(discriminator="kind")]


class Spectral(Description):
    """Spectral acceleration at `period` [s]."""

    period: float
    damping: float = 0.05


class Hazard(Description):
    """Annual `rate` at which each `intensity` is exceeded; or a `file` of two columns, these two."""

    intensity: tuple[float, ...] = ()
    rate: tuple[float, ...] = ()
    file: str | None = None

    def points(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return intensities and rates.

        Raises
        ------
        FileError
            If the file cannot be read.
        ParameterError
            If they are given in two ways or none.
        """
        if (self.file is None) == (not self.intensity and not self.rate):
            message = "intensity and rate must be given, or a file of them, one of both"
            raise ParameterError(message)
        return (self.intensity, self.rate) if self.file is None else _columns(self.file)


class Fragility(Description):
    """The `scales` of the records and what else varies; how runs are counted and fitted; the hazard."""

    scales: Scales
    intensity: str | Spectral = "peak ground acceleration"
    rotations: tuple[float, ...] = (0.0,)
    vertical: tuple[bool, ...] = (True,)
    tail: float | None = None
    samples: int = 0
    spreads: dict[str, AnySpread] = Field(default_factory=dict)
    seed: int = 0
    counting: Literal["as computed", "first"] = "as computed"
    confidence: float = 0.95
    resamples: int = 1000
    hazard: Hazard | None = None
    years: float = 50.0


@dataclass(frozen=True, slots=True)
class FragilitySetup:
    """What a description of a fragility describes.

    Parameters
    ----------
    model, records
        The column, and the records by name.
    table
        What is varied and how it is fitted, as described.
    scales
        Factors of the records.
    hazard
        Intensities and annual rates, or None.
    options
        Arguments that all runs share.
    """

    model: Model
    records: Mapping[str, Record]
    table: Fragility
    scales: tuple[float, ...]
    hazard: tuple[tuple[float, ...], tuple[float, ...]] | None
    options: dict[str, Any]


class FragilityDescription(ManyRuns):
    """A fragility: `column`, `model`, `records`, the arguments of a run, and `fragility`."""

    records: RecordsDescription
    fragility: Fragility

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Return the description of these `values`; `records` may be the folder alone."""
        records = values.get("records")
        if isinstance(records, (str, list, tuple)):
            values = {**values, "records": {"source": records}}
        return super().parse(values)

    def build(self, *, read: bool = True) -> FragilitySetup:
        """Return model, records, and what is described of them; without records unless these are to be `read`.

        Raises
        ------
        DescriptionError
            With one line for each part that cannot be.
        """
        table, problems = self.fragility, self._problems()
        scales = built("fragility.scales", table.scales.build, problems)
        hazard = None if table.hazard is None else built("fragility.hazard", table.hazard.points, problems)
        model, _, options = self.common(problems)
        for name in ("duration", "periods", "tilt_limit"):
            del options[name]
        records = self.records.build() if read else {}
        assert scales is not None
        return FragilitySetup(model, records, table, tuple(scales.tolist()), hazard, options)

    def _problems(self) -> list[str]:
        table = self.fragility
        problems = [
            f"{name} is not known of a fragility: runs last as their records and fragility.tail"
            for name in ("duration", "periods")
            if getattr(self, name) is not None
        ]
        if self.tilt_limit is not None:
            problems.append("tilt_limit must be left out: a run stopped at it is not known to overturn")
        if bool(table.samples) != bool(table.spreads):
            problems.append("fragility.samples and fragility.spreads go together; give both or none of them")
        checks = {
            "samples": lambda: require_whole("samples", table.samples, least=0),
            "seed": lambda: require_whole("seed", table.seed, least=0),
            "resamples": lambda: require_whole("resamples", table.resamples, least=0),
            "years": lambda: require_positive("years", table.years, "a"),
            "tail": lambda: require_not_negative("tail", table.tail or 0.0, "s"),
            "rotations": lambda: [require_finite("rotations", angle, "rad") for angle in table.rotations],
        }
        for name, check in checks.items():
            built(f"fragility.{name}", check, problems)
        return problems


def _columns(path: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        message = f"cannot read {path}: {getattr(error, 'strerror', None) or error}"
        raise FileError(message) from None
    numbers = [_pair(path, place, line) for place, line in enumerate(lines, start=1) if _holds_numbers(line)]
    if not numbers:
        message = f"{path} holds no numbers: two columns are needed, intensity and annual rate"
        raise FileError(message)
    x, rate = np.array(numbers).T
    return tuple(x.tolist()), tuple(rate.tolist())


def _holds_numbers(line: str) -> bool:
    """Return whether a line is neither empty nor a comment nor a header."""
    text = line.strip()
    return bool(text) and (text[0].isdigit() or text[0] in "+-.")


def _pair(path: str, place: int, line: str) -> tuple[float, float]:
    parts = line.replace(",", " ").replace(";", " ").split()
    try:
        intensity, rate = (float(part) for part in parts)
    except ValueError:
        message = f"{path}, line {place}: two numbers are needed, intensity and annual rate, got {line.strip()!r}"
        raise FileError(message) from None
    return intensity, rate
