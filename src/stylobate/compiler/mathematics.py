"""Mathematical functions in the language of the compiler: the same bits on every machine.

Libraries of C round differently from system to system, and those of browsers differ again. These functions use
additions, multiplications, divisions and square roots alone, whose results IEEE 754 fixes. Errors are below two units
in the last place, of `power` below five for results between 1e-10 and 1e10. Angles above 10⁶ rad lose digits.

Series are Taylor's: on the reduced arguments the first omitted term is below half a unit in the last place.
"""

import math
from collections.abc import Callable

import numpy as np

from stylobate.compiler.machine import Machine
from stylobate.compiler.unit import Unit
from stylobate.compiler.values import NumberKind

# π/2 and ln 2 as sums of a part with few digits, whose multiples are exact, and the rest.
_QUARTER_1, _QUARTER_2, _QUARTER_3 = 1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21
_LN2_1, _LN2_2 = 0.6931471803691238, 1.9082149292705877e-10
_LARGEST_EXPONENT, _LEAST_EXPONENT = 709.782712893384, -745.1332191019412
_FAR = 40.0
"""Beyond this argument 1 is a rounding error of eˣ, or eˣ of 1."""
# atan(k/8) and what its float leaves, for k from 0 to 8.
_ARC = (
    *(0.0, 0.12435499454676144, 0.24497866312686414, 0.35877067027057225, 0.4636476090008061),
    *(0.5585993153435624, 0.6435011087932844, 0.7188299996216245, 0.7853981633974483),
)
_ARC_REST = (
    *(0.0, -3.1253241424539383e-18, 1.0698755618734451e-17, -2.4623815582638635e-17, 2.2698777452961687e-17),
    *(-5.4556305485916264e-18, 1.5834785051444286e-17, -2.1478388444456983e-17, 3.061616997868383e-17),
)


# Coefficients of Taylor series in the square of the argument, the highest power first; of `exp` in the argument.
_SINE = (
    *(-8.22063524662433e-18, 2.8114572543455206e-15, -7.647163731819816e-13, 1.6059043836821613e-10),
    *(-2.505210838544172e-08, 2.7557319223985893e-06, -0.0001984126984126984, 0.008333333333333333),
    -0.16666666666666666,
)
_COSINE = (
    *(-1.5619206968586225e-16, 4.779477332387385e-14, -1.1470745597729725e-11, 2.08767569878681e-09),
    *(-2.755731922398589e-07, 2.48015873015873e-05, -0.001388888888888889, 0.041666666666666664),
)
_TANGENT = (
    *(-0.06666666666666667, 0.07692307692307693, -0.09090909090909091, 0.1111111111111111),
    *(-0.14285714285714285, 0.2, -0.3333333333333333),
)
_EXPONENTIAL = (
    *(1.1470745597729725e-11, 1.6059043836821613e-10, 2.08767569878681e-09, 2.505210838544172e-08),
    *(2.755731922398589e-07, 2.7557319223985893e-06, 2.48015873015873e-05, 0.0001984126984126984),
    *(0.001388888888888889, 0.008333333333333333, 0.041666666666666664, 0.16666666666666666, 0.5),
)
_LOGARITHM = (
    *(0.09523809523809523, 0.10526315789473684, 0.11764705882352941, 0.13333333333333333, 0.15384615384615385),
    *(0.18181818181818182, 0.2222222222222222, 0.2857142857142857, 0.4, 0.6666666666666666),
)


def _series(coefficients: tuple[float, ...], z: float) -> float:
    """Return the value of a polynomial, whose highest coefficient is first."""
    value = coefficients[0]
    for k in tuple(range(1, len(coefficients))):
        value = z * value + coefficients[k]
    return value


def sin(x: float) -> float:
    """Return sin x."""
    return x if x == 0.0 else _wave(x, 0.0)


def cos(x: float) -> float:
    """Return cos x."""
    return _wave(x, 1.0)


def tan(x: float) -> float:
    """Return tan x."""
    return sin(x) / cos(x)


def _wave(x: float, quarters: float) -> float:
    """Return the sine of x and so many quarter turns."""
    turns, high, low = _reduced(x)
    side = (turns + quarters) - 4.0 * np.floor(0.25 * (turns + quarters))
    sine = side in (0.0, 2.0)
    value = _sine(high, low) if sine else _cosine(high, low)
    return value if side < 2.0 else -value  # noqa: PLR2004  half a turn


