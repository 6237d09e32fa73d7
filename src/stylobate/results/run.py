"""The result of one run."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy.typing as npt

from stylobate.cards import CardSection, Row, card
from stylobate.equality import ByContent
from stylobate.errors import Outcome, UnsupportedError
from stylobate.results.plain import plain_value
from stylobate.text import four_digits

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_PLAIN = ("decided_at", "uncertain", "planar", "thresholds", "measures", "provenance", "warnings")
"""Fields of a run that are converted to plain Python values."""


EVENT_KINDS = (
    *("uplift", "rest", "overturned", "limit", "lifted", "failed", "impact", "passage"),
    *("slide", "stop", "slip", "reverse", "stick", "lift", "land", "face_impact", "jam"),
)
"""Kinds of events that runs detect by default."""


REPEATING = ("impact", "passage")
"""Kinds of events that occur in every swing."""


@dataclass(frozen=True, slots=True)
class Event:
    """An event of a run: its `kind` and `time` [s].

    Kinds of all models: "uplift" (uplift), "rest", "overturned", "limit", "lifted" and "failed"; "impact", a passage
    through the vertical with energy loss, and "passage", a planar one without. Kinds of models that can slip and fly:
    "slide" and "stop" of the base face; "slip", "reverse" and "stick" of the rim; "lift" and "land"; "face_impact", an
    impact of the base face; "jam", dynamic jamming. An event of an `EventFunction` has the name of the function.
    """

    kind: str
    time: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "time", plain_value(self.time))

    @property
    def repeats(self) -> bool:
        """Whether the event occurs in every swing (impact or passage); figures and summaries leave it out."""
        return self.kind in REPEATING


class _Data:
    """The field `data` of a run: a Dataset, or the function that makes it at first use."""

    def __get__(self, run: "Run | None", owner: type | None = None) -> "xr.Dataset":
        if run is None:  # dataclasses asks the class for a default, which does not exist
            raise AttributeError
        data: xr.Dataset | Callable[[], xr.Dataset] = vars(run)["data"]
        if callable(data):
            data = vars(run)["data"] = data()
        return data

    def __set__(self, run: "Run", data: "xr.Dataset | Callable[[], xr.Dataset]") -> None:
        vars(run)["data"] = data


@dataclass(frozen=True, kw_only=True, eq=False)
class Run(ByContent):
    """Result of one run: outcome, history, events and provenance.

    Attributes
    ----------
    outcome
        The outcome.
    reason
        One line that states how the outcome was decided.
    decided_at
        Time of the decision [s].
    uncertain
        Whether the outcome is numerically uncertain: rounding or the rest threshold could alter it. So it is after a
        three-dimensional passage within 1e-8 c of the vertical, of a run that failed or reached its step limit, and of
        a repeated run with another outcome (see `recheck` of `simulate`). Small variations of the case are not tried:
        `stylobate.verdict` tries them.
    planar
        Whether the run was integrated in one vertical plane, which contains initial state and base motion.
    data
        Dataset over `time` [s]: `tilt` and `tilt_rate` (time, axis), `amplitude`, `azimuth`, `rolling_rate`,
        `resting`, the base motion, and other outputs of the model; units in the attributes.
    events
        Events in the order of time.
    thresholds
        Numbers that decided the outcome, by name.
    measures
        Summary numbers, by name: maximum and minimum tilt, turns of the contact point, steps, impacts, maximum contact
        demand; for periodic base motion the mean rolling rate and the repetition of the last periods.
    provenance
        All inputs that repeat the run: version, column, model, base motion, initial state, tolerances.
    warnings
        A line for each contact demand that a real contact could not supply: tension (lift-off), or more friction than
        a given friction coefficient. For models that can slip, a line for a knife edge: landings at a tilt of exactly
        0, or a friction coefficient equal to the slenderness.
    """

    outcome: Outcome
    reason: str
    decided_at: float
    uncertain: bool
    planar: bool
    if TYPE_CHECKING:
        data: _Data = _Data()
    else:
        data: "xr.Dataset" = _Data()
    events: tuple[Event, ...]
    thresholds: Mapping[str, float]
    measures: Mapping[str, float]
    provenance: Mapping[str, Any]
    warnings: tuple[str, ...] = ()
    sampler: Callable[[npt.ArrayLike], "xr.Dataset"] | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        for name in _PLAIN:
            object.__setattr__(self, name, plain_value(getattr(self, name)))

    def sample(self, time: npt.ArrayLike) -> "xr.Dataset":
        """Compute the data at other times [s], from the dense output of the integrator.

        Raises
        ------
        UnsupportedError
            If the result was loaded from a file: files keep samples only.
        ParameterError
            If a time lies outside the run.
        """
        if self.sampler is None:
            raise UnsupportedError(
                "sample needs a run made in this process: a loaded result has the samples in .data only"
            )
        return self.sampler(time)

    def to_dataframe(self) -> "pd.DataFrame":
        """Convert the samples to a table in pandas, with one row per sample; see `results.to_dataframe`."""
        from stylobate.results.tables import to_dataframe

        return to_dataframe(self.data)

    def save(self, path: str | Path) -> Path:
        """Write the run to a netCDF file at `path`, with its provenance; `stylobate.load` reads it again."""
        from stylobate.results.run_file import as_dataset
        from stylobate.results.storage import write_netcdf

        return write_netcdf(as_dataset(self), Path(path))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read the run saved in the netCDF file `path`; `stylobate.load` reads any result.

        Raises
        ------
        FileError
            If the file cannot be read or holds no saved run.
        """
        from stylobate.results.run_file import fields_of

        fields = fields_of(path)
        fields["events"] = tuple(Event(kind, time) for kind, time in fields["events"])
        return cls(**fields | {"warnings": tuple(fields.get("warnings", ()))})

    def __reduce__(self) -> tuple[Any, ...]:
        # The dense output cannot be pickled: a run in another process has its samples only.
        kept = {name: value for name, value in vars(self).items() if name != "sampler"} | {"data": self.data}
        return partial(Run, **kept), ()

    def __copy__(self) -> Self:
        return replace(self)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return replace(self, data=self.data.copy(deep=True))  # with the dense output, which nothing changes

    def __repr__(self) -> str:
        more = f" (and {len(self.warnings) - 1} more)" if len(self.warnings) > 1 else ""
        warning = f"; warning: {self.warnings[0]}{more}" if self.warnings else ""
        return f"Run({self.outcome.name} at {four_digits(self.decided_at)} s: {self.reason}{warning})"

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        from stylobate.results.run_rows import measure_rows, outcome_of, reason_rows, threshold_rows

        flags = [(name, "yes" if getattr(self, name) else "no") for name in ("uncertain", "planar")]
        rows = [("outcome", outcome_of(self)), *reason_rows(self), *flags]
        warnings = [("", warning) for warning in self.warnings]
        named = {"": rows, "measures": measure_rows(self), "warnings": warnings, "thresholds": threshold_rows(self)}
        *shown, folded = (CardSection(heading, [Row(*row) for row in rows]) for heading, rows in named.items())
        return card("Run", shown, folded)
