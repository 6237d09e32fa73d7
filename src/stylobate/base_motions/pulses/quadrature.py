"""Gauss quadrature of waveforms from 0 to any time, accurate to rounding."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

# On an interval of a quarter of the shortest period the Gauss rule of this order is exact to rounding.
_ORDER = 12
_STRETCHES_PER_PERIOD = 4


def integral(function: Callable[[Floats], Floats], time: Floats, end: float, cycles: float) -> Floats:
    """Compute ∫₀ᵗ f ds at `time` from 0 to `end`, an interval of at most `cycles` shortest periods of `function`."""
    return _integrals(function, time, end, cycles)[0]


def double_integral(function: Callable[[Floats], Floats], time: Floats, end: float, cycles: float) -> Floats:
    """Compute ∫₀ᵗ (t − s) f ds, the integral of the integral, in the same way."""
    return _integrals(function, time, end, cycles)[1]


def _integrals(function: Callable[[Floats], Floats], time: Floats, end: float, cycles: float) -> tuple[Floats, Floats]:
    edges = np.linspace(0.0, end, int(np.ceil(_STRETCHES_PER_PERIOD * cycles)) + 1)
    whole, moments = _gauss(function, edges[:-1], edges[1:])
    first = np.concatenate([[0.0], np.cumsum(whole)])
    # Over an interval the double integral grows by the first integral times the length plus its own part.
    second = np.concatenate([[0.0], np.cumsum(first[:-1] * np.diff(edges) + moments)])
    stretch = np.clip(np.searchsorted(edges, time, side="right") - 1, 0, edges.size - 2)
    low = edges[stretch]
    part, moment = _gauss(function, low, time)
    return first[stretch] + part, second[stretch] + first[stretch] * (time - low) + moment


def _gauss(function: Callable[[Floats], Floats], low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Compute ∫ f ds and ∫ (high − s) f ds from `low` to `high`."""
    nodes, weights = np.polynomial.legendre.leggauss(_ORDER)
    half = 0.5 * (high - low)
    times = low[..., np.newaxis] + half[..., np.newaxis] * (1.0 + nodes)
    values = weights * function(times)
    moment = np.sum(values * (1.0 - nodes), axis=-1)
    return half * np.sum(values, axis=-1), half**2 * moment
