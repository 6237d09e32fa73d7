"""Verdict on a case from small variations, and the remarks on few records and on the damping that a verdict assumes."""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, Self

from stylobate.cards import CardSection, Row, card
from stylobate.equality import ByContent
from stylobate.errors import MOST_RUNS, FileError, Named, ParameterError, require_whole
from stylobate.results.plain import ByName, plain_value
from stylobate.text import plural

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from stylobate.column import Column

FEW_RECORDS = 20
"""Minimum number of records: with fewer, the measured coverage of dispersion intervals is well below nominal."""


def few_records(count: int) -> str:
    """Return the remark on a fragility from `count` records; empty for enough records.

    >>> few_records(12)
    '12 records: with fewer than 20 the interval of the dispersion is too narrow'
    >>> few_records(20)
    ''
    """
    if count >= FEW_RECORDS:
        return ""
    return f"{plural(count, 'record')}: with fewer than {FEW_RECORDS} the interval of the dispersion is too narrow"


AMPLITUDES = {0.25: "¼", 0.5: "½", 0.75: "¾"}
"""Peak tilts of the yardstick, in tipping angles α_c."""

# Parameters that a planar cycle does not distinguish from damping alone; others lose energy beside it.
_COMPARED = {"damping", "spin_damping"}


def damping_yardstick(column: "Column") -> dict[float, float]:
    """Compute Housner's damping of a column at each of the `AMPLITUDES`; it falls as they rise."""
    return {amplitude: column.housner_damping(amplitude) for amplitude in AMPLITUDES}


def yardstick_text(values: Iterable[float]) -> str:
    """Write the values of Housner's damping at the `AMPLITUDES` in a line.

    >>> yardstick_text([0.1173, 0.0802, 0.0641])
    'η = 0.12, 0.08, 0.064 at a peak tilt of ¼, ½, ¾ α_c'
    """
    written = ", ".join(f"{value:.2g}" for value in values)
    return f"η = {written} at a peak tilt of {', '.join(AMPLITUDES.values())} α_c"


def side_of_yardstick(
    column: "Column", levels: Iterable[Mapping[str, float]]
) -> Literal["below", "above", "among", "not compared"]:
    """Determine on which side of Housner's damping a set of levels of dissipation lies.

    Parameters
    ----------
    column
        The column.
    levels
        Dissipation parameters of each level, by name.

    Returns
    -------
    str
        "below" if the damping of every level is below the yardstick at all amplitudes, "above" if it is above, "among"
        otherwise; "not compared" if a level has no damping, or loses energy by rolling resistance or restitution too.
    """
    given = list(levels)
    if not given or any("damping" not in one or not _COMPARED.issuperset(one) for one in given):
        return "not compared"
    dampings, yardstick = [one["damping"] for one in given], damping_yardstick(column).values()
    if max(dampings) < min(yardstick):
        return "below"
    return "above" if min(dampings) > max(yardstick) else "among"


KIND = "verdict"
"""Value of the attribute `kind` of the data of a verdict."""


CONTACT_LAW = "contact_law"
"""Name of the variation between models."""

LABELS: Mapping[str, str] = MappingProxyType(
    {
        CONTACT_LAW: "contact law",
        "scale": "scale of the record",
        "clock": "clock of the record",
        "lowpass": "low-pass of the record",
        "rotation": "direction of the record",
        "slope_x": "slope of the base along x",
        "slope_y": "slope of the base along y",
        "transverse_inertia": "moment of inertia across the axis",
        "axial_inertia": "moment of inertia about the axis",
        "start_x": "disturbance along x",
        "start_y": "disturbance along y",
        "tolerance": "tolerance",
    }
)
"""Names of variations in figures and sentences; another variation has the name of its parameter."""


class VerdictWord(Named, Enum):
    """The word of a verdict."""

    OVERTURNS = "overturns"
    STANDS = "stands"
    UNDECIDED = "undecided"


CLEAR = 0.05
"""Largest share of variations that may contradict the word of a verdict."""


