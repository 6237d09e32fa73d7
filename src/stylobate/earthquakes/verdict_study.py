"""The verdict on a case: runs under joint small variations, and the share of them that overturns the column."""

import inspect
import json
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from functools import partial
from typing import Any, Unpack, cast

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.special import fdtrc

from stylobate.base_motions import BaseMotion, OneOf, Record
from stylobate.config import config_of
from stylobate.earthquakes.config.verdict import VerdictConfig, described_spread
from stylobate.earthquakes.incremental import tilt_ratios
from stylobate.earthquakes.property_spreads import (
    VARIATIONS,
    Spread,
    check_variations,
    chosen_variations,
    drawn,
    inertia_spreads,
    scaled_dissipation,
    shares_of,
)
from stylobate.earthquakes.study_inputs import tail_of
from stylobate.engine.parameters import COLUMN_NAMES, model_names
from stylobate.errors import (
    LARGEST_SEED,
    MOST_RUNS,
    Interrupted,
    Outcome,
    ParameterError,
    UnlikelyInputWarning,
    UnsupportedError,
    require_not_negative,
    require_whole,
)
from stylobate.models import Model, Rolling, Slender, SlenderRolling, Wobbling
from stylobate.models.declared import dissipation_of
from stylobate.progress import Progress, Report, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.quantities import parameters_of
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.results.verdict import CONTACT_LAW, KIND, Verdict, damping_yardstick, yardstick_text
from stylobate.run_arguments import RunOptions, defaults_of
from stylobate.studies.checks import require_no_limits
from stylobate.studies.maps.uncertainty_exponent import overturned_or_not
from stylobate.studies.proportions import fraction_interval, require_confidence
from stylobate.studies.sweeps import Executor, Sweep, run_sweep
from stylobate.studies.sweeps.designs import Floats
from stylobate.text import did_you_mean, plural

# A rim that carries no twisting moment, and one that keeps a column from turning about its axis.
_OTHER_CONTACT_LAW: Mapping[type[Model], type[Model]] = {
    Wobbling: Rolling,
    Rolling: Wobbling,
    Slender: SlenderRolling,
    SlenderRolling: Slender,
}
# Variations of the runs themselves, not of column or base motion.
_OF_THE_INTEGRATION = ("tolerance",)
_PARTS = 6
"""Number of parts of equal probability into which the values of each variation are divided."""
# A variation that explains nothing exceeds its critical influence with this probability, over all variations.
_BY_CHANCE = 0.01
_KEPT = ("outcome", "peak_tilt", "uncertain")
_LONGER = 8.0
"""Factor of the default tail for the runs that still move at its end: 160/p."""


