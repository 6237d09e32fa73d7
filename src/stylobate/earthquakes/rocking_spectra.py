"""The cases that all spectra run; and peak tilts and peak tilt rates of runs, which make a rocking spectrum.

`stylobate.earthquakes.spectrum_study` declares the studies.
"""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Self, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.combined import members_of
from stylobate.base_motions.declared import frequency_of
from stylobate.engine.parameters import own_numbers, with_parameters
from stylobate.errors import ParameterError, require_positive
from stylobate.models import Model
from stylobate.parameter_quantities import attributes_of
from stylobate.provenance import provenance_of_run
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.run_arguments import RunOptions
from stylobate.studies.checks import remark_on_lengths, require_values
from stylobate.studies.maps.uncertainty_exponent import overturned_or_not
from stylobate.studies.study import RunsOfOwnLength, options_of
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.designs import OF_A_RUN, Floats, check_quantities, checked_values

Integers = npt.NDArray[np.int64]

_TAIL = 40.0
"""Free-vibration time after the end of the base motion, over 1/p.

Near the edge of an overturning interval a column stays near its unstable equilibrium, and leaves it as e^(pt). After
20/p it is still near within about 10⁻⁶ of the edge; after 40/p, within 10⁻¹².
"""

_MOTION = "motion"
# Quantities that normalize a spectrum, for each case.
_NUMBERS: Mapping[str, Mapping[str, str]] = {
    "frequency_parameter": {"units": "rad s-1", "long_name": "frequency parameter p"},
    "tipping_angle": {"units": "rad", "long_name": "tipping angle α_c"},
    "rim_distance": {"units": "m", "long_name": "distance R of the centre of mass from the rim"},
    "acceleration_ratio": {"units": "1", "long_name": "peak base acceleration / (c g), at scale 1"},
    "frequency_ratio": {"units": "1", "long_name": "angular frequency of the base motion / p"},
    "motion_end": {"units": "s", "long_name": "end of the base motion"},
}


@dataclass(frozen=True, slots=True, eq=False)
class Cases:
    """Model, base motion and parameter values of the runs of a spectrum.

    `axes` has the requested parameters with their values; `values` has the parameters that ensembles vary and `numbers`
    the normalizing quantities, both flat over the cases.
    """

    model: Model
    motion: BaseMotion
    axes: Mapping[str, Floats]
    values: Mapping[str, Floats]
    numbers: Mapping[str, Floats]

    @classmethod
    def of(
        cls, model: Model, motion: BaseMotion, over: Mapping[str, npt.ArrayLike] | None, *, scaled: bool = False
    ) -> Self:
        """Create the cases `over` these values.

        Parameters
        ----------
        scaled
            Whether `over` may name the scale.

        Raises
        ------
        ParameterError
            If a name cannot vary here, or has no values.
        UnsupportedError
            If the motion lacks a number that is to vary.
        """
        if not isinstance(model, Model):
            raise ParameterError(f"model must be a model such as Slender(column), got {model!r}")
        if not isinstance(motion, BaseMotion):
            raise ParameterError(f"motion must be a base motion such as Pulse.one_sine(...), got {motion!r}")
        over = _checked_names(model, motion, {} if over is None else over, scaled=scaled)
        own = own_numbers(model, motion)
        axes = {name: checked_values("over", name, values, own) for name, values in over.items()}
        meshes = np.meshgrid(*axes.values(), indexing="ij") if axes else []
        values = {name: mesh.ravel() for name, mesh in zip(axes, meshes, strict=True)}
        return cls(model, motion, axes, values, _numbers(model, motion, values))

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes."""
        return tuple(axis.size for axis in self.axes.values())

    @property
    def count(self) -> int:
        """Number of cases."""
        return math.prod(self.shape)

    def durations(self, duration: float | None, tail: float | None) -> Floats:
        """Return the duration of each case [s]: to `tail` [s] after the end of its motion, or the given `duration`.

        Raises
        ------
        ParameterError
            If an argument is not positive, or the motion never ends and there is no `duration`.
        """
        if duration is not None:
            return np.full(self.count, require_positive("duration", duration, "s"))
        usual = _TAIL / self.numbers["frequency_parameter"]
        ends = self.numbers["motion_end"] + (usual if tail is None else require_positive("tail", tail, "s"))
        if not np.all(np.isfinite(ends)):
            raise ParameterError(
                f"duration must be given, in s, for a base motion that never ends; got None with {self.motion!r}"
            )
        return ends

    def sweep(self, case: Integers, durations: Floats, scale: Floats | None, **options: Unpack[RunOptions]) -> Sweep:
        """Build the sweep of these cases, each with its duration and, if given, its `scale`."""
        at = {name: values[case] for name, values in self.values.items()}
        scaled = {} if scale is None else {"scale": scale}
        return Sweep.points(self.model, self.motion, at={**at, **scaled, "duration": durations[case]}, **options)

    def over_axes(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Reshape the first dimension of `values` from cases to the axes."""
        return values.reshape(self.shape + values.shape[1:])

    def coordinates(self) -> dict[str, xr.Variable]:
        """Return the axes, the normalizing quantities over them, and the names of motions."""
        dims = tuple(self.axes)
        found = {name: xr.Variable((name,), axis, attributes_of(name)) for name, axis in self.axes.items()}
        for name, attributes in _NUMBERS.items():
            if np.all(np.isfinite(self.numbers[name])):
                found[name] = xr.Variable(dims, self.over_axes(self.numbers[name]), dict(attributes))
        if _MOTION in self.axes:
            found["motion_name"] = xr.Variable((_MOTION,), _names(self.motion, self.axes[_MOTION]))
        return found


