"""Planar (Housner) and three-dimensional rocking compared by record: overturning, and the ratio of peak tilts."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.base import Components, Direction
from stylobate.base_motions.combined import Transformed
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.incremental import incremental_dynamic_analysis
from stylobate.earthquakes.intensities import Intensity, SpectralAcceleration
from stylobate.earthquakes.study_inputs import Records, named_records
from stylobate.errors import ParameterError, UnsupportedError, require_finite
from stylobate.models import Model, PlanarRocking
from stylobate.progress import Progress, Report, report_of, shows_progress
from stylobate.run_arguments import RunOptions
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.designs import Floats, checked_values

_AXES = (0.0, 0.5 * math.pi)
"""The directions of the two horizontal components [rad]."""

# Minimum number of records for a bias: one record has no scatter.
_LEAST = 2


@shows_progress("planar comparison")
def planar_bias(
    model: Model,
    records: Records,
    *,
    scales: npt.ArrayLike,
    directions: Sequence[float] = _AXES,
    planar: PlanarRocking | None = None,
    tail: float | None = None,
    intensity: str | Intensity | SpectralAcceleration = Intensity.PEAK_ACCELERATION,
    least_ratio: float = 1e-3,
    executor: Executor | None = None,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Compare Housner's planar column under each horizontal component with the three-dimensional column.

    The component along one direction and the vertical component act on the planar column; the worst of several
    directions counts, as in practice. The whole record acts on the three-dimensional column. For a comparison with
    equal dissipation pass `planar=PlanarRocking(column, damping=…, restitution=1.0)`.

    Parameters
    ----------
    model
        The three-dimensional column.
    records, scales, tail, intensity
        As for `incremental_dynamic_analysis`.
    directions
        Azimuths of the planes [rad], from x anticlockwise; by default the two components of the records.
    planar
        The planar column; by default the same body with the same `damping` and `rolling_resistance`, and with
        Housner's restitution at impacts, which conserves the angular momentum about the edge on which it lands.
    least_ratio
        Peak tilts below this fraction of α_c do not count as rocking; their ratio is NaN.
    executor, progress, **options
        As for `incremental_dynamic_analysis`.

    Returns
    -------
    xarray.Dataset
        Of kind "planar bias". Over `record`, `direction` and `scale` `planar_outcome` and `planar_tilt_ratio`; over
        `record` and `scale` `outcome` and `tilt_ratio` of the three-dimensional column, `worst_planar_tilt_ratio`, the
        maximum over the directions, `log_ratio` = ln(three-dimensional/worst planar tilt) if both rock and neither
        overturns, and `intensity`. Over `record` `least_overturning` and, over `direction` too,
        `least_planar_overturning`: the smallest of the scales that overturns, NaN if none does;
        `worst_least_planar_overturning`, and `log_capacity_ratio` = ln(smallest scale, three-dimensional/planar). Over
        `scale` the bias: `bias`, the mean of `log_ratio` over the records, its `scatter` (standard deviation),
        `standard_error` (scatter/√records) and `compared`, how many records; `overall_bias`, `overall_scatter`,
        `overall_standard_error` and `overall_compared`, those of the mean of `log_ratio` over the scales of each
        record; `only_space` and `only_planar`, over `scale`, how many records overturn only one of the two. Also
        `capacity_bias`, `capacity_scatter`, `capacity_standard_error`, `capacities_compared` of `log_capacity_ratio`.
        All these are NaN for fewer than two records. If the bias of tilts is positive, or the bias of capacities
        negative, the planar column is unconservative.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    UnsupportedError
        If `model` is planar itself.

    Notes
    -----
    With the same restitution and no other loss, `Wobbling` under a record along one line is the planar column: the
    ratio is 1. In three dimensions a column seldom passes the vertical, so restitution takes hardly any energy from
    it. The bias therefore combines geometry and dissipation, and depends on the dissipation chosen for both.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.solid(radius=0.05, height=5.0, density=2700.0), damping=0.02)
    >>> planar = sb.PlanarRocking(model.column, damping=0.02, restitution=1.0)
    >>> pulse = sb.Pulse.one_sine(acceleration=1.0, angular_frequency=8.0)
    >>> found = planar_bias(model, pulse, scales=[0.25, 0.3], directions=[0.0], planar=planar)
    >>> found["log_ratio"].values.round(3).tolist()    # a slender column, planar motion
    [[0.0, 0.0]]
    """
    if not isinstance(model, Model) or model.planar_only:
        raise UnsupportedError(
            f"model must be three-dimensional to compare with a planar one (got {model!r}). Use one such as Wobbling."
        )
    angles = checked_values("directions", "rotation", directions, scalar=True)
    if not angles.size:
        raise ParameterError("directions must hold at least one angle, got none")
    named = named_records(records)
    common: dict[str, Any] = {"scales": scales, "tail": tail, "executor": executor, **options}
    runs = np.size(scales) * len(named)
    space = incremental_dynamic_analysis(
        model, named, intensity=intensity, progress=part_of(progress, 0, runs * (1 + angles.size)), **common
    )
    lines = {
        f"{name}, direction {place}": in_one_direction(motion, float(angle))
        for name, motion in named.items()
        for place, angle in enumerate(angles)
    }
    flat = incremental_dynamic_analysis(
        planar_of(model) if planar is None else planar,
        lines,
        progress=part_of(progress, runs, runs * (1 + angles.size)),
        **common,
    )
    return _compared(space, _by_direction(flat, list(named), angles), least_ratio)


