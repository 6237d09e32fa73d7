"""Robustness of verdicts: runs repeated under small changes of record, dissipation, geometry and integration."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Unpack, cast

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion, OneOf
from stylobate.earthquakes.following import tail_of
from stylobate.earthquakes.fragility import limit_states
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.incremental import tilt_ratios
from stylobate.earthquakes.named_records import Records, named_records
from stylobate.earthquakes.perturbations import SMALL_PERTURBATIONS, Perturbation
from stylobate.engine.parameter_quantities import attributes_of
from stylobate.engine.parameters import changed_model
from stylobate.errors import ParameterError, require_positive
from stylobate.models import Model
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.studies.checks import require_no_tilt_limit
from stylobate.studies.sweeps import Executor, Sweep, run_sweep
from stylobate.studies.sweeps.computing import Progress
from stylobate.studies.sweeps.quantities import Floats, checked_values
from stylobate.studies.sweeps.recipe import DEFAULTS, RunOptions

_KEPT = ("outcome", "peak_tilt", "uncertain")
_AS_GIVEN = 0


def robustness(
    model: Model,
    records: Records,
    *,
    scale: float = 1.0,
    changes: Sequence[Perturbation] | None = None,
    rotations: float | Sequence[float] = (0.0,),
    tail: float | None = None,
    executor: Executor | None = None,
    progress: Progress | None = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Repeat the verdicts on a column under small changes; report which flip, and the scatter of the peak tilts.

    A single rocking run is barely repeatable. Near the boundary of overturning, and after many passages near the
    vertical, a change far below the uncertainty of record and column changes the verdict.

    Parameters
    ----------
    model, records, tail
        As for `incremental_dynamic_analysis`.
    scale
        Factor of all records, before any change.
    changes
        The changes, one at a time; by default `SMALL_PERTURBATIONS`.
    rotations
        Angles by which the records are rotated [rad].
    executor, progress, **options
        As for `incremental_dynamic_analysis`.

    Returns
    -------
    xarray.Dataset
        Of kind "robustness". Over `record` (and `rotation`, if there are several) and `change`: `outcome` (−1 if the
        change does not apply, such as another step for a pulse), `tilt_ratio` (infinite if overturned), `applies`;
        over `limit_state` too `reached`, and `flips`: True if the change alters whether the limit state is reached.
        Without `change`: `outcome_as_given`, `tilt_ratio_as_given`, `reached_as_given` of the run without changes;
        `changes_compared`, how many changes apply and are decided; `share_flipped`, the fraction of these that flip;
        `repeatable`, True if none flips overturning; `tilt_ratio_low` and `tilt_ratio_high`, minimum and maximum of
        the peak tilts over all changes, infinite if one overturns; `tilt_dispersion`, the standard deviation of ln(peak
        tilt) of those that do not overturn. Along `change` its name and `change_of`: record, dissipation, geometry or
        integration. Its `provenance` holds model, records, options and changes.

    Raises
    ------
    ParameterError
        If an argument is out of range.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.02)
    >>> pulse = sb.Pulse.one_sine(acceleration=3.2, angular_frequency=12.0)
    >>> from stylobate.earthquakes.perturbations import ScaledRecord
    >>> found = robustness(model, pulse, changes=[ScaledRecord(0.95), ScaledRecord(1.05)])
    >>> bool(found["repeatable"])
    True
    """
    require_no_tilt_limit(options)
    named = named_records(records)
    factor = require_positive("scale", scale)
    angles = checked_values("rotations", "rotation", np.atleast_1d(np.asarray(rotations)))
    chosen = _checked(SMALL_PERTURBATIONS if changes is None else tuple(changes))
    cases = _cases(model, named, chosen, tail)
    groups = _grouped(cases)
    arrays = _Arrays.empty((len(named), angles.size, len(chosen) + 1))
    done, total = 0, len(cases) * angles.size
    for group in groups:
        runs = _run(model, group, factor, angles, executor, cast("dict[str, Any]", options))
        arrays.put(group, runs, angles.size)
        done += len(group) * angles.size
        if progress is not None:
            progress(done, total)
    found = _as_dataset(arrays, list(named), angles, chosen, factor)
    sweep = Sweep.points(model, OneOf(motions=tuple(named.values())), at={"scale": [factor]}, duration=1.0, **options)
    return found.assign_attrs(
        provenance=_provenance(
            sweep, scale=factor, rotations=angles.tolist(), tail=tail, changes=[repr(change) for change in chosen]
        )
    )