def _checked_names(
    model: Model, motion: BaseMotion, over: Mapping[str, npt.ArrayLike], *, scaled: bool
) -> Mapping[str, npt.ArrayLike]:
    if not isinstance(over, Mapping):
        raise ParameterError(f'over must name parameters with their values, such as {{"size": […]}}; got {over!r}')
    refused = {"duration": "give duration or tail", **({} if scaled else {"scale": "give scales"})}
    for name, remedy in refused.items():
        if name in over:
            raise ParameterError(f"over cannot name {name}: {remedy}")
    if over:
        check_quantities("over", model, over, motion)
    require_values("over", over)
    remark_on_lengths("over", over)
    return over


def _numbers(model: Model, motion: BaseMotion, values: Mapping[str, Floats]) -> dict[str, Floats]:
    rows = []
    count = next(iter(values.values())).size if values else 1
    for case in range(count):
        chosen = {name: float(array[case]) for name, array in values.items() if name not in OF_A_RUN}
        changed, moved = with_parameters(model, motion, **chosen)
        column = changed.column
        rows.append(
            (
                column.frequency_parameter,
                column.tipping_angle,
                column.rim_distance,
                moved.peak_horizontal(0.0) / (column.gravity * column.slenderness),
                frequency_of(moved) / column.frequency_parameter,
                moved.duration,
            )
        )
    return dict(zip(_NUMBERS, np.array(rows).T, strict=True))


def _names(motion: BaseMotion, numbers: Floats) -> list[str]:
    members = members_of(motion)
    return [str(getattr(members[int(number)], "name", "") or f"motion {int(number)}") for number in numbers]


def provenance_of_spectrum(
    cases: Cases, run: RunsOfOwnLength, *, tail: float | None, duration: float | None, **own: float
) -> str:
    """Return model, motion, options and length of the runs, in JSON."""
    chosen: dict[str, Any] = dict(options_of(run))
    chosen["rules"] = asdict(chosen["rules"] or OutcomeRules())
    length = {"tail": tail if tail is None else float(tail)} if duration is None else {"duration": float(duration)}
    return json.dumps({**provenance_of_run(cases.model, cases.motion, **chosen), **length, **own})


