"""Slow sweep: integration of a column while a parameter steps through its values."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.engine import simulate_ensemble, with_parameters
from stylobate.errors import Interrupted, Outcome, ParameterError, UnsupportedError, as_numbers, require_whole
from stylobate.models import Model
from stylobate.orbits.orbit import require_subject
from stylobate.parameter_quantities import attributes_of, quantity_of
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED, outcome_attributes
from stylobate.run_arguments import Accuracy, defaults_of
from stylobate.studies.sweeps.designs import Floats, checked_values

# Samples per period for the mean tilt.
_SAMPLES = 64
# Relative tolerance of the end of a run.
_SLACK = 1e-9
# Each step begins near the motion that it ends in: a run with several beats of a modulation is long enough to see it.
_RULES = OutcomeRules(periods=25, steady_periods=51)

_ENDINGS = (Outcome.OVERTURNED, Outcome.LIMIT_REACHED, Outcome.LIFTED_OFF, Outcome.FAILED)
_NUMBERS = {
    "mean_tilt": ("mean tilt", "rad"),
    "minimum_tilt": ("minimum tilt", "rad"),
    "peak_tilt": ("peak tilt", "rad"),
    "turns_per_period": ("turns per period", "1"),
}
_VECTORS = {
    "end_tilt": ("tilt vector at the end of the step", "rad"),
    "end_tilt_rate": ("rate of the tilt vector at the end of the step", "rad s-1"),
}
_PLANE, _AXES = 2, 2


@shows_progress("slow sweep")
def slow_sweep(
    model: Model,
    motion: BaseMotion,
    *,
    parameter: str = "angular_frequency",
    values: npt.ArrayLike,
    tilt: npt.ArrayLike,
    tilt_rate: npt.ArrayLike = (0.0, 0.0),
    periods_each: int = 200,
    back: bool = False,
    threads: int | None = None,
    progress: Progress = None,
    **options: Unpack[Accuracy],
) -> xr.Dataset:
    """Integrate columns while a parameter steps through its values, to show jumps and hysteresis.

    At each value a column continues from its state at the value before, tilt and tilt rate in SI units. Each step
    lasts a whole number of its own periods, so every step begins at the phase of t = 0. If the frequency steps, the
    base acceleration is continuous and only its rate jumps. The sweep uses direct integration only, so it is an
    independent check of branches of periodic orbits.

    Parameters
    ----------
    model, motion
        The column and its base motion, periodic from t = 0.
    parameter
        Name of the parameter that steps, one of those of `simulate_ensemble`.
    values
        Its values in order: shape (n,), or (n, m) for m different sweeps.
    tilt, tilt_rate
        Initial conditions at the first value [rad], [rad/s]: shape (2,), or (m, 2) for m sweeps.
    periods_each
        Periods for which each value is held. The disturbance by a step decays as exp(−ηω0 t/2), but far more slowly
        near a bifurcation, where a sweep lags behind. Near the edge of a basin a step can overturn a column that
        smaller steps would not overturn.
    back
        Return through the values after the last one.
    threads
        As in `simulate_ensemble`.
    progress
        A function that is called as `progress(steps done, steps in all)`; a bar by default, False for none.
    **options
        Accuracy and rules of the runs as in `simulate_ensemble`. By default the rules of the outcome at each value have
        25 `periods` and 51 `steady_periods`. With n = `rules.periods` the last 2n + 1 periods decide.

    Returns
    -------
    xarray.Dataset
        Of kind "slow sweep", over (step, sweep), `parameter` among the coordinates: over the last 2n + 1 periods of
        each step `mean_tilt`, `minimum_tilt`, `peak_tilt` [rad], `turns_per_period`, anticlockwise positive, and the
        `outcome`; `end_tilt` [rad] and `end_tilt_rate` [rad/s], the state at the phase of t = 0 with which the step
        ends. A column that overturned (or lifted off, or failed) has this outcome and NaN; later steps are not
        computed. A column at rest has tilts and turns of zero; it continues from rest, since a later value may make it
        move.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    UnsupportedError
        If the base motion is not periodic from t = 0.
    Interrupted
        After Ctrl-C; its `partial` is the Dataset with the steps that were done.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.5)
    >>> start = sb.studies.steady_start(model, motion)
    >>> sweep = sb.studies.slow_sweep(model, motion, values=[1.5, 1.44, 1.38, 1.3], **start)
    >>> [sb.Outcome(code).name for code in sweep["outcome"].values[:, 0]]
    ['ROLLING', 'ROLLING', 'MODULATED', 'OVERTURNED']
    """
    require_subject(model, motion)
    held = options.get("rules") or _RULES
    watched = 2 * held.periods + 1
    steps, starts = _together(parameter, values, tilt, tilt_rate)
    if back:
        steps = np.concatenate([steps, steps[-2::-1]])
    hold = _Hold(
        model,
        motion,
        parameter,
        settling=require_whole("periods_each", periods_each, least=watched) - watched,
        watched=watched,
        options={**options, "rules": held, "threads": threads},
    )
    periods = _periods(hold, steps)
    table = _empty(steps.shape)

    def result() -> xr.Dataset:
        kept = {"tilt": starts[0].tolist(), "tilt_rate": starts[1].tolist(), "periods_each": periods_each}
        accuracy = {**defaults_of(Accuracy), **options, "rules": asdict(held)}
        provenance = provenance_of_run(model, motion, **kept, **accuracy)
        return _dataset(table, steps, parameter, watched, provenance)

    state, moving = starts, np.ones(steps.shape[1], dtype=bool)
    for step, at in enumerate(steps):
        if not moving.any():
            break
        try:
            found = hold.followed(at[moving], periods[step][moving], state[0][moving], state[1][moving])
        except KeyboardInterrupt:
            raise Interrupted("interrupted; `partial` has the steps that were done", result()) from None
        for name, column in found.items():
            table[name][step, moving] = column
        state = table["end_tilt"][step], table["end_tilt_rate"][step]
        moving &= ~np.isin(table["outcome"][step], _ENDINGS)
        report_of(progress)(step + 1, len(steps))
    return result()


@dataclass(frozen=True, slots=True)
class _Hold:
    """Integration of columns at one value of the parameter each: for `settling`, then for `watched` periods."""

    model: Model
    motion: BaseMotion
    parameter: str
    settling: int
    watched: int
    options: Mapping[str, Any]

    def followed(self, at: Floats, period: Floats, tilt: Floats, tilt_rate: Floats) -> dict[str, npt.NDArray[Any]]:
        """Return the results at these values from these states, each of m rows; NaN for columns that have ended."""
        ended = np.zeros(at.size, dtype=bool)
        outcome = np.zeros(at.size, dtype=np.int8)
        if self.settling:
            runs = self._runs(at, self.settling * period, tilt, tilt_rate)
            outcome = runs["outcome"].to_numpy()
            ended = np.isin(outcome, _ENDINGS)
            tilt, tilt_rate = runs["end_tilt"].to_numpy(), runs["end_tilt_rate"].to_numpy()
        found = _empty(at.shape)
        found["outcome"][ended] = outcome[ended]
        if not ended.all():
            going = ~ended
            for name, column in self._watched(at[going], period[going], tilt[going], tilt_rate[going]).items():
                found[name][going] = column
        return found

    def _watched(self, at: Floats, period: Floats, tilt: Floats, tilt_rate: Floats) -> dict[str, npt.NDArray[Any]]:
        samples = _SAMPLES * self.watched + 1
        runs = self._runs(at, self.watched * period, tilt, tilt_rate, samples=samples)
        sampled = np.hypot(*np.moveaxis(runs["sampled_tilt"].to_numpy(), -1, 0))
        found = {
            "mean_tilt": np.trapezoid(sampled, axis=1) / (samples - 1),
            "minimum_tilt": runs["minimum_tilt"].to_numpy(),
            "peak_tilt": runs["peak_tilt"].to_numpy(),
            "turns_per_period": runs["turns"].to_numpy() / self.watched,
        }
        # A run that came to rest permanently ended early: the column stands.
        outcome = runs["outcome"].to_numpy()
        early = runs["end_time"].to_numpy() < (1.0 - _SLACK) * self.watched * period
        for column in found.values():
            column[early & (outcome == Outcome.AT_REST)] = 0.0
        found |= {name: runs[name].to_numpy() for name in _VECTORS}
        for column in found.values():
            column[np.isin(outcome, _ENDINGS)] = np.nan
        return {"outcome": outcome, **found}

    def _runs(
        self, at: Floats, duration: Floats, tilt: Floats, tilt_rate: Floats, samples: int | None = None
    ) -> xr.Dataset:
        return simulate_ensemble(
            self.model,
            self.motion,
            tilt=tilt,
            tilt_rate=tilt_rate,
            duration=duration,
            parameters={self.parameter: at},
            samples=samples,
            **self.options,
        )


def _together(
    parameter: str, values: npt.ArrayLike, tilt: npt.ArrayLike, tilt_rate: npt.ArrayLike
) -> tuple[Floats, tuple[Floats, Floats]]:
    """Return values, shape (n, m), and tilt and rate, shape (m, 2), of the sweeps."""
    steps = _array("values", values, quantity_of(parameter).unit)
    if steps.ndim not in (1, _PLANE) or not steps.size:
        raise ParameterError(
            f"values must have the shape (n,), or (n, m) for m sweeps, and not be empty; got {steps.shape}"
        )
    steps = checked_values("values", parameter, steps.ravel()).reshape(len(steps), -1)
    vectors = [_array("tilt", tilt, "rad"), _array("tilt_rate", tilt_rate, "rad/s")]
    for name, vector in zip(("tilt", "tilt_rate"), vectors, strict=True):
        if vector.ndim not in (1, _PLANE) or vector.shape[-1] != _AXES:
            raise ParameterError(f"{name} must have the shape (2,), or (m, 2) for m sweeps; got {vector.shape}")
    counts = {steps.shape[1], *(np.atleast_2d(vector).shape[0] for vector in vectors)}
    if len(counts - {1}) > 1:
        raise ParameterError(
            f"values, tilt and tilt_rate must be of one number of sweeps, or of one each; got {sorted(counts)}"
        )
    many = max(counts)
    first, second = (np.broadcast_to(vector, (many, _AXES)).copy() for vector in vectors)
    return np.broadcast_to(steps, (len(steps), many)).copy(), (first, second)


def _array(name: str, values: npt.ArrayLike, unit: str) -> Floats:
    values = as_numbers(name, values, unit)
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(f"{name} must be an array of numbers, got {values!r}") from None


def _periods(hold: _Hold, steps: Floats) -> Floats:
    """Return the period of the base motion at each value [s]."""
    periods: Floats = np.empty_like(steps)
    for value in np.unique(steps):
        _, changed = with_parameters(hold.model, hold.motion, **{hold.parameter: float(value)})
        if changed.period is None or changed.breaks:
            raise UnsupportedError(
                f"slow_sweep needs a base motion that is periodic from t = 0, without ramp or delay; got {changed!r}"
            )
        periods[steps == value] = changed.period
    return periods


def _empty(shape: tuple[int, ...]) -> dict[str, npt.NDArray[Any]]:
    return {
        "outcome": np.full(shape, NOT_COMPUTED, dtype=np.int8),
        **{name: np.full(shape, np.nan) for name in _NUMBERS},
        **{name: np.full((*shape, _AXES), np.nan) for name in _VECTORS},
    }


def _dataset(
    table: Mapping[str, npt.NDArray[Any]],
    steps: Floats,
    parameter: str,
    watched: int,
    provenance: Mapping[str, Any],
) -> xr.Dataset:
    dims = ("step", "sweep")
    variables: dict[str, Any] = {"outcome": (dims, table["outcome"], outcome_attributes())}
    for names, more in ((_NUMBERS, ()), (_VECTORS, ("axis",))):
        for name, (long_name, units) in names.items():
            variables[name] = ((*dims, *more), table[name].copy(), {"long_name": long_name, "units": units})
    return xr.Dataset(
        variables,
        coords={parameter: (dims, steps, attributes_of(parameter)), "axis": ["x", "y"]},
        attrs={
            "kind": "slow sweep",
            "parameter": parameter,
            "watched_periods": watched,
            "provenance": json.dumps({**provenance, "parameter": parameter}),
        },
    )
