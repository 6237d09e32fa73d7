"""One case with every model of the hierarchy: runs, their differences, and how these scale with slenderness."""

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.column import Column
from stylobate.engine import simulate
from stylobate.engine.forcing import common_line
from stylobate.errors import (
    Outcome,
    ParameterError,
    as_numbers,
    require_finite,
    require_positive,
    require_vector,
    require_whole,
)
from stylobate.models import Model, PlanarRocking, Rolling, Slender, SlenderRolling, Wobbling
from stylobate.models.declared import dissipation_of
from stylobate.models.model import require_column
from stylobate.progress import Progress, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.results import Response
from stylobate.results.outcomes import NOT_COMPUTED, flag_attributes, outcome_attributes
from stylobate.run_arguments import Accuracy, RunOptions
from stylobate.studies.maps.overturning import overturning_map
from stylobate.studies.sweeps import Executor


class HierarchyArguments(Accuracy, total=False):
    """Arguments that all models of a comparison share; each model uses the dissipation parameters that it declares.

    They are `damping`, `spin_damping`, `rolling_resistance`, `restitution`, and `rtol`, `atol`, `tilt_limit`,
    `rest_energy`, `max_steps` and `rules` as in `simulate`.
    """

    damping: float
    spin_damping: float
    rolling_resistance: float
    restitution: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A column with its dissipation, a base motion and an initial state.

    Parameters
    ----------
    column, motion
        The column and its base motion.
    dissipation
        Dissipation parameters by name; each model uses the parameters that it declares. None selects the default.
    tilt, tilt_rate, spin
        Initial conditions [rad], [rad/s], [rad/s].
    """

    column: Column
    motion: BaseMotion
    dissipation: Mapping[str, float | None]
    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]
    spin: float

    def scaled_to(self, slenderness: float) -> "Case":
        """Return the case that is equivalent for small tilts: tilt, tilt rate and base motion are proportional to c.

        Height, transverse inertia and spin stay constant, and with them ω0 and κ.
        """
        factor = slenderness / self.column.slenderness
        return Case(
            column=self.column.with_slenderness(slenderness),
            motion=self.motion.scaled(factor),
            dissipation=self.dissipation,
            tilt=(factor * self.tilt[0], factor * self.tilt[1]),
            tilt_rate=(factor * self.tilt_rate[0], factor * self.tilt_rate[1]),
            spin=self.spin,
        )

    @property
    def in_a_plane(self) -> bool:
        """Whether initial conditions and base motion are planar, without spin."""
        directions = (self.tilt, self.tilt_rate, *self.motion.directions())
        moving = any(any(direction) for direction in directions)
        return self.spin == 0.0 and (not moving or common_line(*directions) is not None)

    def models(self) -> tuple[Model, ...]:
        """Return the models, the simplest first; planar rocking is last, if the motion is planar."""
        models = (Slender, SlenderRolling, Wobbling, Rolling, *((PlanarRocking,) if self.in_a_plane else ()))
        return tuple(self._model(model) for model in models)

    def _model(self, model: Callable[..., Model]) -> Model:
        declared = dissipation_of(model)
        stated = {name: value for name, value in self.dissipation.items() if name in declared and value is not None}
        return model(self.column, **stated)

    def run(
        self, model: Model, duration: float, friction_coefficient: float | None, arguments: Mapping[str, Any]
    ) -> Response:
        """Run one model; a model without spin starts without spin."""
        return simulate(
            model,
            self.motion,
            tilt=self.tilt,
            tilt_rate=self.tilt_rate,
            spin=0.0 if model.spin_state is None else self.spin,
            duration=duration,
            friction_coefficient=friction_coefficient,
            **arguments,
        )


Floats = npt.NDArray[np.float64]

# Late part of the run, as a fraction; for a periodic base motion, the whole periods that it contains.
_LATE = 0.2

# Number of times for means.
_TIMES_COMPARED = 400


@dataclass(frozen=True, slots=True)
class Course:
    """A run and its requested duration [s]; a run that came to rest early stands until the end."""

    run: Response
    duration: float

    def history(self, time: Floats) -> tuple[Floats, Floats]:
        """Return tilt vectors [rad], shape (n, 2), and spin [rad/s] at `time`; NaN after the end or without a spin."""
        end = float(self.run.data["time"][-1])
        known = time <= end
        tilt, spin = np.full((time.size, 2), np.nan), np.full(time.size, np.nan)
        sampled = self.run.sample(time[known])
        tilt[known] = sampled["tilt"]
        if "spin" in sampled:
            spin[known] = sampled["spin"]
        if self.run.outcome is Outcome.AT_REST:
            tilt[~known] = 0.0
            spin[~known] = spin[known][-1] if known.any() else np.nan
        return tilt, spin

    def late_means(self, motion: BaseMotion) -> dict[str, float]:
        """Return the mean tilt angle [rad] and spin [rad/s] late in the run; NaN if it ended before."""
        window = _LATE * self.duration
        if motion.period is not None and motion.period <= window:
            window = motion.period * math.floor(window / motion.period)
        start = self.duration - window
        tilt, spin = self.history(start + window * np.arange(_TIMES_COMPARED) / _TIMES_COMPARED)
        return {"mean_late_tilt": float(np.hypot(*tilt.T).mean()), "mean_late_spin": float(spin.mean())}


def largest_distance(first: xr.DataArray, second: xr.DataArray) -> float:
    """Return the maximum distance of two histories of the tilt vector while both are known [rad]."""
    return float(np.nanmax(np.hypot(*(first.to_numpy() - second.to_numpy()).T)))


class Comparison(Enum):
    """Comparison of the outcomes of two models, in the order of the codes."""

    BOTH_STAY = "overturns in neither"
    ONLY_FIRST = "overturns in the first only"
    ONLY_SECOND = "overturns in the second only"
    BOTH_OVERTURN = "overturns in both"
    UNDECIDED = "undecided"
    """A run failed, or lifted off, or was stopped by a tilt limit."""


@shows_progress("outcome differences")
def outcome_differences(
    first: Model,
    second: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, npt.ArrayLike],
    duration: float | None = None,
    periods: float | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Compare, over two parameters, whether a column overturns in two models.

    If the models differ in one assumption, such as `Slender` and `SlenderRolling`, the map shows where this assumption
    decides the outcome.

    Parameters
    ----------
    first, second
        The models, usually of one column.
    motion, over, duration, periods, executor, progress, **options
        As in `overturning_map`; `over` names parameters of both models.

    Returns
    -------
    xarray.Dataset
        Of kind "outcome differences": over the two names `comparison`, codes of `Comparison`; `first_outcome`,
        `second_outcome`, and `first_peak_tilt`, `second_peak_tilt` [rad], with demands=True also the contact demands of
        both; `count` and `share` over `comparison_name`.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    Interrupted
        After Ctrl-C; `partial` is the overturning map of the model that was interrupted.

    Examples
    --------
    >>> import stylobate as sb
    >>> column = sb.Column.dimensionless(slenderness=0.1)
    >>> held, free = sb.Slender(column, damping=0.1), sb.SlenderRolling(column, damping=0.1, spin_damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.13, angular_frequency=3.0)
    >>> over = {"angular_frequency": [2.0, 3.0], "acceleration": [0.12, 0.13]}
    >>> found = sb.studies.outcome_differences(held, free, motion, over=over, periods=60.0)
    >>> print(found["comparison"].dims, int(found["count"].sum()))
    ('angular_frequency', 'acceleration') 4
    """
    maps = [
        overturning_map(
            model,
            motion,
            over=over,
            duration=duration,
            periods=periods,
            executor=executor,
            progress=progress,
            **options,
        )
        for model in (first, second)
    ]
    codes = _compared_pair(*(found["outcome"].to_numpy() for found in maps))
    return _dataset(maps, codes, (first, second))