def _reduced(x: float) -> tuple[float, float, float]:
    """Return the nearest number of quarter turns, and the rest of x as a sum of two floats."""
    turns = float(np.rint(0.6366197723675814 * x))
    first = x - turns * _QUARTER_1
    second = turns * _QUARTER_2
    high = first - second
    low = ((first - high) - second) - turns * _QUARTER_3
    return turns, high + low, low - ((high + low) - high)


def _sine(x: float, rest: float) -> float:
    z = x * x
    return x + (z * x * _series(_SINE, z) + rest * (1.0 - 0.5 * z))


def _cosine(x: float, rest: float) -> float:
    z = x * x
    half = 0.5 * z
    near = 1.0 - half
    return near + (((1.0 - near) - half) + (z * z * _series(_COSINE, z) - x * rest))


def atan(x: float) -> float:
    """Return the arc tangent of x."""
    size = abs(x)
    angle = (1.5707963267948966 - _arc(1.0 / size)) + 6.123233995736766e-17 if size > 1.0 else _arc(size)
    return math.copysign(angle, x)


def _arc(x: float) -> float:
    """Return the arc tangent of x between 0 and 1, NaN of NaN."""
    if not x <= 1.0:
        return x
    place = int(np.rint(8.0 * x))
    near = 0.125 * place
    t = (x - near) / (1.0 + x * near)
    z = t * t
    return _ARC[place] + (t + (z * t * _series(_TANGENT, z) + _ARC_REST[place]))


def atan2(y: float, x: float) -> float:
    """Return the angle of the vector (x, y), from −π to π."""
    ahead, aside = abs(x), abs(y)
    if ahead == 0.0 and aside == 0.0:
        angle = 0.0
    elif ahead == math.inf and aside == math.inf:
        angle = 0.7853981633974483
    elif aside > ahead:
        angle = (1.5707963267948966 - _arc(ahead / aside)) + 6.123233995736766e-17
    else:
        angle = _arc(aside / ahead)
    if math.copysign(1.0, x) < 0.0:
        angle = (3.141592653589793 - angle) + 1.2246467991473532e-16
    return math.copysign(angle, y)


def hypot(x: float, y: float) -> float:
    """Return the length of the vector (x, y)."""
    larger, smaller = max(abs(x), abs(y)), min(abs(x), abs(y))
    if larger in (0.0, math.inf):
        return larger
    ratio = smaller / larger
    return larger * math.sqrt(1.0 + ratio * ratio)


def exp(x: float) -> float:
    """Return eˣ."""
    if x > _LARGEST_EXPONENT:
        return math.inf
    if x < _LEAST_EXPONENT:
        return 0.0
    if x != x:  # noqa: PLR0124  NaN
        return x
    powers, part = _exponential_parts(x)
    return _scaled(1.0 + part, powers)


def expm1(x: float) -> float:
    """Return eˣ − 1."""
    if x == 0.0:
        return x
    if not abs(x) < _FAR:
        return exp(x) - 1.0
    powers, part = _exponential_parts(x)
    factor = _scaled(1.0, powers)
    return factor * part + (factor - 1.0)


def _exponential_parts(x: float) -> tuple[float, float]:
    """Return n and p with eˣ = 2ⁿ(1 + p) and |p| below 1/2."""
    powers = float(np.rint(1.4426950408889634 * x))
    high, low = x - powers * _LN2_1, powers * _LN2_2
    r = high - low
    rest = (high - r) - low
    return powers, r + (r * r * _series(_EXPONENTIAL, r) + rest)


def _scaled(value: float, powers: float) -> float:
    """Return value · 2ᵖᵒʷᵉʳˢ, rounded once."""
    while powers > 1000.0:  # noqa: PLR2004  2¹⁰⁰⁰ is a float
        value, powers = value * 1.0715086071862673e301, powers - 1000.0
    while powers < -1000.0:  # noqa: PLR2004
        value, powers = value * 9.332636185032189e-302, powers + 1000.0
    factor, base, left = 1.0, 2.0 if powers > 0.0 else 0.5, abs(powers)
    while left > 0.0:
        half = float(np.floor(0.5 * left))
        if left - 2.0 * half > 0.0:
            factor *= base
        base, left = base * base, half
    return value * factor


