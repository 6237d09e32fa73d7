"""Incremental dynamic analysis: each record at many scales, up to overturning and beyond."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion, OneOf
from stylobate.earthquakes.fragility.displacement_limits import LimitState, Response, checked_limit_states
from stylobate.earthquakes.fragility.observations import limit_states as reached_states
from stylobate.earthquakes.intensities import Intensity, IntensityMeasure, SpectralAcceleration
from stylobate.earthquakes.study_inputs import Records, named_records, tail_of
from stylobate.engine.parameters import changed_model
from stylobate.errors import Outcome, ParameterError, as_numbers, require_finite
from stylobate.models import Model, Sliding
from stylobate.parameter_quantities import attributes_of, quantity_of
from stylobate.records.intensities import HorizontalComponent
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.studies.checks import remark_on_lengths, require_no_limits
from stylobate.studies.maps.integrity import UNRESOLVED
from stylobate.studies.study import RunsOfOwnLength, options_of, study
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.designs import Floats, checked_values
from stylobate.studies.sweeps.running import Label

Places = npt.NDArray[np.intp]


_SET_BY_ARGUMENTS = {
    "motion": "records",
    "scale": "scales",
    "acceleration": "scales",
    "rotation": "rotations",
    "delay": "records",
}


@study("incremental dynamic analysis")
def incremental_dynamic_analysis(
    model: Model,
    records: Records,
    *,
    scales: npt.ArrayLike,
    rotations: float | Sequence[float] = (0.0,),
    vertical: bool | Sequence[bool] = (True,),
    parameters: Mapping[str, npt.ArrayLike] | None = None,
    tail: float | None = None,
    intensity: str | Intensity | SpectralAcceleration = Intensity.PEAK_ACCELERATION,
    component: str | HorizontalComponent = HorizontalComponent.ROTD50,
    limit_states: Sequence[LimitState] = (),
    **run: Unpack[RunsOfOwnLength],
) -> tuple[Sweep, Label]:
    """Compute the response of a column to each record at each scale (incremental dynamic analysis).

    All runs start upright at rest unless `tilt` is given. The column starts to rock when the base acceleration exceeds
    c g. Each run lasts to the end of its record, plus the free-vibration time `tail`.

    Parameters
    ----------
    model
        The column with its equations of motion.
    records
        A base motion that ends, or several: a sequence, named as they name themselves, or a mapping from names.
    scales
        Factors of the records, vertical components included; positive.
    rotations
        Angles about the vertical by which the records are rotated [rad]. For a round column that stands upright on
        level ground, a rotation of the base rotates the motion and changes nothing else: it shows how repeatable a
        run is.
    vertical
        Whether the vertical component acts; (True, False) runs both.
    parameters
        Parameters of column and model that differ between property samples, such as {"damping": […], "size": […]}:
        arrays of one length, as from `property_samples`; or numbers for all runs.
    tail
        Free-vibration time after the end of the record [s]; by default 20/p with p = `frequency_parameter` of each
        column.
    intensity, component
        The intensity measure of each run: "peak ground acceleration", "peak ground velocity", "PGA/(g tan α)",
        "p PGV/(g tan α)" or a `SpectralAcceleration`; and the definition of its horizontal component: "RotD50",
        "RotD100", "geometric mean" or "larger component". For a motion along one line all definitions agree.
    limit_states
        Limits of the displacement by tilt, of the response "neighbours", besides those of `limit_states`. Slip has
        `slip_analysis`.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "incremental dynamic analysis". Over `record`, `rotation` [rad], `vertical`, `property_sample` and
        `scale`: all variables of ensembles; `tilt_ratio`, the peak tilt over α = atan c, infinite if the column
        overturned and NaN if the run is undecided; `intensity` (over the dimensions it depends on); `followed`, the
        duration [s]; and, over `limit_state` too, `reached`, from `limit_states`. A single record, rotation or choice
        of `vertical` has a coordinate and no dimension; `property_sample` exists if samples are given. `computed` is
        the number of runs computed.

    Raises
    ------
    ParameterError
        If a record never ends, two have one name, a scale is not positive, or an argument is out of range.
    Interrupted
        On Ctrl-C; `partial` holds what was computed, with outcome −1 elsewhere.

    Notes
    -----
    D. Vamvatsikos and C. A. Cornell, "Incremental dynamic analysis", Earthquake Engng Struct. Dyn. 31 (2002). Every
    scale is run: survival need not be monotonic.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.02)
    >>> pulses = {"long": sb.Pulse.one_sine(acceleration=1.0, angular_frequency=4.0),
    ...           "short": sb.Pulse.one_sine(acceleration=1.0, angular_frequency=12.0)}
    >>> found = incremental_dynamic_analysis(model, pulses, scales=[1.5, 3.0, 6.0])
    >>> found["reached"].sel(limit_state="overturning").values
    array([[0, 1, 1],
           [0, 0, 1]], dtype=int8)
    """
    require_no_limits(options_of(run))
    limits = _of_tilt(model, checked_limit_states(limit_states))
    plan = Plan.of(
        model, records, scales, rotations, vertical, parameters, tail, IntensityMeasure.named(intensity, component)
    )

    sweep = Sweep.points(model, plan.motion, at=plan.points, **options_of(run))
    return sweep, lambda runs: plan.labelled(_unfolded(runs, plan.lengths), limits)


def _of_tilt(model: Model, limits: tuple[LimitState, ...]) -> tuple[LimitState, ...]:
    """Return the limit states, which a model without slip can decide."""
    for place, one in enumerate(limits):
        if isinstance(model, Sliding):
            raise ParameterError(
                f"limit_states: are not computed for the model sliding (got {one.name!r}). Use slip_analysis, if the "
                "column slides before it rocks, or another model."
            )
        if one.kind is not Response.NEIGHBOURS:
            raise ParameterError(
                f"limit_states[{place}]: the model {model.name} does not slip (got {one.name!r}). Use slip_analysis "
                'with the model Sliding, or limit the response "neighbours".'
            )
        one.height_on(model.column)
    return limits


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """The choices of an incremental dynamic analysis.

    Parameters
    ----------
    model
        Model of all runs.
    records
        Base motions by name.
    scales, rotations, vertical
        Their values.
    parameters
        Parameters of column and model by name, with one value for each property sample.
    tail
        Free-vibration time after the record [s], by default 20/p.
    intensity
        Intensity measure, with its horizontal component.
    left_out
        Dimensions of one value; the result has them as coordinates only.
    """

    model: Model
    records: Mapping[str, BaseMotion]
    scales: Floats
    rotations: Floats
    vertical: tuple[bool, ...]
    parameters: Mapping[str, Floats]
    tail: float | None
    intensity: IntensityMeasure
    left_out: tuple[str, ...]

    @classmethod
    def of(
        cls,
        model: Model,
        records: Records,
        scales: npt.ArrayLike,
        rotations: float | Sequence[float],
        vertical: bool | Sequence[bool],
        parameters: Mapping[str, npt.ArrayLike] | None,
        tail: float | None,
        intensity: IntensityMeasure,
    ) -> Self:
        """Check the arguments of `incremental_dynamic_analysis`; raise ParameterError for an invalid one."""
        named = named_records(records)
        factors = _positive_values("scales", scales)
        angles = checked_values("rotations", "rotation", rotations, scalar=True)
        chosen = _choices(vertical)
        samples = _samples(parameters)
        one = {
            "record": isinstance(records, BaseMotion),
            "rotation": angles.size == 1,
            "vertical": len(chosen) == 1,
            "property_sample": not any(np.ndim(values) for values in (parameters or {}).values()),
        }
        if not angles.size:
            raise ParameterError("rotations must hold at least one angle, got none")
        return cls(
            model=model,
            records=named,
            scales=factors,
            rotations=angles,
            vertical=chosen,
            parameters=samples,
            tail=tail,
            intensity=intensity,
            left_out=tuple(name for name, alone in one.items() if alone),
        )

    @property
    def lengths(self) -> dict[str, int]:
        """The lengths of all dimensions, including those left out."""
        return {
            "record": len(self.records),
            "rotation": self.rotations.size,
            "vertical": len(self.vertical),
            "property_sample": self.sample_count,
            "scale": self.scales.size,
        }

    @property
    def sample_count(self) -> int:
        """The number of property samples."""
        return next((values.size for values in self.parameters.values()), 1)

    @property
    def motion(self) -> OneOf:
        """All records, each with every choice of its vertical component."""
        with_choice: list[Callable[[BaseMotion], BaseMotion]] = [
            (lambda motion: motion) if acts else without_vertical for acts in self.vertical
        ]
        return OneOf(motions=tuple(make(motion) for motion in self.records.values() for make in with_choice))

    @property
    def sampled(self) -> list[Model]:
        """The model with each property sample."""
        names = list(self.parameters)
        columns = zip(*self.parameters.values(), strict=True) if names else [()]
        return [
            changed_model(self.model, {name: float(value) for name, value in zip(names, values, strict=True)})
            for values in columns
        ]

    @property
    def followed(self) -> Floats:
        """Durations of the runs [s], over record and property sample."""
        tails = np.array([tail_of(model.column, self.tail) for model in self.sampled])
        ends = np.array([motion.duration for motion in self.records.values()])
        return np.asarray(ends[:, np.newaxis] + tails)

    @property
    def points(self) -> dict[str, npt.ArrayLike]:
        """The values of the runs, flat."""
        at = _crossed(self.lengths)
        return {
            "motion": at["record"] * len(self.vertical) + at["vertical"],
            "scale": self.scales[at["scale"]],
            "rotation": self.rotations[at["rotation"]],
            "duration": self.followed[at["record"], at["property_sample"]],
            **{name: values[at["property_sample"]] for name, values in self.parameters.items()},
        }

    @property
    def levels(self) -> xr.DataArray:
        """The intensity of the runs, over record, property sample if it depends on the column, and scale."""
        of_column = self.intensity.quantity in (Intensity.ACCELERATION_RATIO, Intensity.VELOCITY_RATIO)
        columns = [model.column for model in (self.sampled if of_column else self.sampled[:1])]
        values = np.array([[self.intensity.of(motion, one) for one in columns] for motion in self.records.values()])
        dims = ("record", "property_sample", "scale") if of_column else ("record", "scale")
        scaled = values[:, :, np.newaxis] * self.scales
        return xr.DataArray(scaled if of_column else scaled[:, 0], dims=dims, attrs=self.intensity.attributes)

    def labelled(self, runs: xr.Dataset, limits: Sequence[LimitState] = ()) -> xr.Dataset:
        """Add tilt ratios, limit states, intensities and coordinates to `runs`, which are over all dimensions."""
        columns = [model.column for model in self.sampled]
        slenderness = xr.DataArray([column.slenderness for column in columns], dims="property_sample")
        exceeded = {one.name: one.of_tilt(runs["peak_tilt"], columns, "property_sample") for one in limits}
        labelled = runs.assign(
            tilt_ratio=tilt_ratios(runs, slenderness),
            reached=reached_states(runs, slenderness=slenderness, exceeded=exceeded),
            intensity=self.levels,
            followed=(("record", "property_sample"), self.followed, {"units": "s", "long_name": "duration"}),
            computed=((), int((runs["outcome"] != NOT_COMPUTED).sum()), {"units": "1", "long_name": "runs computed"}),
        ).assign_coords(self.coordinates())
        lone = dict.fromkeys(self.left_out, 0)
        found = labelled.isel(lone).drop_vars("property_sample" if "property_sample" in self.left_out else [])
        return found.assign_attrs(kind="incremental dynamic analysis", intensity=self.intensity.name)

    def coordinates(self) -> dict[str, Any]:
        """Return the coordinates of all dimensions, including those left out."""
        samples = {name: ("property_sample", values, attributes_of(name)) for name, values in self.parameters.items()}
        return {
            "record": list(self.records),
            "rotation": ("rotation", self.rotations, attributes_of("rotation")),
            "vertical": ("vertical", list(self.vertical), {"long_name": "vertical component acts"}),
            "property_sample": np.arange(self.sample_count),
            "scale": ("scale", self.scales, attributes_of("scale")),
            **samples,
        }


def tilt_ratios(runs: xr.Dataset, slenderness: float | xr.DataArray) -> xr.DataArray:
    """Compute the peak tilt over α_c = arctan c: infinite if overturned, NaN if the run is undecided."""
    codes = runs["outcome"]
    decided = ~codes.isin([NOT_COMPUTED, *UNRESOLVED])
    ratio = (runs["peak_tilt"] / np.arctan(slenderness)).where(decided)
    ratio = ratio.where(codes != Outcome.OVERTURNED, np.inf)
    return ratio.assign_attrs(units="1", long_name="peak tilt / α_c")


def without_vertical(motion: BaseMotion) -> BaseMotion:
    """Return `motion` without its vertical component."""
    return motion.scaled(1.0, vertical=0.0)


def _positive_values(name: str, values: npt.ArrayLike) -> Floats:
    """Check for at least one positive number; return an array, or raise ParameterError."""
    array = checked_values(name, "scale", values, scalar=True)
    bad = array[~(array > 0.0)]
    if bad.size or not array.size:
        got = repr(float(bad[0])) if bad.size else "none"
        raise ParameterError(
            f"{name} must hold at least one number, all positive, got {got}; use record.inverted() to reverse one"
        )
    return array


def _choices(vertical: bool | Sequence[bool]) -> tuple[bool, ...]:
    given = (vertical,) if isinstance(vertical, (bool, np.bool_)) else tuple(vertical)
    if not given or len(set(given)) < len(given) or not all(isinstance(one, (bool, np.bool_)) for one in given):
        raise ParameterError(f"vertical must be True, False or (True, False), got {vertical!r}")
    return tuple(bool(one) for one in given)


def _samples(parameters: Mapping[str, npt.ArrayLike] | None) -> dict[str, Floats]:
    """Return the parameters of the property samples, as arrays of equal length."""
    if parameters is not None and not isinstance(parameters, Mapping):
        raise ParameterError(f'parameters must map names to values, such as {{"damping": […]}}, got {parameters!r}')
    given = {name: as_numbers(name, value, quantity_of(name).unit) for name, value in (parameters or {}).items()}
    for name in given:
        if name in _SET_BY_ARGUMENTS:
            raise ParameterError(f"parameters cannot name {name}: use the argument {_SET_BY_ARGUMENTS[name]}")
    remark_on_lengths("parameters", given)
    several = {name: checked_values("parameters", name, values) for name, values in given.items() if np.ndim(values)}
    sizes = {name: values.size for name, values in several.items()}
    if len(set(sizes.values())) > 1 or 0 in sizes.values():
        raise ParameterError(f"parameters must have equal numbers of values, one for each property sample, got {sizes}")
    count = next(iter(sizes.values()), 1)
    same = {name: np.full(count, require_finite(name, value)) for name, value in given.items() if name not in several}
    return {name: {**several, **same}[name] for name in given}


def _crossed(lengths: Mapping[str, int]) -> dict[str, Places]:
    """Return flat arrays of the indices of each named choice over all combinations; the last choice varies fastest."""
    grids = np.indices(tuple(lengths.values()))
    return {name: grid.ravel() for name, grid in zip(lengths, grids, strict=True)}


def _unfolded(runs: xr.Dataset, lengths: Mapping[str, int]) -> xr.Dataset:
    """Reshape `runs` from the dimension `run` to the dimensions of `_crossed` choices; drop coordinates over `run`."""
    shape = tuple(lengths.values())
    assert runs.sizes["run"] == math.prod(shape)
    variables = {}
    for name, variable in runs.data_vars.items():
        ordered = variable.transpose("run", ...)
        values = ordered.to_numpy()
        dims = (*lengths, *ordered.dims[1:])
        variables[name] = xr.Variable(dims, values.reshape(*shape, *values.shape[1:]), variable.attrs)
    kept = {name: coordinate for name, coordinate in runs.coords.items() if "run" not in coordinate.dims}
    return xr.Dataset(variables, coords=kept, attrs=runs.attrs)