def word_of(low: float, high: float) -> VerdictWord:
    """Return the word for a share of overturning whose confidence interval is `low` to `high`.

    The column stands if the whole interval lies below `CLEAR`, and overturns if it lies above 1 − `CLEAR`. Otherwise
    the case is undecided: small changes that measurements cannot exclude alter the outcome.
    """
    if high <= CLEAR:
        return VerdictWord.STANDS
    return VerdictWord.OVERTURNS if low >= 1.0 - CLEAR else VerdictWord.UNDECIDED


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class Verdict(ByContent):
    """The verdict on a case: a column under a base motion, with everything that is not known exactly.

    Attributes
    ----------
    data
        Dataset of kind "verdict", as `stylobate.verdict` describes it.
    """

    data: "xr.Dataset"

    @property
    def runs(self) -> int:
        """Number of variations."""
        return int(self.data.sizes["run"])

    @property
    def share(self) -> float:
        """Share of the variations that overturn the column."""
        return float(self.data["share"])

    @property
    def interval(self) -> tuple[float, float]:
        """Confidence interval of the share; runs without a decision count on both sides."""
        return float(self.data["share_low"]), float(self.data["share_high"])

    @property
    def confidence(self) -> float:
        """Confidence level of the interval."""
        return float(self.data.attrs["confidence"])

    @property
    def word(self) -> VerdictWord:
        """The word that follows from the interval; see `word_of`."""
        return word_of(*self.interval)

    @property
    def share_by_model(self) -> Mapping[str, float]:
        """Share of overturning of each contact law, by the kind of its model; NaN if no variation has it."""
        names, shares = self.data["model"].to_numpy(), self.data["model_share"].to_numpy()
        return ByName({str(name): float(share) for name, share in zip(names, shares, strict=True)})

    @property
    def deciding(self) -> str:
        """The variation that decides most; empty if none can be distinguished from chance."""
        return str(self.data.attrs["deciding"])

    @property
    def provenance(self) -> Mapping[str, Any]:
        """All inputs that repeat the verdict."""
        found: Mapping[str, Any] = plain_value(json.loads(self.data.attrs["provenance"]))
        return found

    def __str__(self) -> str:
        """Return the verdict in one line."""
        low, high = self.interval
        unknown = float((self.data["overturned"] < 0).mean())
        undecided = f", {percent(unknown)} are not decided" if unknown else ""
        return (
            f"{self.word.value}: {percent(self.share)} of {self.runs} variations overturn{undecided} "
            f"({percent(self.confidence)} sampling interval {interval_text(low, high)})"
        )

    def __repr__(self) -> str:
        return f"Verdict({self})"

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        rows = [
            Row("verdict", self.word.value),
            Row("share of overturning", f"{percent(self.share)} of {plural(self.runs, 'variation')}"),
            Row(f"{percent(self.confidence)} sampling interval", interval_text(*self.interval)),
            Row(
                "decided most by",
                LABELS.get(self.deciding, self.deciding.replace("_", " ")) or "none distinguished from chance",
            ),
        ]
        of_models = (self.data[f"model_share{end}"].to_numpy() for end in ("", "_low", "_high"))
        laws = [
            Row(law, f"{percent(share)} ({_ends(low, high)})")
            for law, share, low, high in zip(self.share_by_model, *of_models, strict=True)
        ]
        return card("Verdict", [CardSection("", rows), CardSection("share by contact law, with interval", laws)])

    def to_dataframe(self) -> "pd.DataFrame":
        """Convert the variations to a table in pandas, with one row per variation; see `results.to_dataframe`."""
        from stylobate.results.tables import to_dataframe

        return to_dataframe(self.data)

    def save(self, path: str | Path) -> Path:
        """Write the verdict to a netCDF file at `path`, with its provenance; `stylobate.load` reads it again."""
        from stylobate.results.storage import write_netcdf

        return write_netcdf(self.data, path)

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read the verdict saved in the netCDF file `path`.

        Raises
        ------
        FileError
            If the file cannot be read or holds no verdict.
        """
        from stylobate.results.storage import read_dataset

        data = read_dataset(path)
        if data.attrs.get("kind") != KIND:
            raise FileError(
                f"{path} holds no verdict (got the kind {data.attrs.get('kind')!r}). stylobate.load reads any result"
            )
        return cls(data)


# Shares nearer to 0 or 1 than this have decimals; intervals that end nearer to a limit of the words have one or two.
_FEW, _NEAR, _TOUCHING = 0.01, 0.015, 5e-4


def percent(share: float) -> str:
    """Format a share in percent, in whole numbers; near 0 and 1 with decimals, because a few runs differ from none.

    NaN, the share of no runs, is a dash.

    >>> percent(0.356), percent(1.0 / 300.0), percent(0.99996)
    ('36 %', '0.3 %', '99.996 %')
    """
    return "–" if math.isnan(share) else f"{_number(share, 0)} %"


def interval_text(low: float, high: float) -> str:
    """Format the interval of a share; if it ends near a limit of the words, with a decimal and the rule.

    >>> interval_text(0.33, 0.38)
    '33 to 38 %'
    >>> interval_text(0.021, 0.052)
    '2.1 to 5.2 %; stands if below 5 %'
    """
    gap_below, gap_above = abs(high - CLEAR), abs(low - (1.0 - CLEAR))
    decimals = 2 if min(gap_below, gap_above) < _TOUCHING else 1
    if gap_below < _NEAR:
        return f"{_ends(low, high, decimals)}; stands if below {percent(CLEAR)}"
    if gap_above < _NEAR:
        return f"{_ends(low, high, decimals)}; overturns if above {percent(1.0 - CLEAR)}"
    return _ends(low, high)


def _ends(low: float, high: float, decimals: int = 0) -> str:
    return f"{_number(low, decimals)} to {_number(high, decimals)} %"


def _number(share: float, decimals: int) -> str:
    """Return a share in percent with `decimals`, or as many as distinguish it from 0 and 100."""
    rest = min(share, 1.0 - share)
    if rest <= 0.0:
        return f"{100.0 * share:.0f}"
    few = math.ceil(-math.log10(100.0 * rest)) if rest < _FEW else 0
    return f"{100.0 * share:.{max(decimals, few)}f}"


def require_variations(count: int) -> int:
    """Return the number of variations of each verdict of an assessment: 0 for none, else 2 or more.

    Raises
    ------
    ParameterError
        If `count` is another number.
    """
    checked = require_whole("variations", count, least=0, most=MOST_RUNS)
    if checked == 1:
        raise ParameterError("variations: must be 0 or at least 2 (got 1). Pass a few hundred, or 0 for none.")
    return checked