def log(x: float) -> float:
    """Return the natural logarithm of x; NaN below 0."""
    if x == 0.0:
        return -math.inf
    if not 0.0 < x < math.inf:
        return x if x > 0.0 else math.nan
    powers, part = _parts(x)
    return _near_one(part - 1.0, powers)


def _parts(x: float) -> tuple[float, float]:
    """Return p and m with x = m · 2ᵖ and m from √½ to √2, for x above 0."""
    powers, step, up, down = 0.0, 512.0, 1.3407807929942597e154, 7.458340731200207e-155
    if x < 2.2250738585072014e-308:  # noqa: PLR2004  denormal
        x, powers = x * 18014398509481984.0, -54.0
    while step >= 1.0:
        if x >= up:
            x, powers = x * down, powers + step
        elif x < down:
            x, powers = x * up, powers - step
        step, up, down = 0.5 * step, math.sqrt(up), math.sqrt(down)
    if x > 1.4142135623730951:  # noqa: PLR2004  √2
        x, powers = 0.5 * x, powers + 1.0
    elif x < 0.7071067811865476:  # noqa: PLR2004  √½
        x, powers = 2.0 * x, powers - 1.0
    return powers, x


def _near_one(f: float, powers: float) -> float:
    """Return ln(1 + f) + powers · ln 2, for f from √½ − 1 to √2 − 1."""
    s = f / (2.0 + f)
    z = s * s
    half = 0.5 * f * f
    # ln(1 + f) = f − f²/2 + s (f²/2 + z · series in z)
    return powers * _LN2_1 - ((half - (s * (half + z * _series(_LOGARITHM, z)) + powers * _LN2_2)) - f)


def asinh(x: float) -> float:
    """Return the inverse hyperbolic sine of x."""
    size = abs(x)
    if size == math.inf or size != size:  # noqa: PLR0124  NaN
        return x
    if size > 1e8:  # noqa: PLR2004  beyond, √(x² + 1) is x
        return math.copysign(log(size) + 0.6931471805599453, x)
    more = size + size * size / (1.0 + math.sqrt(size * size + 1.0))  # of 1: the logarithm of 1 + more
    if more < 0.41:  # noqa: PLR2004  1 + more is below √2
        return math.copysign(_near_one(more, 0.0), x)
    whole = 1.0 + more
    return math.copysign(log(whole) + (more - (whole - 1.0)) / whole, x)


def power(x: float, y: float) -> float:
    """Return xʸ."""
    if y == 0.0 or x == 1.0:
        return 1.0
    size = abs(x)
    if size == 0.0:
        result = 0.0 if y > 0.0 else math.inf
    else:
        powers, part = _parts(size)
        # whole numbers of doublings are exact: those of the whole part of y, and the nearest number of the others
        steps = float(np.rint(y))
        others = (y - steps) * powers
        doublings = float(np.rint(others))
        rest = y * _near_one(part - 1.0, 0.0) + (others - doublings) * 0.6931471805599453
        result = _scaled(exp(rest), steps * powers + doublings)
    if x < 0.0:
        half = 0.5 * y
        if np.floor(y) != y:
            return math.nan
        if np.floor(half) != half:
            return -result
    return result


FUNCTIONS: dict[str, tuple[Callable[..., float], int]] = {
    "sin": (sin, 1),
    "cos": (cos, 1),
    "tan": (tan, 1),
    "atan": (atan, 1),
    "atan2": (atan2, 2),
    "hypot": (hypot, 2),
    "exp": (exp, 1),
    "expm1": (expm1, 1),
    "log": (log, 1),
    "asinh": (asinh, 1),
    "pow": (power, 2),
}
"""Functions by their names in the library of C, with the number of their arguments."""


def object_code(machine: Machine) -> bytes:
    """Return the machine code of all functions, under the names of the library of C."""
    unit = Unit(lanes=machine.lanes, exact=True, trusted=True)
    for name, (function, count) in FUNCTIONS.items():
        unit.export(function, name, [NumberKind.FLOAT] * count, returns=NumberKind.FLOAT)
    return machine.object_code(unit.module.text(machine.attributes))