@shows_progress("variations")
def verdict(
    models: Model | Sequence[Model],
    motion: BaseMotion,
    *,
    variations: Mapping[str, Spread | None] | None = None,
    runs: int = 300,
    seed: int = 0,
    confidence: float = 0.9,
    tail: float | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> Verdict:
    """Decide whether a column overturns, from many runs that differ in what is never known exactly.

    A change far below the accuracy of any record or measurement can alter the outcome of a single rocking run. The
    share of such changes that overturn the column does not have this defect.

    Parameters
    ----------
    models
        One three-dimensional model, or several, each as probable. With one model the contact law is varied: `Wobbling`
        and `Rolling` (or `Slender` and `SlenderRolling`) take turns, with the same parameters. A list of one model, or
        a model of another class, is used alone.
    motion
        A base motion that ends, such as a record or a pulse.
    variations
        Changes to the default variations scale, clock, lowpass, rotation, slope_x, slope_y, start_x, start_y, size,
        slenderness, dissipation and tolerance, and of estimated moments of inertia transverse_inertia and
        axial_inertia: a distribution for one of them or for any parameter of column or model, such as `{"damping":
        LogUniformSpread(0.03, 0.1)}`; None leaves a variation out, also "contact_law".
        "dissipation" does not change parameters that are stated here.
    runs
        Number of variations.
    seed
        Seed of the random numbers. Each variation has its own, so leaving one out does not change the others; more
        runs begin with the same.
    confidence
        Confidence level of the intervals.
    tail
        Free-vibration time after the motion [s]; by default 20/p, and 160/p for runs that still move then.
    executor, progress
        As in `run_sweep`.
    **options
        Options of all runs, as in `simulate_ensemble`, such as `rtol`.

    Returns
    -------
    Verdict
        Its `word` is "stands" if the confidence interval of the share lies below 5 %, "overturns" if it lies above
        95 %, else "undecided". Its `data`:

        * over `run`: `law` (index of the model), `overturned` (1, 0, −1 if undecided), `outcome`, `tilt_ratio` (peak
          tilt over α_c, infinite if overturned), `uncertain` (numerically), and over `variation` too `value`;
        * `share`, `share_low`, `share_high`: share of overturning with its interval (Wilson's; undecided runs count on
          both sides, also those that still move and may overturn later); over `model`: `model_share`,
          `model_share_low`, `model_share_high`, `model_runs`;
        * over `variation`: `influence`, the fraction of the variance of the outcome that this variation explains alone
          (correlation ratio, corrected for chance, Kelley 1935), and over `part`, from its lowest to its highest values
          in equal numbers, `part_share`;
        * attributes: `deciding`, the variation with the largest influence, empty if chance explains it (F test, 1 %
          over all variations); `provenance`, all inputs.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    Interrupted
        On Ctrl-C; `partial` is the verdict on the runs so far, in which the others count as undecided.

    Warns
    -----
    UnlikelyInputWarning
        If the column loses no energy while it rocks.

    Notes
    -----
    A clock that runs fast by a factor f is computed by similarity: a column with lengths divided by f² under the record
    itself.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Wobbling(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.1)
    >>> pulse = sb.Pulse.one_sine(acceleration=6.0, angular_frequency=4.0)
    >>> print(sb.verdict(model, pulse, runs=100))
    overturns: 100 % of 100 variations overturn (90 % sampling interval 97 to 100 %)
    """
    require_no_limits(options)
    _check_motion(motion)
    _check_options(options)
    one_law = isinstance(variations, Mapping) and variations.get(CONTACT_LAW, "") is None
    laws = contact_laws([models] if one_law and isinstance(models, Model) else models)
    case = _Case(
        models=laws,
        motion=motion,
        variations=chosen_variations(variations, inertia_spreads(laws[0].column)),
        runs=require_whole("runs", runs, least=2, most=MOST_RUNS),
        seed=require_whole("seed", seed, least=0, most=LARGEST_SEED),
        confidence=require_confidence(confidence),
        tail=None if tail is None else require_not_negative("tail", tail, "s"),
        options=options,
    )
    check_variations(case.models, case.variations)
    _check_values(case)
    if remark := undamped(case.models[0], case.variations):
        warnings.warn(remark, UnlikelyInputWarning, stacklevel=3)
    try:
        return Verdict(case.labelled(case.computed(executor, report_of(progress))))
    except Interrupted as stop:
        raise Interrupted(str(stop), Verdict(case.labelled(stop.partial))) from None


def undamped(model: Model, variations: Mapping[str, Spread]) -> str:
    """Return a warning if no variation of a model loses energy while it rocks, with Housner's damping; else empty."""
    stated = [name for name in dissipation_of(type(model)) if name in variations]
    if stated or scaled_dissipation(model, np.ones(1), {}) or not dissipation_of(type(model)):
        return ""
    yardstick = yardstick_text(damping_yardstick(model.column).values())
    return (
        "damping: the column loses no energy while it rocks, and the variation `dissipation` changes nothing (got 0). "
        f"Housner's impacts lose as much as {yardstick}: pass damping=column.housner_damping() or a measured value"
    )


def _check_motion(motion: BaseMotion) -> None:
    """Raise ParameterError unless the motion is one base motion that ends."""
    if not isinstance(motion, BaseMotion):
        raise ParameterError(f"motion: must be one base motion (got {motion!r}). Pass each record by itself.")
    if not 0.0 < motion.duration < math.inf:
        raise ParameterError(
            f"motion: must end after t = 0 (got {motion!r} with a duration of {motion.duration:g} s). Pass a record, a "
            "pulse or a sine sweep."
        )


def _check_options(options: Mapping[str, Any]) -> None:
    """Raise ParameterError for an argument that a verdict does not have."""
    known = [*inspect.signature(verdict).parameters, *RunOptions.__annotations__]
    for name in options:
        if name in ("duration", "periods"):
            raise ParameterError(
                f"{name}: a verdict sets it for each variation (got {options[name]!r}). Pass tail= instead."
            )
        if name not in RunOptions.__annotations__:
            remedy = did_you_mean(name, known) or "remove it"
            raise ParameterError(f"{name}: is no argument of verdict (got {options[name]!r}); {remedy}")


def _check_values(case: "_Case") -> None:
    """Raise ParameterError if a distribution has values outside the range of its parameter."""
    for model in case.models:
        for name, spread in case.variations.items():
            quantity = parameters_of(type(model)).get(name)
            if quantity is None:
                continue
            values = drawn(name, spread, model, runs=case.runs, seed=case.seed)
            for value in (float(values.min()), float(values.max())):
                try:
                    quantity.quantity.checked(name, value)
                except ParameterError as error:
                    raise ParameterError(
                        f"variations[{name!r}]: {error}. Pass a distribution within this range."
                    ) from None


def repeat_verdict(saved: Verdict) -> Verdict:
    """Compute a verdict again from its provenance.

    Parameters
    ----------
    saved
        A verdict, such as one that `stylobate.load` read.

    Returns
    -------
    Verdict
        The same verdict, bit for bit on the same machine and version.

    Raises
    ------
    UnsupportedError
        If descriptions do not support a model, the base motion or a distribution.
    """
    given = saved.provenance["verdict"]
    for name, spread in given["variations"].items():
        if spread and spread.get("kind") == "other":
            raise UnsupportedError(
                f"variations[{name!r}]: only the text of this distribution is kept (got {spread['repr']})"
            )
    numbers = {name: value for name, value in given.items() if name in VerdictConfig.model_fields and value is not None}
    models = [config_of({**_case_of(saved), **case}).build().model for case in given["models"]]
    motion = config_of(_case_of(saved)).build().motion
    options: Any = dict(given["options"])
    if "rules" in options:
        options["rules"] = OutcomeRules(**options["rules"])
    return verdict(models, motion, **VerdictConfig.of(numbers), **options)


def _case_of(saved: Verdict) -> dict[str, Any]:
    return {name: value for name, value in saved.provenance.items() if name != "verdict"}


def contact_laws(models: Model | Sequence[Model]) -> tuple[Model, ...]:
    """Return the models of a verdict: the given ones, or one model and that of the other contact law.

    Raises
    ------
    ParameterError
        If there is no model, or one is not three-dimensional.
    """
    given = tuple(models) if isinstance(models, Sequence) else (models,)
    for model in given:
        if not isinstance(model, Model) or model.planar_only:
            raise ParameterError(
                f"models: must be three-dimensional models (got {model!r}). Use one such as Wobbling(column)."
            )
    if not given:
        raise ParameterError(f"models: must be at least one model (got {models!r}). Pass one such as Wobbling(column).")
    if not isinstance(models, Model) or not has_other_contact_law(models):
        return given
    return models, with_other_contact_law(models)


def has_other_contact_law(model: Model) -> bool:
    """Return whether the package has the model of the other contact law for a model."""
    return type(model) in _OTHER_CONTACT_LAW


def with_other_contact_law(model: Model) -> Model:
    """Return the column with the other contact law; the shared parameters are those of `model`."""
    other: Any = _OTHER_CONTACT_LAW[type(model)]
    shared = set(model_names(model)) & {field.name for field in fields(other)}
    made: Model = other(model.column, **{name: getattr(model, name) for name in shared})
    return made


@dataclass(frozen=True, slots=True, kw_only=True)
class _Case:
    """The checked arguments of a verdict."""

    models: tuple[Model, ...]
    motion: BaseMotion
    variations: Mapping[str, Spread]
    runs: int
    seed: int
    confidence: float
    tail: float | None
    options: RunOptions

    @property
    def law(self) -> npt.NDArray[np.intp]:
        """Index of the model of each run."""
        shares = shares_of(CONTACT_LAW, runs=self.runs, seed=self.seed)
        return np.minimum((shares * len(self.models)).astype(np.intp), len(self.models) - 1)

    @property
    def values(self) -> dict[str, Floats]:
        """Values of each variation, shape (runs,); of a parameter of column or model, those of the model of the run."""
        by_model = [
            {
                name: drawn(name, spread, model, runs=self.runs, seed=self.seed)
                for name, spread in self.variations.items()
            }
            for model in self.models
        ]
        return {name: np.choose(self.law, [values[name] for values in by_model]) for name in self.variations}

    def computed(self, executor: Executor | None, progress: Report) -> xr.Dataset:
        """Compute the runs, in one sweep for each model and tolerance.

        Raises
        ------
        Interrupted
            On Ctrl-C; `partial` has the runs so far, those that were not computed with the outcome −1.
        """
        values, law = self.values, self.law
        members, member = self._members(values)
        kinds = np.stack([law, *(values[name] for name in _OF_THE_INTEGRATION if name in values)], axis=1)
        groups = np.unique(kinds, axis=0)
        found = {name: np.full(self.runs, NOT_COMPUTED if name == "outcome" else np.nan) for name in _KEPT}
        slenderness, done, stopped = np.full(self.runs, np.nan), 0, ""
        for group in groups:
            chosen = np.flatnonzero((kinds == group).all(axis=1))
            model = self.models[int(group[0])]
            own = {name: array[chosen] for name, array in values.items()}
            at = {"motion": member[chosen].astype(float), **self._quantities(model, own)}
            slenderness[chosen] = at.get("slenderness", np.full(chosen.size, model.column.slenderness))
            tolerance = float(group[1]) if group.size > 1 else 1.0
            sweep = partial(Sweep.points, model, OneOf(motions=members), **self._integrated(tolerance))
            try:
                runs = self._followed(sweep, at, executor, partial(_within, progress, done, self.runs))
            except Interrupted as stop:
                runs, stopped = stop.partial, str(stop)
            for name in _KEPT:
                found[name][chosen] = runs[name].to_numpy()
            done += chosen.size
            if stopped:
                break
        codes = runs["outcome"]
        data = xr.Dataset(
            {
                "outcome": ("run", found["outcome"].astype(np.int8), codes.attrs),
                "peak_tilt": ("run", found["peak_tilt"], runs["peak_tilt"].attrs),
                "uncertain": ("run", np.nan_to_num(found["uncertain"]).astype(np.int8), runs["uncertain"].attrs),
            }
        )
        data = data.assign(tilt_ratio=tilt_ratios(data, xr.DataArray(slenderness, dims="run")))
        if stopped:
            computed = int((data["outcome"] != NOT_COMPUTED).sum())
            message = f"stopped after {computed} of {plural(self.runs, 'variation')}; `partial` is the verdict so far"
            raise Interrupted(message, data)
        return data

    def _followed(
        self, sweep: Callable[..., Sweep], at: Mapping[str, Floats], executor: Executor | None, progress: Report
    ) -> xr.Dataset:
        """Compute runs; with the default tail, repeat those that still move with a longer one.

        Raises
        ------
        Interrupted
            On Ctrl-C, with the runs so far.
        """
        runs = run_sweep(sweep(at=at), executor=executor, progress=progress)
        late = runs["outcome"].to_numpy() == Outcome.STILL_MOVING
        if self.tail is not None or not late.any():
            return runs
        own = {name: array[late] for name, array in at.items()}
        own["duration"] = self.motion.duration + _LONGER * (own["duration"] - self.motion.duration)
        try:
            longer = run_sweep(sweep(at=own), executor=executor, progress=False)
        except Interrupted as stop:
            raise Interrupted(str(stop), runs) from None
        for name in _KEPT:
            values = runs[name].to_numpy().copy()
            values[late] = longer[name].to_numpy()
            runs = runs.assign({name: runs[name].copy(data=values)})
        return runs

    def _members(self, values: Mapping[str, Floats]) -> tuple[tuple[BaseMotion, ...], npt.NDArray[np.intp]]:
        """Return the filtered copies of the motion, and the index of that of each run."""
        if "lowpass" not in values:
            return (self.motion,), np.zeros(self.runs, dtype=np.intp)
        corners, member = np.unique(values["lowpass"], return_inverse=True)
        return tuple(_filtered(self.motion, float(corner)) for corner in corners), member.astype(np.intp)

    def _quantities(self, model: Model, values: Mapping[str, Floats]) -> dict[str, Floats]:
        """Return the quantities of a sweep for these values of the variations."""
        count = next(iter(values.values())).size if values else self.runs
        own = {name: array for name, array in values.items() if name in model_names(model) or name in COLUMN_NAMES}
        if "dissipation" in values:
            own |= scaled_dissipation(model, values["dissipation"], own)
        clock = values.get("clock", np.ones(count))
        size = own.pop("size", np.ones(count)) / clock**2
        tail = tail_of(model.column) * np.sqrt(size) if self.tail is None else self.tail / clock
        tilt = {**defaults_of(RunOptions), **self.options}["tilt"]
        alpha, gravity = np.arctan(own.get("slenderness", model.column.slenderness)), model.column.gravity
        return {
            **own,
            "size": size,
            "duration": self.motion.duration + tail,
            **{name: values[name] for name in ("scale", "rotation") if name in values},
            **{f"tilt_{k}": tilt["xy".index(k)] + values[f"start_{k}"] * alpha for k in "xy" if f"start_{k}" in values},
            **{f"offset_{k}": gravity * np.sin(values[f"slope_{k}"]) for k in "xy" if f"slope_{k}" in values},
        }

    def _integrated(self, tolerance: float) -> RunOptions:
        chosen = {**defaults_of(RunOptions), **self.options}
        chosen["rtol"] *= tolerance
        if chosen.get("atol") is not None:
            chosen["atol"] = tolerance * chosen["atol"]
        return cast("RunOptions", chosen)

    def labelled(self, data: xr.Dataset) -> xr.Dataset:
        """Add shares, intervals and influences to the runs."""
        state, law = _states(data), self.law
        values = {**({CONTACT_LAW: law.astype(float)} if len(self.models) > 1 else {}), **self.values}
        parts = {name: _parts_of(array) for name, array in values.items()}
        influence = np.array([_influence(state, part) for part in parts.values()])
        of_law = [state[law == place] for place in range(len(self.models))]
        level = f"{100.0 * self.confidence:g} % sampling interval"
        names = {"": "share of overturning", "_low": f"lower end of its {level}", "_high": f"upper end of its {level}"}
        shares = _share(state, self.confidence)
        law_shares = np.array([_share(one, self.confidence) for one in of_law]).T
        counted: dict[str, Any] = {}
        for place, (end, text) in enumerate(names.items()):
            counted[f"share{end}"] = ((), shares[place], _about(text))
            counted[f"model_share{end}"] = ("model", law_shares[place], _about(text))
        return (
            data.assign(counted)
            .assign(
                law=("run", law.astype(np.int8), {"long_name": "index of the model"}),
                overturned=("run", state, {"long_name": "1 overturned, 0 did not overturn, −1 undecided"}),
                value=(
                    ("variation", "run"),
                    np.reshape(list(values.values()), (-1, self.runs)),
                    {"long_name": "value"},
                ),
                model_runs=("model", [one.size for one in of_law], _about("runs")),
                influence=("variation", influence, _about("fraction of the variance explained")),
                part_share=(
                    ("variation", "part"),
                    np.reshape([_part_shares(state, part) for part in parts.values()], (-1, _PARTS)),
                    _about(names[""]),
                ),
            )
            .assign_coords(model=[model.name for model in self.models], variation=list(values))
            .assign_attrs(
                kind=KIND,
                confidence=self.confidence,
                deciding=_deciding(state, parts, influence),
                provenance=json.dumps(self.provenance),
            )
        )

    @property
    def provenance(self) -> dict[str, Any]:
        """Return all inputs as plain values: those of a run with the first model, and of the verdict."""
        described = [provenance_of_run(model, self.motion) for model in self.models]
        return {
            **described[0],
            "verdict": {
                "models": [{name: one[name] for name in ("column", "model")} for one in described],
                "variations": {
                    **dict.fromkeys((*VARIATIONS, *inertia_spreads(self.models[0].column)), False),
                    **{name: described_spread(spread) for name, spread in self.variations.items()},
                },
                "runs": self.runs,
                "seed": self.seed,
                "confidence": self.confidence,
                "tail": self.tail,
                "options": {
                    name: asdict(value) if isinstance(value, OutcomeRules) else value
                    for name, value in self.options.items()
                    if value is not None
                },
            },
        }


def _within(progress: Report, before: int, total: int, done: int, _: int) -> None:
    progress(before + done, total)


def _about(long_name: str) -> dict[str, str]:
    return {"units": "1", "long_name": long_name}


def _filtered(motion: BaseMotion, corner: float) -> BaseMotion:
    """Return a record after a low-pass filter of this corner [Hz]; other motions, and finer records, unchanged."""
    if not isinstance(motion, Record) or corner >= 0.5 / motion.step:
        return motion
    return motion.filtered(lowpass=corner)


def _states(data: xr.Dataset) -> npt.NDArray[np.int8]:
    """Return 1 for each run that overturned, 0 for each that cannot, −1 for each without a decision.

    A run that still moves and may overturn later has none.
    """
    decided = np.maximum(overturned_or_not(data), -1)
    return np.where(data["outcome"].to_numpy() == Outcome.STILL_MOVING, -1, decided).astype(np.int8)


def _share(state: npt.NDArray[np.int8], confidence: float) -> tuple[float, float, float]:
    """Return the share of overturning and its interval; NaN, 0 and 1 without runs."""
    if state.size == 0:
        return np.nan, 0.0, 1.0
    overturned, open_runs = int((state == 1).sum()), int((state < 0).sum())
    low, high = fraction_interval(overturned, open_runs, state.size, confidence=confidence)
    return overturned / state.size, float(low), float(high)


def _parts_of(values: Floats) -> npt.NDArray[np.intp]:
    """Return the part of each value: of few different values their index, else one of six parts of equal numbers."""
    levels, index = np.unique(values, return_inverse=True)
    if levels.size <= _PARTS:
        return index.astype(np.intp)
    return np.asarray(np.argsort(np.argsort(values)) * _PARTS // values.size, dtype=np.intp)


def _part_shares(state: npt.NDArray[np.int8], part: npt.NDArray[np.intp]) -> Floats:
    """Return the share of overturning in each part, shape (6,); NaN for a part without decided runs."""
    decided = state >= 0
    counts = np.bincount(part[decided], minlength=_PARTS)
    overturned = np.bincount(part[decided], weights=state[decided] == 1, minlength=_PARTS)
    return np.asarray(np.divide(overturned, counts, out=np.full(_PARTS, np.nan), where=counts > 0))


def _influence(state: npt.NDArray[np.int8], part: npt.NDArray[np.intp]) -> float:
    """Return the correlation ratio of the outcome and the part, corrected for chance (ε² of Kelley 1935)."""
    between, within, parts, count = _scatter(state, part)
    if between + within == 0.0 or count <= parts:
        return 0.0
    return max(0.0, 1.0 - within / (between + within) * (count - 1) / (count - parts))


def _scatter(state: npt.NDArray[np.int8], part: npt.NDArray[np.intp]) -> tuple[float, float, int, int]:
    """Return the sums of squares between and within parts, the number of parts, and that of decided runs."""
    decided = state >= 0
    fallen, part = (state[decided] == 1).astype(float), part[decided]
    if fallen.size == 0:
        return 0.0, 0.0, 0, 0
    counts = np.bincount(part)
    sums = np.bincount(part, weights=fallen)
    filled = counts > 0
    between = float((sums[filled] ** 2 / counts[filled]).sum() - fallen.sum() ** 2 / fallen.size)
    total = float(fallen.sum() - fallen.sum() ** 2 / fallen.size)
    return between, total - between, int(filled.sum()), fallen.size


def _deciding(state: npt.NDArray[np.int8], parts: Mapping[str, npt.NDArray[np.intp]], influence: Floats) -> str:
    """Return the variation with the largest influence; empty if that may be chance."""
    if influence.size == 0:
        return ""
    name = list(parts)[int(np.argmax(influence))]
    between, within, number, count = _scatter(state, parts[name])
    if number < 2 or count <= number or between <= 0.0:  # noqa: PLR2004  parts to compare
        return ""
    ratio = between / (number - 1) / (within / (count - number)) if within > 0.0 else np.inf
    return name if fdtrc(number - 1, count - number, ratio) < _BY_CHANCE / influence.size else ""
