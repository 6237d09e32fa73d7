"""Writes a step by Taylor series for all lanes, as straight-line source.

The coefficients of the states follow order by order from recurrences that the model's recorded equations give. Their
last two tell how long a step may be; what the polynomial lacks of fulfilling the equations at the end of the step tells
its error. Where the equations hold few products this takes half the work of a Runge–Kutta method.
"""

from collections.abc import Callable

from stylobate.engine.kernel.expansion import Expansion
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.shape import SERIES_ORDER, Shape
from stylobate.engine.kernel.stage_source import rates_call, reciprocal_scales

# The last two terms together may be as large as the tolerance over this.
_CAUTION = 1.0
# A step is at most this much longer than the last one's coefficients would have allowed, or than the last one was.
_ROOM, _LARGEST_FACTOR = 1.5, 10.0
# One is shortened at once by no more than this; what ran into NaN is tried again with half.
_LEAST_FACTOR, _RETRY = 1e-3, 0.5


def series_lines(shape: Shape, rows: Rows, expansion: Expansion) -> list[str]:
    """Return the loop that makes a step: coefficients, its length, the new state, its error."""
    at, states = rows.at, range(shape.order)
    body = [f"t = {at('time')}", f"tried = {at('h')}"]
    body += [f"s{j}_0 = {at(f'y{j}')}" for j in states]
    body += [f"s{integral}_1 = s{j}_0" for j, integral in enumerate(shape.series) if integral != j]
    body += [f"p{j} = {at(f'p{j}')}" for j in range(shape.parameters)]
    body += shape.forcing.series_lines(at, SERIES_ORDER + 1)
    for k in range(SERIES_ORDER + 1):
        body += expansion.coefficient_lines(k)
        body.append(f"{at(f'square{k}')} = {expansion.square(k)}")
    body += _length(shape, rows)
    for j in shape.expanded:
        body += [f"{at(f'c{k}_{j}')} = s{j}_{k}" for k in range(1, shape.degree(j) + 1)]
        body += _end(shape, rows, j)
    body += _defect(shape, rows, expansion)
    return ["    for i in lanes(WIDTH):", *(f"        {line}" for line in body)]


def state_polynomial(shape: Shape, at: Callable[[str], str], j: int) -> list[str]:
    """Return the coefficients by which the step just made gives state `j`, in the time since it began."""
    integral = shape.series[j]
    if integral == j:
        return [at(f"last{j}"), *(at(f"c{k}_{j}") for k in range(1, shape.degree(j) + 1))]
    higher = (f"{float(k)!r} * {at(f'c{k}_{integral}')}" for k in range(2, shape.degree(integral) + 1))
    return [at(f"last{j}"), *higher]


def polynomial(coefficients: list[str], variable: str) -> str:
    """Return the source of a polynomial by Horner's rule."""
    *lower, text = coefficients
    for coefficient in reversed(lower):
        text = f"({text}) * {variable} + {coefficient}"
    return text


def wanted_lines(rows: Rows) -> list[str]:
    """Return what chooses the next step, before stops cut it; `h` and `ok` are known."""
    at = rows.at
    return [
        f"proposed = {at('proposed')}",
        f"wanted = proposed if ok > 0.0 else {_RETRY!r} * h",
        f"wanted = min(wanted, {at('longest_step')})",
    ]


def _end(shape: Shape, rows: Rows, j: int) -> list[str]:
    """Return what finds state `j` at the end of the step, and by the same rule of Horner its rate, if a state too."""
    *lower, highest = (f"s{j}_{k}" for k in range(shape.degree(j) + 1))
    rate = next((m for m, integral in enumerate(shape.series) if integral == j != m), None)
    out = [f"new{j} = {highest}"]
    for number, coefficient in enumerate(reversed(lower)):
        if rate is not None:
            out.append(f"new{rate} = new{j}" if number == 0 else f"new{rate} = new{rate} * h + new{j}")
        out.append(f"new{j} = new{j} * h + {coefficient}")
    return out + [f"{rows.at(f'new{m}')} = new{m}" for m in (j, rate) if m is not None]


def _length(shape: Shape, rows: Rows) -> list[str]:
    at, last = rows.at, SERIES_ORDER
    out = ["base = abs(tried)", "power2 = base * base", "power4 = power2 * power2", "power8 = power4 * power4"]
    # |c15| b^15 + |c16| b^16, b being the step tried: how much of the tolerance the last terms take.
    out += ["before = power8 * power4 * power2 * base", "full = before * base", "size = 0.0"]
    for j in range(shape.order):
        out.append(f"scale{j} = {at('atol_now')} + {at('rtol')} * abs(s{j}_0)")
    out += reciprocal_scales(shape.order)
    for j in range(shape.order):
        terms = f"abs(s{j}_{last - 1}) * before + abs(s{j}_{last}) * full"
        out.append(f"size = size + ({terms}) * per_scale{j}")
    root = f"size * {_CAUTION!r}"
    for _ in range(4):  # the sixteenth root
        root = f"math.sqrt({root})"
    return [
        *out,
        f"factor = 1.0 / max({root}, {1.0 / _LARGEST_FACTOR!r})",
        # Sums, not largest values, above and below: they let NaN through, and the step is not taken.
        "share = factor if factor < 1.0 else 1.0",
        f"h = tried * (share if share > {_LEAST_FACTOR!r} else {_LEAST_FACTOR!r})",
        f"{at('h')} = h",
        f"{at('proposed')} = base * factor * {_ROOM!r}",
    ]


def _defect(shape: Shape, rows: Rows, expansion: Expansion) -> list[str]:
    at = rows.at
    new = [f"new{j}" for j in range(shape.order)]
    rates = ", ".join(f"r{j}" for j in range(shape.order))
    out = list(shape.forcing.lines(at, "t + h"))
    out.append(f"{rates} = {rates_call(shape, at, new)}")
    out.append("error = 0.0")
    for j in range(shape.order):
        if j in shape.paired:  # what it is the integral of holds as well
            continue
        slope = polynomial([expansion.rate(j, k) for k in range(SERIES_ORDER)], "h")
        out.append(f"defect = abs(r{j} - ({slope}))")
        out.append(f"error = error + defect / ({at('atol_now')} + {at('rtol')} * max(abs(s{j}_0), abs(new{j})))")
    out.append(f"{at('error')} = error * abs(h) * {1.0 / (SERIES_ORDER + 1)!r}")
    return out