def _provenance(given: Sweep, **own: Any) -> str:
    """Return the common settings of all runs and the `own` settings of this study, in JSON."""
    common = {name: value for name, value in given.describe().items() if name not in ("design", "duration", "periods")}
    return json.dumps({**common, **own})


@dataclass(frozen=True, slots=True, kw_only=True)
class _Case:
    """A run: a record with a change; `place` 0 means no change."""

    record: int
    place: int
    motion: BaseMotion
    scale: float
    turn: float
    delay: float
    values: Mapping[str, float]
    tolerance: float
    rest_energy: float | None
    followed: float
    slenderness: float


@dataclass(frozen=True, slots=True)
class _Arrays:
    """Results over record, rotation and change; the first change is none."""

    outcome: npt.NDArray[np.int8]
    peak_tilt: Floats
    uncertain: npt.NDArray[np.bool_]
    slenderness: Floats

    @classmethod
    def empty(cls, shape: tuple[int, ...]) -> "_Arrays":
        """Create arrays of runs that are not computed yet."""
        return cls(
            np.full(shape, NOT_COMPUTED, dtype=np.int8), np.full(shape, np.nan), np.zeros(shape, bool), np.ones(shape)
        )

    def put(self, group: Sequence[_Case], runs: xr.Dataset, rotations: int) -> None:
        """Store the runs of a group of cases, each at all rotations."""
        for name in _KEPT:
            values = runs[name].to_numpy().reshape(len(group), rotations)
            for case, row in zip(group, values, strict=True):
                getattr(self, name)[case.record, :, case.place] = row
        for case in group:
            self.slenderness[case.record, :, case.place] = case.slenderness


def _checked(changes: Sequence[Perturbation]) -> tuple[Perturbation, ...]:
    for change in changes:
        if not isinstance(change, Perturbation):
            message = f"changes must be perturbations such as ScaledRecord(1.02), got {change!r}"
            raise ParameterError(message)
    names = [change.name for change in changes]
    if not names or len(set(names)) < len(names):
        message = f"changes must hold at least one change, each only once, got {names}"
        raise ParameterError(message)
    return tuple(changes)


def _cases(
    model: Model, named: Mapping[str, BaseMotion], changes: Sequence[Perturbation], tail: float | None
) -> list[_Case]:
    cases = []
    for record, motion in enumerate(named.values()):
        for place, change in enumerate((None, *changes)):
            moved = motion if change is None else change.changed_motion(motion)
            values = {} if change is None else change.changed_values(model)
            if moved is None or values is None:
                continue
            column = changed_model(model, values).column
            later = 0.0 if change is None else change.delay(motion)
            cases.append(
                _Case(
                    record=record,
                    place=place,
                    motion=moved,
                    scale=1.0 if change is None else change.scale_factor,
                    turn=0.0 if change is None else change.turn,
                    delay=later,
                    values=values,
                    tolerance=1.0 if change is None else change.tolerance_factor,
                    rest_energy=None if change is None else change.rest_threshold,
                    followed=moved.duration + later + tail_of(column, tail),
                    slenderness=column.slenderness,
                )
            )
    return cases


def _grouped(cases: Sequence[_Case]) -> list[list[_Case]]:
    """Group the cases into sweeps: a sweep varies the same parameters with one tolerance and rest energy."""
    groups: dict[tuple[tuple[str, ...], float, float | None, bool], list[_Case]] = {}
    for case in cases:
        kind = (tuple(case.values), case.tolerance, case.rest_energy, case.delay > 0.0)
        groups.setdefault(kind, []).append(case)
    return list(groups.values())


