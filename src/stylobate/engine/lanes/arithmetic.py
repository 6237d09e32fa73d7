"""Scalar arithmetic that compiles to vector instructions: no branches, no calls into the C library."""

import math
from collections.abc import Callable
from typing import Any, TypeVar, cast

from numba import njit

_F = TypeVar("_F", bound=Callable[..., Any])

# Without "nnan" and "ninf", so that a step that ran into NaN is seen and made smaller.
_FAST = {"contract", "arcp", "nsz", "afn"}

# Parts of kernels are called from compiled code only: without entries from Python they compile faster.
_INNER = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def inlined(function: _F) -> _F:
    """Compile `function` into every place that calls it, so that a loop over lanes can become vector code.

    Numba's own division checks would be branches; NumPy's error model leaves them out.
    """
    compiled = njit(forceinline=True, error_model="numpy", fastmath=_FAST, **_INNER)  # type: ignore[call-overload]
    return cast("_F", compiled(function))


def vectorised(function: _F) -> _F:
    """Compile a function whose loops run over lanes."""
    return cast("_F", njit(error_model="numpy", fastmath=_FAST, nogil=True)(function))


def part(function: _F) -> _F:
    """Compile a function that serves one lane at a time, as part of the one that calls it."""
    compiled = njit(error_model="numpy", nogil=True, **_INNER)  # type: ignore[call-overload]
    return cast("_F", compiled(function))


def kept(signature: str) -> Callable[[_F], _F]:
    """Compile a function and all that it calls for arguments of this type, at once, and keep the machine code."""

    def compiled(function: _F) -> _F:
        return cast("_F", njit(signature, cache=True, error_model="numpy", nogil=True)(function))

    return compiled


@inlined
def cos_turns(u: float) -> float:
    """Return cos 2πu, `u` in turns, to 2 ulp of 1: the Taylor polynomial of sin about the nearest quarter turn."""
    s = (0.25 - abs(u - math.floor(u + 0.5))) * 6.283185307179586
    z = s * s
    series = 2.81145725434552076e-15
    series = z * series - 7.64716373181981648e-13
    series = z * series + 1.60590438368216146e-10
    series = z * series - 2.50521083854417188e-8
    series = z * series + 2.75573192239858907e-6
    series = z * series - 1.98412698412698413e-4
    series = z * series + 8.33333333333333333e-3
    series = z * series - 1.66666666666666667e-1
    return s + s * (z * series)


@inlined
def winding(x0: float, y0: float, x1: float, y1: float, momentum: float) -> float:
    """Return +1 or −1 if the way from (x0, y0) to (x1, y1) crosses the negative x axis anticlockwise or clockwise.

    Within a right angle it is the short way; beyond, past the origin, the side on which the `momentum` x ẏ − y ẋ
    says it passes.
    """
    cross = x0 * y1 - y0 * x1
    sense = cross if x0 * x1 + y0 * y1 > 0.0 else momentum
    upper = (1.0 if y1 >= 0.0 else 0.0) - (1.0 if y0 >= 0.0 else 0.0)
    # Grows as the azimuth, from −π to π, grows from the first point to the second.
    growth = upper if upper != 0.0 else cross
    forward = (1.0 if sense > 0.0 else 0.0) * (1.0 if growth < 0.0 else 0.0)
    backward = (1.0 if sense < 0.0 else 0.0) * (1.0 if growth > 0.0 else 0.0)
    return forward - backward


@inlined
def turning_point(start: float, end: float, slope: float, end_slope: float, sign: float) -> tuple[float, float]:
    """Return where on [0, 1] the cubic through two values with two slopes has its extreme, and its value there.

    `sign` is 1 for a maximum, −1 for a minimum; meaningful only where the slopes have opposite signs.
    """
    rise = end - start
    b = 3.0 * rise - 2.0 * slope - end_slope
    a = slope + end_slope - 2.0 * rise
    u = slope / (sign * math.sqrt(abs(b * b - 3.0 * a * slope)) - b)
    return u, start + u * (slope + u * (b + u * a))
