"""Lyapunov exponents of a motion under a periodic base motion."""

import json
import warnings
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.flow.periodic import PeriodicSystem, plane_of
from stylobate.errors import (
    EndedEarlyWarning,
    Interrupted,
    ParameterError,
    as_numbers,
    require_positive,
    require_vector,
    require_whole,
)
from stylobate.models import Model
from stylobate.orbits.orbit import require_subject
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.text import plural

Floats = npt.NDArray[np.float64]

_ENDINGS = {
    FlowStatus.DONE: "reached the end",
    FlowStatus.LOST: "passed through the vertical",
    FlowStatus.GONE: "overturned",
    FlowStatus.FAILED: "could not be followed further: the integration failed",
}
_LEAST_BLOCKS = 2


@shows_progress("Lyapunov exponents")
def lyapunov_exponents(
    model: Model,
    motion: BaseMotion,
    *,
    tilt: npt.ArrayLike,
    tilt_rate: npt.ArrayLike = (0.0, 0.0),
    periods: int = 1000,
    skip: int = 100,
    count: int | None = None,
    blocks: int = 10,
    rtol: float = 1e-10,
    progress: Progress = None,
) -> xr.Dataset:
    """Compute Lyapunov exponents: the mean exponential rates at which nearby motions separate.

    The derivative of the flow over each period, exact to the tolerance, carries orthogonal directions, which a QR
    decomposition makes orthogonal again once per period: G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn,
    "Lyapunov characteristic exponents for smooth dynamical systems and for Hamiltonian systems; a method for computing
    all of them", Meccanica 15 (1980) 9 and 21.

    Parameters
    ----------
    model, motion
        The column and its base motion, periodic from t = 0.
    tilt, tilt_rate
        Initial condition [rad], [rad/s], shape (2,). If it lies in the vertical plane of a straight base motion, the
        motion is planar, and has the two exponents of planar motion.
    periods
        Number of periods that are evaluated.
    skip
        Number of periods before them, while the motion settles and the directions align.
    count
        Number of exponents, the largest first; all by default.
    blocks
        Number of blocks of the counted periods; their scatter gives the error.
    rtol
        Relative tolerance of the flow.
    progress
        A function that is called with the number of periods done and of all periods; a bar by default, False for none.

    Returns
    -------
    xarray.Dataset
        Of kind "Lyapunov exponents", over `exponent`: `lyapunov_exponent` [1/s] and `per_period`, with their errors
        `error` [1/s] and `per_period_error`, see below. Over `period` (counted) and `exponent`: `running` [1/s], the
        estimate from the periods so far. `periods_counted` is less than `periods` if the motion ended early; then the
        exponents are NaN, and `attrs["ending"]` states why. `attrs["periods_skipped"]` counts the periods skipped.

    Warns
    -----
    EndedEarlyWarning
        If the motion ended early; the message names outcome and time.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    UnsupportedError
        If the motion is not periodic from t = 0, or the model's equations cannot be differentiated.
    Interrupted
        On Ctrl-C; `partial` has the estimates from the periods that were counted, as `running`.

    Notes
    -----
    Each error is the larger of two estimates. The first is the standard error from the scatter of the blocks, which is
    appropriate for a chaotic motion. The second is the range over which the summed growth deviates from a straight
    line, divided by the number of periods. It bounds the error on a torus, or on a periodic orbit with complex
    multipliers: there the sums oscillate, and blocks with a whole number of oscillations would agree by chance. Errors
    fall as 1/`periods` on a torus and as 1/√`periods` in chaos. For real multipliers the exponents are accurate to the
    tolerance.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    >>> start = sb.studies.steady_start(model, motion)
    >>> found = sb.studies.lyapunov_exponents(model, motion, **start, periods=100)
    >>> round(float(found["lyapunov_exponent"].sum()), 8)  # −2η, the rate at which volumes shrink
    -0.2
    """
    require_subject(model, motion)
    blocks = require_whole("blocks", blocks, least=_LEAST_BLOCKS)
    periods = require_whole("periods", periods, least=blocks)
    skip = require_whole("skip", skip, least=0)
    start = [
        require_vector(name, np.ravel(as_numbers(name, value, unit)).tolist(), 2, unit)
        for name, value, unit in (("tilt", tilt, "rad"), ("tilt_rate", tilt_rate, "rad/s"))
    ]
    frame = _start(model, motion, start[0], start[1], count, require_positive("rtol", rtol))
    skipped, growths, stopped = 0, list[Floats](), False
    report = report_of(progress)
    try:
        while frame.status is FlowStatus.DONE and skipped < skip:
            frame = frame.following()
            skipped += frame.status is FlowStatus.DONE
            report(skipped, skip + periods)
        while frame.status is FlowStatus.DONE and len(growths) < periods:
            frame = frame.following()
            if frame.status is FlowStatus.DONE:
                growths.append(frame.growth)
            report(skip + len(growths), skip + periods)
    except KeyboardInterrupt:
        if not growths:
            raise
        stopped = True
    assert motion.period is not None  # PeriodicSystem refuses a motion without
    kept = {"tilt": start[0], "tilt_rate": start[1], "periods": periods, "skip": skip, "blocks": blocks, "rtol": rtol}
    found = _summary(np.reshape(growths, (len(growths), frame.directions.shape[1])), periods, blocks, motion.period)
    found = found.assign_attrs(
        kind="Lyapunov exponents",
        ending="was interrupted" if stopped else _ENDINGS[frame.status],
        periods_skipped=skipped,
        planar=int(frame.system.planar),
        provenance=json.dumps(provenance_of_run(model, motion, **kept)),
    )
    if stopped:
        raise Interrupted(
            f"stopped after {len(growths)} of {plural(periods, 'period')}; `partial` has the estimates from these",
            found,
        )
    if frame.status is not FlowStatus.DONE:
        done = skipped + len(growths)
        warnings.warn(
            f"lyapunov_exponents: the column {_ENDINGS[frame.status]} between t = {done * motion.period:.4g} s and "
            f"{(done + 1) * motion.period:.4g} s, so that the exponents are NaN (got {done} of "
            f"{plural(skip + periods, 'period')}). Start on a motion that lasts.",
            EndedEarlyWarning,
            stacklevel=3,
        )
    return found


