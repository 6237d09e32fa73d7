"""Extremes of the histories of a run between its samples: a chart that has them shows the motion, not its sampling.

Of a history such as |sin t| with ten samples in each hump the lowest sample drifts from hump to hump: a slow beat that
is not in the motion. The extremes are values of the run itself, at times that parabolas and kinks of samples predict.
The page does the same for its own runs in `web/src/kernels/extremes.ts`.
"""

import math
from collections.abc import Callable, Mapping

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Histories = Mapping[str, Floats]

_PER_PERIOD = 20
"""Times in a period at least, among which the turning points are looked for: ten in each hump of |sin|."""
_MOST = 60_000
"""Times at most, for 3000 periods."""
_SEEN = 1e-3
"""Fraction of the height of a curve that can be seen: a third of a pixel of a chart."""
_ROUNDS = 3
"""Rounds of prediction: after the third one the error of a kink is below 10⁻⁴ of its hump."""
_BESIDE = 2
"""Known times on each side of a turning point."""


def extremes(
    sample: Callable[[Floats], Histories], time: Floats, frequency: float
) -> dict[str, list[tuple[float, float]]]:
    """Find the extremes of histories between their samples.

    Parameters
    ----------
    sample
        Returns the histories by name at given times [s], each of shape (n,).
    time
        Times of the samples at equal steps [s].
    frequency
        Highest angular frequency of the motion [rad/s].

    Returns
    -------
    dict
        Time [s] and value of each extreme by the name of its history, in the order of time: at most one minimum and one
        maximum between two samples, those that are seen.
    """
    if len(time) < 2 * _BESIDE + 1:
        return {}
    step = time[1] - time[0]
    parts = math.ceil(_PER_PERIOD * step * frequency / (2.0 * math.pi))
    parts = max(1, min(parts, _MOST // len(time)))
    dense = np.linspace(time[0], time[-1], (len(time) - 1) * parts + 1)
    histories = sample(dense)
    turning = {name: found for name, values in histories.items() if len((found := _turning(values))[0])}
    if not turning:
        return {}
    times, values, signs, owner = _windows(dense, histories, turning)
    for _ in range(_ROUNDS):
        asked = np.clip(_predicted(times, signs[:, np.newaxis] * values), times[:, :1], times[:, -1:])
        shown = sample(asked.ravel())
        own = np.stack([shown[name] for name in turning])[np.repeat(owner, asked.shape[1]), np.arange(asked.size)]
        times, values = np.hstack([times, asked]), np.hstack([values, own.reshape(asked.shape)])
        order = np.argsort(times, axis=1, kind="stable")
        times, values = np.take_along_axis(times, order, 1), np.take_along_axis(values, order, 1)
    best = np.nanargmax(signs[:, np.newaxis] * values, axis=1)
    rows = np.arange(len(best))
    return {
        name: kept
        for place, name in enumerate(turning)
        if (
            kept := _seen(
                time,
                histories[name][::parts],
                times[rows, best][owner == place],
                values[rows, best][owner == place],
                signs[owner == place],
            )
        )
    }


def _height(values: Floats) -> float:
    """Return the height of a curve as it is drawn: from zero on, and without rare peaks."""
    known = values[np.isfinite(values)]
    if not known.size:
        return 0.0
    low, high = np.quantile(known, [0.01, 0.99])
    return float(max(high, 0.0) - min(low, 0.0)) or float(np.abs(known).max())


def _turning(values: Floats) -> tuple[npt.NDArray[np.intp], Floats]:
    """Return the places where values turn, and 1 for each maximum and -1 for each minimum."""
    height = _height(values)
    before, after = np.diff(values)[:-1], np.diff(values)[1:]
    with np.errstate(invalid="ignore"):
        turns = (before * after <= 0.0) & (np.maximum(np.abs(before), np.abs(after)) > _SEEN * height)
    places = np.flatnonzero(turns & (height > 0.0)) + 1
    return places, np.where(before[places - 1] - after[places - 1] > 0.0, 1.0, -1.0)


def _windows(
    dense: Floats, histories: Histories, turning: Mapping[str, tuple[npt.NDArray[np.intp], Floats]]
) -> tuple[Floats, Floats, Floats, npt.NDArray[np.intp]]:
    """Return times and values about all turning points, their signs, and the number of the history of each."""
    beside = np.arange(-_BESIDE, _BESIDE + 1)
    times, values = [], []
    for name, (places, _) in turning.items():
        window = np.clip(places, _BESIDE, len(dense) - 1 - _BESIDE)[:, np.newaxis] + beside
        times.append(dense[window])
        values.append(histories[name][window])
    counts = [len(places) for places, _ in turning.values()]
    signs = np.concatenate([found for _, found in turning.values()])
    return np.concatenate(times), np.concatenate(values), signs, np.repeat(np.arange(len(counts)), counts)


def _predicted(times: Floats, values: Floats) -> Floats:
    """Return the times of possible maxima: the vertex of a parabola, and kinks on both sides of the highest value."""
    rows = np.arange(len(times))[:, np.newaxis]
    highest = np.argmax(np.where(np.isfinite(values), values, -np.inf), axis=1)
    near = np.clip(highest, _BESIDE, times.shape[1] - 1 - _BESIDE)[:, np.newaxis] + np.arange(-_BESIDE, _BESIDE + 1)
    t, v = times[rows, near].T, values[rows, near].T
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        slopes = np.diff(v, axis=0) / np.diff(t, axis=0)
        bend = (slopes[2] - slopes[1]) / (t[3] - t[1])
        vertex = t[2] - (slopes[1] + bend * (t[2] - t[1])) / (2.0 * bend)
        left = (v[2] - v[1] + slopes[0] * t[1] - slopes[2] * t[2]) / (slopes[0] - slopes[2])
        right = (v[3] - v[2] + slopes[1] * t[2] - slopes[3] * t[3]) / (slopes[1] - slopes[3])
    found = np.stack([vertex, left, right], axis=1)
    first, middle, last = (t[place][:, np.newaxis] for place in (1, 2, 3))
    times_of_maxima: Floats = np.where(np.isfinite(found), np.clip(found, first, last), middle)
    return times_of_maxima


def _seen(time: Floats, samples: Floats, at: Floats, values: Floats, signs: Floats) -> list[tuple[float, float]]:
    """Return the highest maximum and the lowest minimum between each two samples, if they are seen beside these."""
    between = np.clip(np.searchsorted(time, at, side="right") - 1, 0, len(time) - 2)
    ends = np.fmax(signs * samples[between], signs * samples[between + 1])
    shown = np.isfinite(values) & ~(signs * values <= ends + 0.5 * _SEEN * _height(samples))
    order = np.lexsort((-signs * values, signs, between))
    order = order[shown[order]]
    first = np.ones(len(order), dtype=bool)
    first[1:] = (np.diff(between[order]) != 0) | (np.diff(signs[order]) != 0.0)
    kept = order[first]
    return [(float(at[one]), float(values[one])) for one in kept[np.argsort(at[kept], kind="stable")]]