# Histories; the result keeps only the peak rate of them.
_HISTORIES = ("sample_time", "sampled_tilt", "sampled_tilt_rate")


def peaks_of_runs(runs: xr.Dataset, cases: Cases, provenance: str) -> xr.Dataset:
    """Make the rocking spectrum of the runs of these cases, which have histories."""
    runs = runs.load()
    dims = tuple(cases.axes)
    safe = overturned_or_not(runs) == 0
    rate = peak_tilt_rate(*(runs[name].to_numpy() for name in _HISTORIES))
    ratios = {
        "peak_tilt_ratio": (runs["peak_tilt"].to_numpy() / cases.numbers["tipping_angle"], "1", "peak tilt / α_c"),
        "peak_rate_ratio": (rate / cases.numbers["frequency_parameter"], "rad", "peak rate of tilt / p"),
    }
    kept = {
        name: xr.Variable((*dims, *value.dims[1:]), cases.over_axes(value.to_numpy()), value.attrs)
        for name, value in runs.drop_vars(_HISTORIES).data_vars.items()
    }
    peaks = {
        name: xr.Variable(
            dims, cases.over_axes(np.where(safe, values, np.nan)), {"units": unit, "long_name": long_name}
        )
        for name, (values, unit, long_name) in ratios.items()
    }
    period = cases.over_axes(2.0 * np.pi / cases.numbers["frequency_parameter"])
    computed = int((runs["outcome"] != NOT_COMPUTED).sum())
    return xr.Dataset(
        {**peaks, **kept, "computed": ((), computed, {"units": "1", "long_name": "runs computed"})},
        coords={
            **cases.coordinates(),
            "rocking_period": xr.Variable(dims, period, {"units": "s", "long_name": "period 2π/p"}),
            "axis": runs["axis"],
        },
        attrs={"kind": "rocking spectrum", "provenance": provenance},
    )


def peak_tilt_rate(time: Floats, tilt: Floats, tilt_rate: Floats) -> Floats:
    """Compute the peak of |d(tilt)/dt| of each run, to second order in the step between samples.

    The tilt rate of a rocking column peaks just before or after it passes the vertical, and has a corner there. So the
    rate is extrapolated to a passage from the samples on both sides of it.

    Parameters
    ----------
    time
        Times of the samples, shape (..., s) [s].
    tilt, tilt_rate
        Shape (..., s, 2) [rad], [rad/s]; NaN outside the run.

    Returns
    -------
    numpy.ndarray
        Shape (...,) [rad/s]; NaN if a run has no samples.
    """
    before = _largest(time, tilt, tilt_rate)
    after = _largest(-time[..., ::-1], tilt[..., ::-1, :], -tilt_rate[..., ::-1, :])
    return np.fmax(before, after)


def _largest(time: Floats, tilt: Floats, tilt_rate: Floats) -> Floats:
    """Return the largest rate of the samples and of the extrapolations from samples before a passage to the passage.

    The square of the rate is extrapolated linearly in the tilt, because the potential energy depends on the tilt.
    """
    square, angle = (tilt_rate**2).sum(axis=-1), np.linalg.norm(tilt, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        until = -(tilt * tilt_rate).sum(axis=-1) / square
        across = tilt[..., 0] * tilt_rate[..., 1] - tilt[..., 1] * tilt_rate[..., 0]
        nearest = np.abs(across) / np.sqrt(square)  # smallest tilt on the tangent of the path
        passed = (until[..., 1:-1] > 0.0) & (until[..., 1:-1] < np.diff(time)[..., 1:])
        passed &= np.diff(angle)[..., :-1] < 0.0
        slope = np.diff(square)[..., :-1] / np.diff(angle)[..., :-1]
        continued = square[..., 1:-1] + slope * (nearest - angle)[..., 1:-1]
    continued = np.where(passed, np.fmax(continued, 0.0), np.nan)
    return np.asarray(np.sqrt(np.fmax.reduce(np.concatenate([square, continued], axis=-1), axis=-1)))