def _compared_pair(first: npt.NDArray[np.int8], second: npt.NDArray[np.int8]) -> npt.NDArray[np.int8]:
    fallen = Outcome.OVERTURNED
    places = {one: code for code, one in enumerate(Comparison)}
    codes = np.where(first == fallen, places[Comparison.ONLY_FIRST], places[Comparison.BOTH_STAY])
    codes = np.where(second == fallen, codes + places[Comparison.ONLY_SECOND], codes)
    unclear = [Outcome.FAILED, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED]
    codes = np.where(np.isin(first, unclear) | np.isin(second, unclear), places[Comparison.UNDECIDED], codes)
    return np.where((first == NOT_COMPUTED) | (second == NOT_COMPUTED), NOT_COMPUTED, codes).astype(np.int8)


# Variables of each model's runs in the result; demands only if they were computed.
_COMPARED = ("outcome", "peak_tilt", "peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force")


def _dataset(maps: list[xr.Dataset], codes: npt.NDArray[np.int8], models: tuple[Model, Model]) -> xr.Dataset:
    dims = maps[0]["outcome"].dims
    names = [one.value for one in Comparison]
    meanings = ["NOT_COMPUTED", *(one.name for one in Comparison)]
    about = flag_attributes("comparison of the two models", meanings, first=NOT_COMPUTED)
    count = np.array([np.count_nonzero(codes == code) for code in range(len(names))], dtype=np.int64)
    variables: dict[str, Any] = {
        "comparison": (dims, codes, about),
        "count": ("comparison_name", count, {"units": "1", "long_name": "runs compared so"}),
        "share": ("comparison_name", count / max(codes.size, 1), {"units": "1", "long_name": "share of the runs"}),
    }
    for place, found in zip(("first", "second"), maps, strict=True):
        shared = [name for name in _COMPARED if name in found]
        variables |= {f"{place}_{name}": found[name].variable for name in shared}
    provenance = {
        place: json.loads(found.attrs["provenance"]) for place, found in zip(("first", "second"), maps, strict=True)
    }
    return xr.Dataset(
        variables,
        coords={**{dim: maps[0][dim] for dim in dims}, "comparison_name": names},
        attrs={
            "kind": "outcome differences",
            "first": models[0].name,
            "second": models[1].name,
            "provenance": json.dumps(provenance),
        },
    )