def _run(
    model: Model,
    group: Sequence[_Case],
    scale: float,
    angles: Floats,
    executor: Executor | None,
    options: Mapping[str, Any],
) -> xr.Dataset:
    each = np.repeat(np.arange(len(group)), angles.size)
    motions = list({id(case.motion): case.motion for case in group}.values())
    number = {id(motion): place for place, motion in enumerate(motions)}
    tolerance = group[0].tolerance
    chosen = {**options, "rtol": tolerance * options.get("rtol", DEFAULTS["rtol"])}
    if options.get("atol") is not None:
        chosen["atol"] = tolerance * options["atol"]
    if group[0].rest_energy is not None:
        chosen["rest_energy"] = group[0].rest_energy
    at: dict[str, npt.ArrayLike] = {
        "motion": np.array([number[id(case.motion)] for case in group])[each],
        "scale": scale * np.array([case.scale for case in group])[each],
        "rotation": np.tile(angles, len(group)) + np.array([case.turn for case in group])[each],
        "duration": np.array([case.followed for case in group])[each],
        **({"delay": np.array([case.delay for case in group])[each]} if group[0].delay > 0.0 else {}),
        **{name: np.array([case.values[name] for case in group])[each] for name in group[0].values},
    }
    sweep = Sweep.points(model, OneOf(motions=tuple(motions)), at=at, **chosen)
    return run_sweep(sweep, executor=executor)


def _as_dataset(
    arrays: _Arrays, names: list[str], angles: Floats, changes: Sequence[Perturbation], scale: float
) -> xr.Dataset:
    dims = ("record", "rotation", "change")
    runs = xr.Dataset(
        {name: (dims, getattr(arrays, name)) for name in _KEPT},
        coords={
            "record": names,
            "rotation": ("rotation", angles, attributes_of("rotation")),
            "change": ["as given", *(change.name for change in changes)],
        },
    )
    slenderness = xr.DataArray(arrays.slenderness, dims=dims)
    runs = runs.assign(tilt_ratio=tilt_ratios(runs, slenderness), reached=limit_states(runs, slenderness=slenderness))
    if angles.size == 1:
        runs = runs.isel(rotation=0)
    given, changed = runs.isel(change=_AS_GIVEN, drop=True), runs.isel(change=slice(1, None))
    decided = (changed["reached"] >= 0) & (given["reached"] >= 0)
    flips = decided & (changed["reached"] != given["reached"])
    compared = decided.sum("change")
    overturning = flips.sel({LIMIT_STATE: "overturning"}, drop=True)
    peaks = runs["tilt_ratio"]
    rocking = peaks.where(np.isfinite(peaks) & (peaks > 0.0))
    logs = peaks.copy(data=np.log(rocking.to_numpy()))
    # The method std warns of columns that rocked in no more than one change with some versions of NumPy.
    squares = ((logs - logs.mean("change")) ** 2).sum("change", min_count=2)
    dispersion = (squares / (logs.count("change") - 1)) ** 0.5
    one = {"units": "1"}
    return changed.assign(
        applies=(changed["outcome"] != NOT_COMPUTED).assign_attrs(long_name="the change applies"),
        flips=flips.assign_attrs(long_name="the change alters the verdict"),
        outcome_as_given=given["outcome"],
        tilt_ratio_as_given=given["tilt_ratio"],
        reached_as_given=given["reached"],
        changes_compared=compared.assign_attrs(**one, long_name="changes that apply and are decided"),
        share_flipped=(flips.sum("change") / compared.where(compared > 0)).assign_attrs(
            **one, long_name="fraction of the changes that flip the verdict"
        ),
        repeatable=(~overturning.any("change")).assign_attrs(long_name="no change flips overturning"),
        tilt_ratio_low=peaks.min("change").assign_attrs(**one, long_name="minimum peak tilt / α_c"),
        tilt_ratio_high=peaks.max("change").assign_attrs(**one, long_name="maximum peak tilt / α_c"),
        tilt_dispersion=dispersion.assign_attrs(**one, long_name="scatter of ln(peak tilt)"),
        change_of=("change", [change.of.value for change in changes]),
    ).assign_attrs(kind="robustness", scale=scale)