def part_of(progress: Progress, before: int, total: int) -> Report:
    """Return the function to which a part of a computation reports, after `before` of `total` runs."""
    report = report_of(progress)
    return lambda done, _: report(before + done, total)


def planar_of(model: Model) -> PlanarRocking:
    """Return the planar column of the same body, damping and rolling resistance, with Housner's restitution."""
    return PlanarRocking(
        model.column,
        damping=float(getattr(model, "damping", 0.0)),
        rolling_resistance=float(getattr(model, "rolling_resistance", 0.0)),
    )


def _by_direction(flat: xr.Dataset, names: list[str], angles: Floats) -> xr.Dataset:
    shape = (len(names), angles.size, flat.sizes["scale"])
    dims = ("record", "direction", "scale")
    fallen = flat["reached"].sel({LIMIT_STATE: "overturning"})
    arrays = {"outcome": flat["outcome"], "tilt_ratio": flat["tilt_ratio"], "fallen": fallen}
    about = {"units": "rad", "long_name": "azimuth of the plane"}
    return xr.Dataset(
        {name: (dims, one.to_numpy().reshape(shape), one.attrs) for name, one in arrays.items()},
        coords={"record": names, "direction": ("direction", angles, about), "scale": flat["scale"]},
    )


def _compared(space: xr.Dataset, flat: xr.Dataset, least_ratio: float) -> xr.Dataset:
    fallen = space["reached"].sel({LIMIT_STATE: "overturning"}, drop=True)
    worst = flat["tilt_ratio"].max("direction").assign_attrs(flat["tilt_ratio"].attrs)
    planar_fallen = flat["fallen"].max("direction")
    both = np.isfinite(space["tilt_ratio"]) & np.isfinite(worst)
    rocking = both & (space["tilt_ratio"] > least_ratio) & (worst > least_ratio)
    log_ratio = _logarithm(space["tilt_ratio"].where(rocking) / worst.where(rocking))
    least, least_flat = _least_scale(fallen), _least_scale(flat["fallen"])
    worst_least = least_flat.min("direction").assign_attrs(least_flat.attrs)
    log_capacity = _logarithm(least / worst_least)
    return xr.Dataset(
        {
            "outcome": space["outcome"],
            "tilt_ratio": space["tilt_ratio"],
            "planar_outcome": flat["outcome"],
            "planar_tilt_ratio": flat["tilt_ratio"],
            "worst_planar_tilt_ratio": worst,
            "log_ratio": _named(log_ratio, "ln(peak tilt, three-dimensional/planar)"),
            "intensity": space["intensity"],
            "only_space": _records((fallen == 1) & (planar_fallen == 0), "records that overturn the 3-D column only"),
            "only_planar": _records(
                (fallen == 0) & (planar_fallen == 1), "records that overturn the planar column only"
            ),
            "least_overturning": least,
            "least_planar_overturning": least_flat,
            "worst_least_planar_overturning": worst_least,
            "log_capacity_ratio": _named(log_capacity, "ln(smallest overturning scale, three-dimensional/planar)"),
            **bias_of(log_ratio),
            **_moments(
                log_ratio.mean("scale"),
                ("overall_bias", "overall_scatter", "overall_standard_error", "overall_compared"),
            ),
            **_moments(
                log_capacity,
                ("capacity_bias", "capacity_scatter", "capacity_standard_error", "capacities_compared"),
            ),
        },
        attrs={"kind": "planar bias", "provenance": space.attrs["provenance"], "intensity": space.attrs["intensity"]},
    )