# Number of times at which models are compared, unless the user requests histories of another length.
_TIMES = 2001

_OF_SIMULATE = tuple(Accuracy.__annotations__)


def model_hierarchy(
    column: Column,
    motion: BaseMotion | None = None,
    *,
    tilt: Sequence[float] = (0.0, 0.0),
    tilt_rate: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    duration: float,
    slenderness: npt.ArrayLike | None = None,
    friction_coefficient: float | None = None,
    reference: str = Rolling.name,
    samples: int | None = None,
    **arguments: Unpack[HierarchyArguments],
) -> xr.Dataset:
    """Run one case with every model of the hierarchy and compare the results.

    The models are slender, slender rolling, wobbling and rolling; if initial conditions and base motion are planar,
    also planar rocking.

    Parameters
    ----------
    column, motion
        The column and its base motion; None is a base at rest.
    tilt, tilt_rate, spin
        Initial conditions [rad], [rad/s], [rad/s]; models without spin ignore `spin`.
    duration
        Duration of each run [s].
    slenderness
        Slendernesses to which the case is scaled, shape (n,): tilt, tilt rate and base motion proportional to c, radius
        by `Column.with_slenderness`. For small tilts all these cases are equivalent.
    friction_coefficient
        Friction coefficient of the contact; runs warn if they need more.
    reference
        The model from which differences are computed.
    samples
        Number of samples of the histories in the result; none by default.
    **arguments
        Dissipation parameters: damping η of all models; spin_damping ζ of the models with free axial rotation. Models
        at finite tilt also have rolling_resistance, a lever arm in radii, and restitution e at a passage near the
        vertical, by default Housner's in planar rocking and 1 elsewhere. Arguments of `simulate`: rtol, atol,
        tilt_limit, rest_energy, max_steps, rules.

    Returns
    -------
    xarray.Dataset
        Of kind "model hierarchy", over `model`, and over `slenderness` if it is given: `outcome`, `uncertain`,
        `peak_tilt`, `mean_late_tilt`, `mean_late_spin` (over the last fifth of the run; NaN if the run ended before, or
        has no spin), peak contact demands, `minimum_normal_force` over weight, `steps`, `warnings`; differences from
        the `reference`; `deviation` (model, other_model), the maximum distance of the tilt vectors while both runs last
        [rad]. Two or more slendernesses also give `deviation_order`, the power of c with which `deviation`/c falls;
        `samples` also gives the histories `amplitude` [rad] and `spin` [rad/s] over `time`.

    Raises
    ------
    ParameterError
        If an argument is out of range, or there is no such model.

    Examples
    --------
    >>> import stylobate as sb
    >>> column = sb.Column.dimensionless(slenderness=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    >>> start = {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07), "duration": 80.0}
    >>> found = sb.studies.model_hierarchy(column, motion, damping=0.1, spin_damping=0.1, **start)
    >>> print((found["mean_late_tilt"] / 0.1).round(3).to_series().to_string(header=False))
    slender            0.388
    slender rolling    0.193
    wobbling           0.388
    rolling            0.193
    """
    shared = dissipation_of(Rolling)
    strange = [name for name in arguments if name not in (*_OF_SIMULATE, *shared)]
    if strange:
        known = ", ".join((*shared, *_OF_SIMULATE))
        raise ParameterError(
            f"{strange[0]} is no argument of model_hierarchy. Besides those of its signature use {known}."
        )
    moved = BASE_AT_REST if motion is None else motion
    given: dict[str, Any] = {**arguments}
    dissipation = {name: given.pop(name) for name in shared if name in given}
    case = _case(column, moved, dissipation, tilt, tilt_rate, spin)
    duration = require_positive("duration", duration, "s")
    models = [model.name for model in case.models()]
    if reference not in models:
        raise ParameterError(f"reference must be a model of this case, {', '.join(models)}; got {reference!r}")
    time = np.linspace(0.0, duration, _TIMES if samples is None else require_whole("samples", samples, least=2))

    def compared(one: Case) -> xr.Dataset:
        runs = [one.run(model, duration, friction_coefficient, given) for model in one.models()]
        return _compared(one, runs, time, duration)

    if slenderness is None:
        found = compared(case)
    else:
        scales = _slendernesses(slenderness)
        found = xr.concat([compared(one) for one in _scaled(case, scales)], dim="slenderness")
        found = found.assign_coords(slenderness=("slenderness", scales, {"units": "1", "long_name": "slenderness"}))
        found = _with_order(found) if scales.size > 1 else found
    found = _with_differences(found, reference)
    if samples is None:
        found = found.drop_vars(["amplitude", "spin", "time"])
    provenance = provenance_of_run(
        case.models()[models.index(reference)],
        moved,
        tilt=case.tilt,
        tilt_rate=case.tilt_rate,
        spin=case.spin,
        duration=duration,
        friction_coefficient=friction_coefficient,
        restitution=dissipation.get("restitution"),
        slenderness=None if slenderness is None else np.asarray(slenderness, dtype=float).tolist(),
        **{name: value for name, value in given.items() if name != "rules"},
    )
    attributes = {"kind": "model hierarchy", "reference": reference, "column_slenderness": column.slenderness}
    if friction_coefficient is not None:
        attributes["friction_coefficient"] = friction_coefficient
    return found.assign_attrs(**attributes, provenance=json.dumps(provenance))


