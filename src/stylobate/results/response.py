"""The result of one run."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy.typing as npt

from stylobate.errors import Outcome, UnsupportedError
from stylobate.results.plain import plain_value
from stylobate.results.samples import Samples

if TYPE_CHECKING:
    import xarray as xr

_PLAIN = ("decided_at", "uncertain", "planar", "thresholds", "measures", "provenance", "warnings")
"""Fields of a response that hold plain Python values, whatever computed them."""


EVENT_KINDS = (
    *("release", "rest", "overturned", "limit", "lifted", "failed", "impact", "passage"),
    *("slide", "stop", "slip", "reverse", "stick", "lift", "land", "stroke", "jam"),
)
"""Kinds of events that runs find without being asked."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened in a run: its `kind` and `time` [s].

    Kinds are "release", "rest", "overturned", "limit", "lifted" and "failed"; "impact", where a passage of the upright
    costs energy, and "passage" for one in a plane that costs none; of models that can slip and fly also
    "slide" and "stop" of the base, "slip", "reverse" and "stick" of the rim, "lift", "land", "stroke" and "jam".
    An event of a user's own `EventFunction` has its name as the kind.
    """

    kind: str
    time: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "time", plain_value(self.time))

    @property
    def repeats(self) -> bool:
        """Whether it belongs to every swing, an impact or a passage, and is left out of pictures and summaries."""
        return self.kind in ("impact", "passage")


class _Data:
    """The field `data` of a response: a Dataset, made of its samples when it is first used."""

    def __get__(self, response: "Response | None", owner: type | None = None) -> "xr.Dataset":
        if response is None:  # dataclasses asks the class for a default: there is none
            raise AttributeError
        data: xr.Dataset | Samples = vars(response)["data"]
        if isinstance(data, Samples):
            data = vars(response)["data"] = data.as_dataset()
        return data

    def __set__(self, response: "Response", data: "xr.Dataset | Samples") -> None:
        vars(response)["data"] = data


@dataclass(frozen=True, kw_only=True)
class Response:
    """The motion of one column: its outcome and its history.

    Attributes
    ----------
    outcome
        The outcome.
    reason
        One line that says how the outcome was decided.
    decided_at
        Time at which it was decided [s].
    uncertain
        Whether a small change could alter the outcome: a passage within 1e-8 c of the upright out of a plane, or a
        run cut short by its step limit.
    planar
        Whether the motion was integrated in one vertical plane, because start and base motion lie in it.
    data
        Dataset over `time` [s]: `tilt` and `tilt_rate` (time, axis), `amplitude`, `azimuth`, `rolling_rate`,
        `resting`, the base motion, and what else the model gives; units in the attributes.
    events
        What happened when.
    thresholds
        The numbers that decided, by name.
    measures
        Summary numbers, by name: largest and least tilt, turns of the contact point, steps, impacts, and for periodic
        base motion the mean rolling rate and the repetition of the last periods; largest demands on the contact.
    provenance
        Everything needed to run it again: version, column, model, motion, start, tolerances.
    warnings
        A line for each thing that the contact would not have borne although the model assumes it: lifting off, and
        slipping where a friction coefficient is given.
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
        """Return the data at other times [s], from the integrator's dense output.

        Raises
        ------
        UnsupportedError
            If this result was loaded from a file, which keeps samples only.
        ParameterError
            If a time lies outside the run.
        """
        if self.sampler is None:
            message = "sample needs a run made in this process: a loaded result has the samples in .data only"
            raise UnsupportedError(message)
        return self.sampler(time)

    def save(self, path: str | Path) -> Path:
        """Write the run to a netCDF file at `path`, with its provenance; `stylobate.load` reads it again."""
        from stylobate.results.run_file import as_dataset  # noqa: PLC0415  heavy imports wait until they are needed
        from stylobate.results.storage import write_netcdf  # noqa: PLC0415

        return write_netcdf(as_dataset(self), Path(path))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read the run saved in the netCDF file `path`; `stylobate.load` reads any result.

        Raises
        ------
        FileError
            If the file cannot be read or holds no saved run.
        """
        from stylobate.results.run_file import fields_of  # noqa: PLC0415

        fields = fields_of(path)
        fields["events"] = tuple(Event(kind, time) for kind, time in fields["events"])
        return cls(**fields | {"warnings": tuple(fields.get("warnings", ()))})

    def __reduce__(self) -> tuple[Any, ...]:
        # The integrator's dense output stays behind: a run sent to another process has its samples only.
        kept = {name: value for name, value in vars(self).items() if name != "sampler"}
        return partial(Response, **kept), ()

    def __repr__(self) -> str:
        return f"Response({self.outcome.name} at {self.decided_at:.6g} s: {self.reason})"
