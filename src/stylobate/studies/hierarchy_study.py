"""One case with every model of the hierarchy: runs, their differences, and how these scale with slenderness.

`stylobate hierarchy` shows them.
"""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Unpack

import numpy as np
import numpy.typing as npt

from stylobate import engine
from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.column import Column
from stylobate.config.options import COLUMN, MODEL, MOTION_WITHOUT_RECORDS, OUTPUT, Group, Option, run_numbers
from stylobate.config.study import Analysis
from stylobate.errors import (
    ConfigError,
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
from stylobate.provenance import provenance_of_run
from stylobate.quantities import Quantity
from stylobate.results.outcomes import outcome_attributes, outcome_label
from stylobate.results.plain import plain_variables
from stylobate.results.tables import ResultTable
from stylobate.run_arguments import Accuracy, OneRun, duration_with_tail, numbers_of
from stylobate.studies.study import analysis

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.results import Run


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
        return replace(
            self,
            column=self.column.with_slenderness(slenderness),
            motion=self.motion.scaled(factor),
            tilt=(factor * self.tilt[0], factor * self.tilt[1]),
            tilt_rate=(factor * self.tilt_rate[0], factor * self.tilt_rate[1]),
        )

    @property
    def in_a_plane(self) -> bool:
        """Whether initial conditions and base motion are planar, without spin."""
        from stylobate.engine.forcing import common_line

        directions = (self.tilt, self.tilt_rate, *self.motion.directions())
        moving = any(any(direction) for direction in directions)
        return self.spin == 0.0 and (not moving or common_line(*directions) is not None)

    def models(self) -> tuple[Model, ...]:
        """Return the models, the simplest first; planar rocking is last, if the motion is planar."""
        models = (Slender, SlenderRolling, Wobbling, Rolling, *((PlanarRocking,) if self.in_a_plane else ()))
        stated = {name: value for name, value in self.dissipation.items() if value is not None}
        return tuple(
            model(self.column, **{name: value for name, value in stated.items() if name in dissipation_of(model)})
            for model in models
        )

    def run(
        self, model: Model, duration: float, friction_coefficient: float | None, arguments: Mapping[str, Any]
    ) -> "Run":
        """Run one model; a model without spin starts without spin."""
        return engine.simulate(
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

    run: "Run"
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


# The most general model declares the dissipation parameters of all other models.
_SHARED = tuple(dissipation_of(Rolling))


def _of_all_models(values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the values of a description with the most general model; its kind and unchanged defaults are ignored."""
    from stylobate.config.parts import DEFAULT_MODEL, default_values
    from stylobate.config.simulation import with_default_duration

    described = values.get("model", {})
    if isinstance(described, Mapping):
        usual = {**default_values(described.get("kind", DEFAULT_MODEL)), "kind": described.get("kind")}
        stated = {name: one for name, one in described.items() if name not in usual or one != usual[name]}
        problems = [
            f"model.{name}: the models of the hierarchy share {', '.join(_SHARED)} only (got {value!r}). Remove it."
            for name, value in stated.items()
            if name not in _SHARED
        ]
        if problems:
            raise ConfigError(problems)
        values = {**values, "model": {"kind": Rolling.name, **stated}}
    return with_default_duration(values)


def _problems(config: Any) -> list[str]:
    from stylobate.config.description import built
    from stylobate.config.simulation import built_rules

    problems: list[str] = []
    for c in config.hierarchy.slenderness or ():
        built("hierarchy", partial(require_positive, "slenderness", c), problems)
    built("rules", partial(built_rules, config.rules), problems)
    return problems


def _arguments(config: Any, setup: Any) -> Mapping[str, Any]:
    from stylobate.config.simulation import built_rules

    found = {name: getattr(config, name) for name in numbers_of(OneRun)}
    if config.duration is None:
        found["duration"] = duration_with_tail(setup.motion.duration, setup.model.column.frequency_parameter)
    found |= {name: getattr(setup.model, name) for name in config.model.model_fields_set - {"kind"}}
    compared = {"slenderness": config.hierarchy.slenderness or None, "rules": built_rules(config.rules)}
    return found | compared | {"reference": config.hierarchy.reference.replace("-", " ").replace("_", " ")}


def _chosen(options: Mapping[str, Any]) -> Mapping[str, Any]:
    if options["model"] is not None:
        raise ParameterError(f"--model: hierarchy runs all models (got {options['model']!r}). Remove it.")
    scaled_to = options["scaled_to"] or ()
    if any(not 0.0 < c < math.inf for c in scaled_to):
        raise ParameterError(
            f"--scaled-to must be followed by a positive slenderness, got {', '.join(map(str, scaled_to))}"
        )
    return {} if options["figure"] is None else {"samples": _DRAWN}


# Samples of the histories in a figure, unless --samples states another number.
_DRAWN = 4000


def _tables(result: "xr.Dataset") -> list[ResultTable]:
    several = "slenderness" in result.dims
    rows = []
    for index in range(result.sizes["slenderness"] if several else 1):
        at = result.isel(slenderness=index) if several else result
        c = float(at["slenderness"]) if several else float(result.attrs["column_slenderness"])
        scaled = [f"{c:.4g}"] if several else []
        rows += [[*scaled, *_row(at.sel(model=model), c)] for model in result["model"].to_numpy()]
    header = (*(("c",) if several else ()), *_HEADER)
    remarks = []
    if "deviation_order" in result:
        for first, second in (("slender", "wobbling"), ("slender rolling", "rolling"), ("slender", "rolling")):
            order = float(result["deviation_order"].sel(model=first, other_model=second))
            remarks.append(f"the distance of {second} from {first} is proportional to c to the power {order:.2f}")
    # Over several slendernesses, the warnings at the largest.
    shown = result.isel(slenderness=int(np.argmax(result["slenderness"].to_numpy()))) if several else result
    warned = zip(shown["model"].to_numpy(), shown["warnings"].to_numpy(), strict=True)
    remarks += [f"{model}: {line}" for model, line in warned if line]
    distance = f"distance: maximum deviation of the tilt vector from {result.attrs['reference']}"
    demand = "friction and pivoting: required coefficients; normal force: its minimum over the weight"
    return [ResultTable(f"tilts over c; late: the last fifth of the run; {demand}; {distance}", header, rows, remarks)]


_HEADER = (
    "model",
    "outcome",
    "peak tilt",
    "late mean",
    "spin [rad/s]",
    "friction",
    "pivoting",
    "normal force",
    "distance",
)


def _row(at: "xr.Dataset", c: float) -> list[str]:
    numbers = (
        float(at["peak_tilt"]) / c,
        float(at["mean_late_tilt"]) / c,
        float(at["mean_late_spin"]),
        float(at["peak_friction_demand"]),
        float(at["peak_pivoting_demand"]),
        float(at["minimum_normal_force"]),
        float(at["deviation"].sel(other_model=at.attrs["reference"])) / c,
    )
    cells = ("" if np.isnan(one) else "unbounded" if np.isinf(one) else f"{one:.4g}" for one in numbers)
    outcome = outcome_label(int(at["outcome"])) + (" (numerically uncertain)" if bool(at["uncertain"]) else "")
    return [str(at["model"].to_numpy()), outcome, *cells]


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    attributes = {name: result.attrs[name] for name in ("reference", "column_slenderness", "provenance")}
    return {**plain_variables(result), "attributes": attributes}


# Number of times at which models are compared, unless the user requests histories of another length.
_TIMES = 2001

_OF_SIMULATE = tuple(Accuracy.__annotations__)


@analysis(
    Analysis(
        name="hierarchy",
        source="TOML description, or a saved run (.nc)",
        help="""Compare all models of the hierarchy in one case.

    The file is that of `simulate`; the kind of its model is ignored. --samples keeps histories; --figure draws them.

    Examples
    --------
    stylobate hierarchy --slenderness 0.1 --damping 0.1 --spin-damping 0.1 --motion circular --acceleration 0.065
    --angular-frequency 1.8 --tilt 0.04 0 --tilt-rate 0 0.07 --duration 100 --figure hierarchy.png

    stylobate hierarchy run.toml --scaled-to 0.05 --scaled-to 0.1 --scaled-to 0.2
    """,
        groups=(
            Group.of("Options", Option("model", type=str, hidden=True)),
            run_numbers(OneRun),
            COLUMN,
            MODEL.reduced_to(*_SHARED),
            MOTION_WITHOUT_RECORDS,
            OUTPUT,
        ),
        renamed={"slenderness": "scaled_to"},
        numbers=OneRun,
        read=_of_all_models,
        problems=_problems,
        arguments=_arguments,
        chosen=_chosen,
        tables=_tables,
        summary=_summary,
    )
)
def model_hierarchy(
    column: Column,
    motion: BaseMotion | None = None,
    *,
    tilt: Sequence[float] = (0.0, 0.0),
    tilt_rate: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    duration: float,
    slenderness: Annotated[
        float | Sequence[float] | Floats | None,
        Quantity(
            text="slenderness to which the case is scaled, with its tilts and base motion; can be repeated", gt=0.0
        ),
    ] = None,
    friction_coefficient: float | None = None,
    reference: Annotated[str, Quantity(text="model from which distances are measured")] = Rolling.name,
    samples: int | None = None,
    **arguments: Unpack[HierarchyArguments],
) -> "xr.Dataset":
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
    import xarray as xr

    strange = [name for name in arguments if name not in (*_OF_SIMULATE, *_SHARED)]
    if strange:
        known = ", ".join((*_SHARED, *_OF_SIMULATE))
        raise ParameterError(
            f"{strange[0]} is no argument of model_hierarchy. Besides those of its signature use {known}."
        )
    moved = BASE_AT_REST if motion is None else motion
    given: dict[str, Any] = {**arguments}
    dissipation = {name: given.pop(name) for name in _SHARED if name in given}
    require_column(column)
    if not isinstance(moved, BaseMotion):
        raise ParameterError(f"motion must be a base motion such as Harmonic.circular(...) or None, got {motion!r}")
    (x, y), (vx, vy) = require_vector("tilt", tilt, 2, "rad"), require_vector("tilt_rate", tilt_rate, 2, "rad/s")
    spin = require_finite("spin", spin, "rad/s")
    case = Case(column=column, motion=moved, dissipation=dissipation, tilt=(x, y), tilt_rate=(vx, vy), spin=spin)
    duration = require_positive("duration", duration, "s")
    models = [model.name for model in case.models()]
    if reference not in models:
        raise ParameterError(f"reference must be a model of this case, {', '.join(models)}; got {reference!r}")
    time = np.linspace(0.0, duration, _TIMES if samples is None else require_whole("samples", samples, least=2))

    def compared(one: Case) -> "xr.Dataset":
        runs = [one.run(model, duration, friction_coefficient, given) for model in one.models()]
        return _compared(one, runs, time, duration)

    if slenderness is None:
        found = compared(case)
    else:
        scales = np.atleast_1d(np.asarray(as_numbers("slenderness", slenderness), dtype=float))
        if scales.ndim != 1 or not scales.size or not np.all(np.isfinite(scales) & (scales > 0.0)):
            raise ParameterError(f"slenderness must be a list of positive numbers, got {slenderness!r}")
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


def _compared(case: Case, runs: "Sequence[Run]", time: Floats, duration: float) -> "xr.Dataset":
    """Summarise the `runs` of all models of a case."""
    import xarray as xr

    courses = [Course(run, duration) for run in runs]
    rows = [
        {**run.measures, "decided_at": run.decided_at, **course.late_means(case.motion)}
        for run, course in zip(runs, courses, strict=True)
    ]
    histories = [course.history(time) for course in courses]
    tilt = np.array([tilt for tilt, _ in histories])
    variables: dict[str, Any] = {
        name: ("model", [one.get(name, np.nan) for one in rows], {"units": units, "long_name": long_name})
        for name, (units, long_name) in _MEASURES.items()
    }
    models = [model.name for model in case.models()]
    # The maximum distance of two histories while both are known.
    deviation = [[float(np.nanmax(np.hypot(*(one - other).T))) for other in tilt] for one in tilt]
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
                np.hypot(tilt[..., 0], tilt[..., 1]),
                {"units": "rad", "long_name": "tilt angle"},
            ),
            "spin": (("model", "time"), [spin for _, spin in histories], {"units": "rad s-1", "long_name": "spin"}),
        },
        coords={"model": models, "other_model": models, "time": ("time", time, {"units": "s", "long_name": "time"})},
    )


def _with_order(found: "xr.Dataset") -> "xr.Dataset":
    """Add the power of c with which the deviation over c falls, by least squares; NaN without a deviation."""
    c = found["slenderness"].to_numpy()
    relative = (found["deviation"] / found["slenderness"]).transpose("slenderness", ...).to_numpy()
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = np.log(np.where(relative > 0.0, relative, np.nan))
    offset = np.log(c) - np.log(c).mean()
    slope = (offset[:, None, None] * logarithm).sum(axis=0) / (offset**2).sum()
    about = {"units": "1", "long_name": "power of the slenderness with which the deviation over it falls"}
    return found.assign(deviation_order=(("model", "other_model"), slope, about))


def _with_differences(found: "xr.Dataset", reference: str) -> "xr.Dataset":
    base = found.sel(model=reference)
    added = {}
    for name in _DIFFERENT:
        difference = found[name] - base[name].drop_vars("model")
        about = {**found[name].attrs, "long_name": f"{found[name].attrs['long_name']}, less that of {reference}"}
        added[f"{name}_difference"] = difference.assign_attrs(about)
    return found.assign(added)