def _case(
    column: Column,
    motion: BaseMotion,
    dissipation: Mapping[str, float | None],
    tilt: Sequence[float],
    tilt_rate: Sequence[float],
    spin: float,
) -> Case:
    require_column(column)
    if not isinstance(motion, BaseMotion):
        raise ParameterError(f"motion must be a base motion such as Harmonic.circular(...) or None, got {motion!r}")
    x, y = require_vector("tilt", tilt, 2, "rad")
    vx, vy = require_vector("tilt_rate", tilt_rate, 2, "rad/s")
    return Case(
        column=column,
        motion=motion,
        dissipation=dissipation,
        tilt=(x, y),
        tilt_rate=(vx, vy),
        spin=require_finite("spin", spin, "rad/s"),
    )


def _slendernesses(given: npt.ArrayLike) -> Floats:
    values = np.atleast_1d(np.asarray(as_numbers("slenderness", given), dtype=float))
    if values.ndim != 1 or not values.size or not np.all(np.isfinite(values) & (values > 0.0)):
        raise ParameterError(f"slenderness must be a list of positive numbers, got {given!r}")
    return values


def _scaled(case: Case, slendernesses: Floats) -> list[Case]:
    """Return the case at each slenderness; raise ParameterError if it would start beyond a tilt of π/2."""
    found = []
    for c in slendernesses:
        try:
            one = case.scaled_to(float(c))
        except ParameterError as error:
            raise ParameterError(f"the column cannot be scaled to slenderness {c:.6g}: {error}") from None
        found.append(one)
        if math.hypot(*one.tilt) >= 0.5 * math.pi:
            raise ParameterError(
                f"tilt {case.tilt!r} rad at slenderness {case.column.slenderness:.6g} becomes "
                f"({one.tilt[0]:.6g}, {one.tilt[1]:.6g}) rad at slenderness {c:.6g}, and must be below π/2 in length. "
                "Scale to a smaller slenderness, or tilt less"
            )
    return found