@dataclass(frozen=True, slots=True)
class _Frame:
    """State of the motion after a whole number of periods, and the directions integrated with it."""

    system: PeriodicSystem
    state: Floats
    side: float
    directions: Floats
    growth: Floats
    status: FlowStatus = FlowStatus.DONE

    def following(self) -> "_Frame":
        """Return the frame one period later; a frame that has ended does not change."""
        if self.status is not FlowStatus.DONE:
            return self
        flow = self.system.carry(self.state, 0.0, 1.0, side=self.side)
        if flow.status is not FlowStatus.DONE:
            return _Frame(self.system, self.state, self.side, self.directions, self.growth, flow.status)
        directions, stretched = np.linalg.qr(flow.by_start @ self.directions)
        side = flow.side if self.system.planar else 0.0
        return _Frame(self.system, flow.end, side, directions, np.log(np.abs(np.diag(stretched))))


def _start(
    model: Model,
    motion: BaseMotion,
    tilt: tuple[float, ...],
    tilt_rate: tuple[float, ...],
    count: int | None,
    rtol: float,
) -> _Frame:
    state = np.array(model.start((tilt[0], tilt[1]), (tilt_rate[0], tilt_rate[1])), dtype=float)
    line = plane_of(model, motion, state)
    system = PeriodicSystem(model, motion, line, rtol)
    if line is not None:
        x, y, vx, vy = model.tilt_of(*state, *model.parameters)
        state = np.array([x * line[0] + y * line[1], vx * line[0] + vy * line[1]])
    number = system.order if count is None else require_whole("count", count, least=1)
    if number > system.order:
        raise ParameterError(f"count must be at most {system.order}, the order of the equations, got {number}")
    # Directions that are not eigenvectors of the equations.
    first = np.linalg.qr(np.vander(np.arange(1.0, system.order + 1.0), increasing=True))[0][:, :number]
    return _Frame(system, state, 0.0, first, np.zeros(number))


def _summary(growths: Floats, periods: int, blocks: int, period: float) -> xr.Dataset:
    """Return exponents and their errors from the logarithmic `growths` of each period, shape (counted, exponents)."""
    counted, number = growths.shape
    mean, error = np.full(number, np.nan), np.full(number, np.nan)
    if counted == periods:
        mean = growths.mean(axis=0)
        means = np.stack([block.mean(axis=0) for block in np.array_split(growths, blocks)])
        sums = np.cumsum(growths - mean, axis=0)
        error = np.maximum(means.std(axis=0, ddof=1) / np.sqrt(blocks), np.ptp(sums, axis=0) / counted)
    running = np.cumsum(growths, axis=0) / (period * np.arange(1, counted + 1)[:, np.newaxis])
    rate, log = {"units": "s-1"}, {"units": "1"}
    return xr.Dataset(
        {
            "lyapunov_exponent": ("exponent", mean / period, {**rate, "long_name": "Lyapunov exponent"}),
            "error": ("exponent", error / period, {**rate, "long_name": "error of the Lyapunov exponent"}),
            "per_period": ("exponent", mean, {**log, "long_name": "Lyapunov exponent, per period"}),
            "per_period_error": ("exponent", error, {**log, "long_name": "error of the Lyapunov exponent, per period"}),
            "running": (("period", "exponent"), running, {**rate, "long_name": "Lyapunov exponent so far"}),
            "periods_counted": ((), counted, {**log, "long_name": "periods counted"}),
        },
        coords={
            "exponent": np.arange(1, number + 1),
            "period": ("period", np.arange(1, counted + 1), {**log, "long_name": "periods counted"}),
        },
    )