def bias_of(log_ratio: xr.DataArray) -> dict[str, xr.DataArray]:
    """Return mean, scatter, standard error and number over the records of ln(three-dimensional/planar tilt)."""
    return _moments(log_ratio, ("bias", "scatter", "standard_error", "compared"))


def _logarithm(values: xr.DataArray) -> xr.DataArray:
    return values.copy(data=np.log(values.to_numpy()))


def _named(values: xr.DataArray, long_name: str) -> xr.DataArray:
    return values.assign_attrs(units="1", long_name=long_name)


def _records(chosen: xr.DataArray, long_name: str) -> xr.DataArray:
    return _named(chosen.sum("record"), long_name)


def _least_scale(fallen: xr.DataArray) -> xr.DataArray:
    least = fallen["scale"].where(fallen == 1).min("scale")
    return least.assign_attrs(units="1", long_name="smallest overturning scale")


def _moments(values: xr.DataArray, names: tuple[str, str, str, str]) -> dict[str, xr.DataArray]:
    """Return mean, standard deviation, standard error and number over the records; NaN if they are too few."""
    number = values.notnull().sum("record")
    enough = number >= _LEAST
    mean = values.mean("record").where(enough)
    scatter = (((values - mean) ** 2).sum("record") / (number - 1).where(enough)) ** 0.5
    error = scatter / number.where(enough) ** 0.5
    labels = ("mean over the records", "standard deviation over the records", "standard error of the mean")
    parts = zip((mean, scatter, error, number), (*labels, "records compared"), strict=True)
    return dict(zip(names, (_named(one, long_name) for one, long_name in parts), strict=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class InOneDirection(Transformed):
    """`motion` without its horizontal acceleration across the `direction` [rad from x, anticlockwise]."""

    direction: Direction

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2)."""
        x, y, z = self.motion.derivative(time, order)
        along = self._along(x, y)
        return math.cos(self.direction) * along, math.sin(self.direction) * along, z

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the only direction; none if the motion is perpendicular to it."""
        longest = max((abs(float(self._along(x, y))) for x, y in self.motion.directions()), default=0.0)
        return ((longest * math.cos(self.direction), longest * math.sin(self.direction)),) if longest > 0.0 else ()

    def _along(self, x: npt.ArrayLike, y: npt.ArrayLike) -> npt.NDArray[np.float64]:
        return np.asarray(math.cos(self.direction) * np.asarray(x) + math.sin(self.direction) * np.asarray(y))


def in_one_direction(motion: BaseMotion, direction: float) -> BaseMotion:
    """Keep only the horizontal component of `motion` along `direction` [rad], rotated to x; a record stays a record."""
    direction = require_finite("direction", direction, "rad")
    if not isinstance(motion, Record):
        return InOneDirection(motion=motion.rotated(-direction) if direction else motion, direction=0.0)
    turned = motion.rotated(-direction) if direction else motion
    note = f"component along {direction!r} rad only"
    return turned.changed(note, samples=turned.samples * [1.0, 0.0, 1.0])