_MEASURES = {
    "peak_tilt": ("rad", "peak tilt angle"),
    "mean_late_tilt": ("rad", "mean tilt angle over the last fifth of the run"),
    "mean_late_spin": ("rad s-1", "mean spin over the last fifth of the run"),
    "peak_friction_demand": ("1", "peak friction force over normal force"),
    "peak_pivoting_demand": ("1", "peak moment about the vertical over normal force and radius"),
    "minimum_normal_force": ("1", "minimum normal force over weight"),
    "decided_at": ("s", "time at which the outcome was decided"),
    "steps": ("1", "integration steps"),
}
_DIFFERENT = ("peak_tilt", "mean_late_tilt", "peak_friction_demand", "peak_pivoting_demand")


def _compared(case: Case, runs: Sequence[Response], time: Floats, duration: float) -> xr.Dataset:
    """Summarise the `runs` of all models of a case."""
    courses = [Course(run, duration) for run in runs]
    rows = [
        {**run.measures, "decided_at": run.decided_at, **course.late_means(case.motion)}
        for run, course in zip(runs, courses, strict=True)
    ]
    histories = [course.history(time) for course in courses]
    tilt = xr.DataArray([tilt for tilt, _ in histories], dims=("model", "time", "axis"))
    variables: dict[str, Any] = {
        name: ("model", [one.get(name, np.nan) for one in rows], {"units": units, "long_name": long_name})
        for name, (units, long_name) in _MEASURES.items()
    }
    models = [model.name for model in case.models()]
    deviation = [[largest_distance(one, other) for other in tilt] for one in tilt]
    return xr.Dataset(
        {
            "outcome": ("model", np.array([run.outcome for run in runs], np.int8), outcome_attributes()),
            "uncertain": ("model", [run.uncertain for run in runs], {"long_name": "uncertain"}),
            **variables,
            "warnings": ("model", ["; ".join(run.warnings) for run in runs], {"long_name": "warnings"}),
            "deviation": (
                ("model", "other_model"),
                deviation,
                {"units": "rad", "long_name": "maximum distance of the tilt vectors"},
            ),
            "amplitude": (
                ("model", "time"),
                np.hypot(tilt[..., 0], tilt[..., 1]).data,
                {"units": "rad", "long_name": "tilt angle"},
            ),
            "spin": (("model", "time"), [spin for _, spin in histories], {"units": "rad s-1", "long_name": "spin"}),
        },
        coords={"model": models, "other_model": models, "time": ("time", time, {"units": "s", "long_name": "time"})},
    )


def _with_order(found: xr.Dataset) -> xr.Dataset:
    """Add the power of c with which the deviation over c falls, by least squares; NaN without a deviation."""
    c = found["slenderness"].to_numpy()
    relative = (found["deviation"] / found["slenderness"]).transpose("slenderness", ...).to_numpy()
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = np.log(np.where(relative > 0.0, relative, np.nan))
    offset = np.log(c) - np.log(c).mean()
    slope = (offset[:, None, None] * logarithm).sum(axis=0) / (offset**2).sum()
    about = {"units": "1", "long_name": "power of the slenderness with which the deviation over it falls"}
    return found.assign(deviation_order=(("model", "other_model"), slope, about))


def _with_differences(found: xr.Dataset, reference: str) -> xr.Dataset:
    base = found.sel(model=reference)
    added = {}
    for name in _DIFFERENT:
        difference = found[name] - base[name].drop_vars("model")
        about = {**found[name].attrs, "long_name": f"{found[name].attrs['long_name']}, less that of {reference}"}
        added[f"{name}_difference"] = difference.assign_attrs(about)
    return found.assign(added)
