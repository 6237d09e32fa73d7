"""Slip of columns that slide before they rock: each record at many scales, with limit states of displacement."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion, OneOf, Record
from stylobate.earthquakes.fragility.displacement_limits import LimitState, checked_limit_states
from stylobate.earthquakes.fragility.observations import LIMIT_STATE, NOT_KNOWN
from stylobate.earthquakes.incremental import Plan, without_vertical
from stylobate.earthquakes.intensities import Intensity, IntensityMeasure, SpectralAcceleration
from stylobate.earthquakes.study_inputs import Records
from stylobate.engine.block_slip import BlockSlip, block_slip
from stylobate.errors import Outcome, ParameterError
from stylobate.models import Sliding
from stylobate.practice.shaking import record_of
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.records.intensities import HorizontalComponent
from stylobate.results.outcomes import NOT_COMPUTED, flag_attributes, outcome_attributes
from stylobate.studies.sweeps.designs import Floats

KIND = "slip analysis"

# Samples per period of a motion that is no record: its accelerations are 3e-5 off at most.
_PER_PERIOD = 400


@shows_progress(KIND)
def slip_analysis(
    model: Sliding,
    records: Records,
    *,
    scales: npt.ArrayLike,
    limit_states: Sequence[LimitState] = (),
    vertical: bool | Sequence[bool] = (True,),
    parameters: Mapping[str, npt.ArrayLike] | None = None,
    intensity: str | Intensity | SpectralAcceleration = Intensity.PEAK_ACCELERATION,
    component: str | HorizontalComponent = HorizontalComponent.ROTD50,
    progress: Progress = None,
) -> xr.Dataset:
    """Compute the slip of a column that slides before it rocks, under each record at each scale.

    A column that stands, with a friction coefficient below r/h, slides on its whole base and never tips. It is
    Newmark's sliding block in two horizontal directions, see `stylobate.engine.block_slip`. Each run starts at rest and
    lasts until the column has come to rest.

    Parameters
    ----------
    model
        The column with its friction coefficient; all other parameters of `Sliding` have no effect on this motion.
    records, scales, vertical, intensity, component
        As for `incremental_dynamic_analysis`. A rotation of a record rotates the slip and changes nothing else.
    limit_states
        Limits of the displacement.
    parameters
        Parameters of column and model that differ between property samples, such as {"friction_coefficient": […]}, as
        for `incremental_dynamic_analysis`.
    progress
        As for `incremental_dynamic_analysis`.

    Returns
    -------
    xarray.Dataset
        Of kind "slip analysis". Over `record`, `vertical`, `property_sample` and `scale`: `peak_slip`, the largest
        distance from the start [m]; `residual_slip`, `residual_x` and `residual_y`, distance and position at the end
        [m]; `slip_path`, the length of the path [m]; `time_sliding` [s]; `outcome`, AT_REST, or −1 for a run that the
        block does not describe; `intensity`; over `limit_state` too `reached`: 1 reached, 0 not, −1 not known; over
        `limit_state` only the coordinates `limit` [m] and `response`.

        The block does not describe a run in which the base falls faster than g, so that the column lifts off, or whose
        friction coefficient is r/h or more, so that it rocks first. Its numbers are NaN.

    Raises
    ------
    ParameterError
        If the model is not `Sliding`, is inclined or has a static coefficient of its own; if no run slides before it
        rocks; or if an argument is out of range.

    Notes
    -----
    N. M. Newmark, "Effects of earthquakes on dams and embankments", Géotechnique 15 (1965). Slip need not grow with the
    scale, because the column can slide back: every scale is computed.

    Examples
    --------
    >>> import stylobate as sb
    >>> column = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
    >>> pulse = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0)
    >>> limits = [sb.earthquakes.LimitState(response="slip", limit=0.05)]
    >>> found = slip_analysis(
    ...     sb.Sliding(column, friction_coefficient=0.15), pulse, scales=[0.4, 1.0, 2.0], limit_states=limits
    ... )
    >>> (1000.0 * found["peak_slip"]).round(1).values.tolist(), found["reached"].values.tolist()
    ([0.0, 109.9, 522.7], [[0, 1, 1]])
    """
    checked_sliding(model)
    limits = checked_limit_states(limit_states)
    plan = Plan.of(model, records, scales, 0.0, vertical, parameters, 0.0, IntensityMeasure.named(intensity, component))
    require_slip_first([checked_sliding(one) for one in plan.sampled])
    report, lanes = report_of(progress), Lanes.of(plan)
    motions = [one if acts else without_vertical(one) for one in plan.records.values() for acts in plan.vertical]
    found = []
    for place, motion in enumerate(motions):
        report(place * lanes.friction.size, len(motions) * lanes.friction.size)
        found.append(lanes.slip(motion))
    report(len(motions) * lanes.friction.size, len(motions) * lanes.friction.size)
    return _labelled(plan, found, lanes.slides_first, limits)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Lanes:
    """Frictions and scales of the runs under one record, flat over property samples and scales.

    Parameters
    ----------
    friction, scale
        Friction coefficient and scale of each run, shape (runs,).
    slides_first
        Whether the friction coefficient of each run is below r/h.
    gravity
        Gravitational acceleration [m/s²].
    """

    friction: Floats
    scale: Floats
    slides_first: npt.NDArray[np.bool_]
    gravity: float

    @classmethod
    def of(cls, plan: Plan) -> "Lanes":
        """Return the runs of a plan."""
        models = [checked_sliding(one) for one in plan.sampled]
        friction = np.array([float(one.friction_coefficient) for one in models])
        first = np.array([slides_first(one) for one in models])
        count = plan.scales.size
        return cls(
            friction=np.repeat(friction, count),
            scale=np.tile(plan.scales, len(models)),
            slides_first=np.repeat(first, count),
            gravity=plan.model.column.gravity,
        )

    def slip(self, motion: BaseMotion) -> BlockSlip:
        """Compute the slip of each run under a motion."""
        return slip_under(motion, self.friction, self.scale, self.gravity)


def slip_under(
    motion: BaseMotion, friction: npt.ArrayLike, scale: npt.ArrayLike, gravity: float, *, traced: bool = False
) -> BlockSlip:
    """Compute the slip of blocks with these frictions under a base motion that ends, at these scales."""
    record = sampled_finely(motion)
    return block_slip(
        record, friction_coefficient=friction, horizontal=scale, vertical=scale, gravity=gravity, traced=traced
    )


def sampled_finely(motion: BaseMotion) -> Record:
    """Return a base motion that ends as a record: itself, or sampled 400 times per period."""
    return record_of(motion, _PER_PERIOD)


def limit_coordinates(limits: Sequence[LimitState]) -> dict[str, Any]:
    """Return the coordinates of limit states: `limit` [m] and `response`, over `limit_state`."""
    return {
        LIMIT_STATE: np.array([one.name for one in limits], dtype=str),
        "limit": (LIMIT_STATE, np.array([one.limit for one in limits]), {"units": "m", "long_name": "limit"}),
        "response": (LIMIT_STATE, np.array([one.kind.value for one in limits], dtype=str)),
    }


def slides_first(model: Sliding) -> bool:
    """Return whether a standing column slides before it rocks: μ < r/h."""
    return bool(model.friction_coefficient < model.column.slenderness)


def checked_sliding(model: object) -> Sliding:
    """Return a model that slides as a block: `Sliding`, level, with one positive friction coefficient.

    Raises
    ------
    ParameterError
        If the model is another one.
    """
    if not isinstance(model, Sliding):
        raise ParameterError(f"model: must be Sliding (got {model!r}). Pass Sliding(column, friction_coefficient=…).")
    static = model.static_friction_coefficient
    if static is not None and static != model.friction_coefficient:
        raise ParameterError(
            f"static_friction_coefficient: must equal the kinetic {model.friction_coefficient!r} (got {static!r}). "
            "Leave it out, or use incremental_dynamic_analysis."
        )
    if model.incline != 0.0:
        raise ParameterError(
            f"incline: must be 0 (got {model.incline!r}). Leave it out, or use incremental_dynamic_analysis."
        )
    if not model.friction_coefficient > 0.0:
        raise ParameterError(
            f"friction_coefficient: must be positive (got {model.friction_coefficient!r}). State it, such as 0.15."
        )
    return model


def require_slip_first(models: Sequence[Sliding]) -> None:
    """Raise ParameterError if none of the models slides before it rocks."""
    if any(map(slides_first, models)):
        return
    slenderness = f"{models[0].column.slenderness:.4g}"
    raise ParameterError(
        f"friction_coefficient: must be below r/h = {slenderness}, otherwise the column rocks first (got "
        f"{models[0].friction_coefficient!r}). Use incremental_dynamic_analysis."
    )


_NUMBERS = {
    "peak_slip": ("m", "largest distance from the start"),
    "residual_slip": ("m", "distance from the start at the end"),
    "residual_x": ("m", "position at the end along x"),
    "residual_y": ("m", "position at the end along y"),
    "slip_path": ("m", "length of the path"),
    "time_sliding": ("s", "time of slip"),
}


def slip_numbers(found: BlockSlip) -> dict[str, Floats]:
    """Return the numbers of runs by their names in results, shape (runs,)."""
    x, y = found.residual.T
    return dict(zip(_NUMBERS, (found.peak, np.hypot(x, y), x, y, found.path, found.duration), strict=True))


def attributes_of_slip(name: str) -> dict[str, str]:
    """Return unit and long name of a number of `slip_numbers`."""
    unit, long_name = _NUMBERS[name]
    return {"units": unit, "long_name": long_name}


def reached_by_slip(
    slip: xr.Dataset, limits: Sequence[LimitState], shifts: Mapping[str, xr.DataArray] | None = None
) -> xr.DataArray:
    """Return which limit states runs reached, over `limit_state` first: 1 reached, 0 not, −1 not known.

    Parameters
    ----------
    slip
        Runs with `peak_slip` and `residual_slip` [m], NaN if not known.
    limits
        The limit states.
    shifts
        Displacements by tilt [m] by the name of a limit state of neighbours. The sum of both peaks is an upper bound.
    """
    peak, residual = slip["peak_slip"], slip["residual_slip"]
    known = peak.notnull()
    peaks = {name: peak + shift for name, shift in (shifts or {}).items()}
    states = [
        one.of_slip(peaks.get(one.name, peak), residual).astype(np.int8).where(known, np.int8(NOT_KNOWN))
        for one in limits
    ]
    names = xr.DataArray([one.name for one in limits], dims=LIMIT_STATE, name=LIMIT_STATE).astype(str)
    blank = xr.full_like(peak, NOT_KNOWN, dtype=np.int8).expand_dims({LIMIT_STATE: 0})
    joined: xr.DataArray = xr.concat(states, dim=names) if states else blank.assign_coords({LIMIT_STATE: names})
    joined = joined.astype(np.int8).rename("reached")
    joined.attrs = {}
    return joined.assign_attrs(
        flag_attributes("limit state reached", ["NOT_KNOWN", "NOT_REACHED", "REACHED"], first=NOT_KNOWN)
    )


def _labelled(
    plan: Plan, found: list[BlockSlip], first: npt.NDArray[np.bool_], limits: Sequence[LimitState]
) -> xr.Dataset:
    """Arrange the runs over record, vertical, property sample and scale, with limit states and intensities."""
    dims = [name for name in plan.lengths if name != "rotation"]
    shape = tuple(plan.lengths[name] for name in dims)
    described = np.stack([first & ~one.flies for one in found]).reshape(shape)
    numbers = {name: np.stack([slip_numbers(one)[name] for one in found]).reshape(shape) for name in _NUMBERS}
    runs = xr.Dataset(
        {
            name: (dims, np.where(described, values, np.nan), attributes_of_slip(name))
            for name, values in numbers.items()
        }
        | {
            "outcome": (
                dims,
                np.where(described, int(Outcome.AT_REST), NOT_COMPUTED).astype(np.int8),
                outcome_attributes(),
            )
        }
    )
    coordinates = {name: one for name, one in plan.coordinates().items() if name != "rotation"}
    labelled = runs.assign(
        reached=reached_by_slip(runs, limits),
        intensity=plan.levels,
        computed=((), int(described.sum()), {"units": "1", "long_name": "runs computed"}),
    ).assign_coords(coordinates | limit_coordinates(limits))
    lone = {name: 0 for name in plan.left_out if name != "rotation"}
    kept = labelled.isel(lone).drop_vars("property_sample" if "property_sample" in plan.left_out else [])
    motion = OneOf(motions=tuple(plan.records.values()))
    provenance = provenance_of_run(plan.model, motion, scales=plan.scales.tolist())
    return kept.assign_attrs(kind=KIND, intensity=plan.intensity.name, provenance=json.dumps(provenance))
