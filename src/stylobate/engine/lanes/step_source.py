"""Writes the innermost loops of a kernel: one step of DOP853 for all lanes, as straight-line source.

E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., section II.5: twelve stages
of order 8, the error estimated from formulas of orders 5 and 3. Written out, a stage is one loop over lanes on scalar
locals, which the compiler turns into vector instructions.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from scipy.integrate import DOP853

from stylobate.engine.lanes.columns import LOOKS, STATE, Log, Setup, Window
from stylobate.engine.lanes.forcing_source import ForcingSource
from stylobate.engine.lanes.layout import Rows

_STAGES = 12
# Step control as SciPy's: safety 0.9, a step changes by 0.2 to 10, an error below the last number counts as that.
_SAFETY, _LEAST_FACTOR, _LARGEST_FACTOR, _LEAST_ERROR = 0.9, 0.2, 10.0, 1e-12
# A step shorter than this part of the time cannot be made.
_SHORTEST = 2.3e-15
# Near passages in space: see the engine's mover for single runs.
_HOP_FROM, _HOP_OFFSET = 1e-6, 1e-9
# A largest tilt within a step is measured if it may exceed the largest so far by this part.
_NEW_PEAK = 1e-7
# A motion that begins at a tilt far below the tolerance is followed finely up to this one [units of c].
_GROWN = 1e-3


@dataclass(frozen=True, slots=True)
class Shape:
    """What sets one kernel apart from another.

    Parameters
    ----------
    states, parameters
        How many the model has.
    planar
        Whether it integrates motion in a vertical plane, with two states.
    forcing
        How the base moves.
    width
        Lanes.
    """

    states: int
    parameters: int
    planar: bool
    forcing: ForcingSource
    width: int

    @property
    def parameters_at(self) -> int:
        """Column of the table at which the model's parameters begin, behind the state."""
        return STATE + max(self.states, 2)

    @property
    def motion_at(self) -> int:
        """Column at which the numbers of the base motion begin."""
        return self.parameters_at + self.parameters

    @property
    def breaks_at(self) -> int:
        """Column at which its breaks begin."""
        return self.motion_at + self.forcing.columns

    @property
    def order(self) -> int:
        """Number of equations."""
        return 2 if self.planar else self.states

    def rows(self) -> Rows:
        """Return the layout of the buffer: the tables' columns first, under their names in small letters."""
        rows = Rows()
        rows.add(*(column.name.lower() for column in Setup), *(column.name.lower() for column in Log))
        for window in ("before", "late"):
            rows.add(*(f"{window}_{column.name.lower()}" for column in Window))
        rows.add_many("look", 4 * LOOKS)
        rows.add_many("y", self.order)
        rows.add(*_LANE_ROWS)
        rows.add_many("p", self.parameters)
        self.forcing.reserve(rows)
        for stage in range(_STAGES + 1):
            rows.add_many(f"k{stage}_", self.order)
        for name in ("new", "last", "last_slope"):
            rows.add_many(name, self.order)
        return rows


_LANE_ROWS = (
    "run", "h", "tried", "held_step", "by_tilt", "stop", "wanted", "made", "aimed", "rejected", "side",
    "atol_now", "grown", "rest_tilt", "no_return",
    "tilt", "radial", "momentum", "x", "y", "vx", "vy",
    "tilt_before", "radial_before", "x_before", "y_before", "vx_before", "vy_before",
    "turns", "low", "peak", "flag", "error", "ok", "held", "go", "reached",
    "new_x", "new_y", "new_vx", "new_vy", "new_tilt", "new_radial", "per_turn",
)  # fmt: skip


def step_source(shape: Shape) -> str:
    """Return the source of `step(buf)`, one attempt at a step in every lane."""
    rows = shape.rows()
    lines = ["@vectorised", "def step(buf):"]
    for stage in range(1, _STAGES + 1):
        lines += _stage(shape, rows, stage)
    lines += _judgement(shape, rows)
    return "\n".join(lines) + "\n"


def accelerations_source(shape: Shape) -> str:
    """Return the source of `accelerations(buf, i, t)`, for the driver: horizontal x, y and vertical [g]."""
    rows = shape.rows()
    lines = ["@part", "def accelerations(buf, i, t):"]
    lines += [f"    {line}" for line in shape.forcing.lines(rows.of_lane, "t")]
    horizontal = "ah, 0.0" if shape.planar else "ax, ay"
    lines.append(f"    return {horizontal}, {_vertical(shape)}")
    return "\n".join(lines) + "\n"


def rates_source(shape: Shape) -> str:
    """Return the source of `rates_at(buf, i, t, state)`, the right-hand side for the driver."""
    rows = shape.rows()
    lines = ["@part", "def rates_at(buf, i, t, state):"]
    lines += [f"    {line}" for line in shape.forcing.lines(rows.of_lane, "t")]
    lines.append(f"    return {_rates(shape, rows.of_lane, [f'state[{j}]' for j in range(shape.order)])}")
    return "\n".join(lines) + "\n"


def _vertical(shape: Shape) -> str:
    return "az" if "az" in shape.forcing.components else "0.0"


def _rates(shape: Shape, at: Callable[[str], str], state: Sequence[str]) -> str:
    before = [at("side"), "ah"] if shape.planar else ["ax", "ay"]
    arguments = [*state, *before, _vertical(shape)]
    return f"rates({', '.join([*arguments, *(at(f'p{j}') for j in range(shape.parameters))])})"


def _combination(coefficients: Iterable[float], names: Iterable[str]) -> str:
    return " + ".join(f"{float(a)!r} * {name}" for a, name in zip(coefficients, names, strict=True) if a != 0.0)


def _stage(shape: Shape, rows: Rows, stage: int) -> list[str]:
    last = stage == _STAGES
    weights = DOP853.B if last else DOP853.A[stage, :stage]
    fraction = 1.0 if last else float(DOP853.C[stage])
    out = ["    for i in range(WIDTH):", f"        h = {rows.at('h')}", f"        t = {rows.at('time')}"]
    for j in range(shape.order):
        total = _combination(weights, [rows.at(f"k{s}_{j}") for s in range(stage)])
        out.append(f"        s{j} = {rows.at(f'y{j}')} + h * ({total})")
    out += [f"        {line}" for line in shape.forcing.lines(rows.at, f"t + {fraction!r} * h")]
    results = ", ".join(f"r{j}" for j in range(shape.order))
    out.append(f"        {results} = {_rates(shape, rows.at, [f's{j}' for j in range(shape.order)])}")
    out += [f"        {rows.at(f'k{stage}_{j}')} = r{j}" for j in range(shape.order)]
    if last:
        out += [f"        {rows.at(f'new{j}')} = s{j}" for j in range(shape.order)]
    return out


def _judgement(shape: Shape, rows: Rows) -> list[str]:
    """Return the loops that accept or reject the step and note what happened in it.

    Each is straight-line code with selects; what one finds goes to the next as numbers 0 and 1 in rows.
    """
    # A loop too short would be unrolled before it could become vector code.
    loops = ((_error, _acceptance), (_extremes, _turning), (_keeping, _next_step, _suspicion))
    lines: list[str] = []
    for parts in loops:
        lines.append("    for i in range(WIDTH):")
        lines += [f"        {text}" for part in parts for text in part(shape, rows)]
    return lines


def _error(shape: Shape, rows: Rows) -> list[str]:
    at = rows.at
    out = ["e5 = 0.0", "e3 = 0.0"]
    for j in range(shape.order):
        stages = [at(f"k{s}_{j}") for s in range(_STAGES + 1)]
        out += [
            f"scale = {at('atol_now')} + {at('rtol')} * max(abs({at(f'y{j}')}), abs({at(f'new{j}')}))",
            "per_scale = 1.0 / scale",
            f"q = ({_combination(DOP853.E5, stages)}) * per_scale",
            "e5 = e5 + q * q",
            f"q = ({_combination(DOP853.E3, stages)}) * per_scale",
            "e3 = e3 + q * q",
        ]
    return [
        *out,
        "spread = e5 + 0.01 * e3",
        f"{at('error')} = abs({at('h')}) * e5 / math.sqrt(spread * {float(shape.order)!r} + 1e-300)",
    ]


def _acceptance(shape: Shape, rows: Rows) -> list[str]:
    """Return what finds the new lean, and whether the step is good, and taken or held back by an event."""
    at = rows.at
    new = [at(f"new{j}") for j in range(shape.order)]
    if shape.planar:
        lean = [f"x1 = {new[0]}", "y1 = 0.0", f"vx1 = {new[1]}", "vy1 = 0.0"]
    else:
        lean = [f"x1, y1, vx1, vy1 = lean({', '.join([*new, *(at(f'p{j}') for j in range(shape.parameters))])})"]
    return [
        *lean,
        "tilt1 = math.sqrt(x1 * x1 + y1 * y1)",
        "radial1 = x1 * vx1 + y1 * vy1",
        f"past = min(tilt1 - {at('no_return')}, radial1)",
        f"past = max(past, tilt1 - {at('tilt_limit')})",
        *_crossing(shape, rows),
        f"ok = 1.0 if {at('error')} < 1.0 else 0.0",
        f"ahead = (1.0 if past > 0.0 else 0.0) * (0.0 if {at('aimed')} > 0.0 else 1.0)",
        f"{at('ok')} = ok",
        f"{at('held')} = ok * ahead",
        f"{at('go')} = ok * (1.0 - ahead)",
        *(f"{at(f'new_{name}')} = {name}1" for name in ("x", "y", "vx", "vy", "tilt", "radial")),
    ]


def _crossing(shape: Shape, rows: Rows) -> list[str]:
    if not shape.planar:
        return []
    at = rows.at
    return [
        f"side = {at('side')}",
        f"h = {at('h')}",
        f"s0 = side * {at('x')}",
        "s1 = side * x1",
        f"v0 = side * {at('vx')}",
        "v1 = side * vx1",
        "_, lowest = turning_point(s0, s1, v0 * h, v1 * h, -1.0)",
        "lowest = lowest if v0 < 0.0 else s1",
        "lowest = lowest if v1 > 0.0 else s1",
        "past = max(past, -min(s1, lowest))",
    ]


def _extremes(shape: Shape, rows: Rows) -> list[str]:
    """Return what finds the least and the largest tilt within the step, by the cubic of the tilt's square.

    Out of a plane the least tilt of a passage of the upright is kept.
    """
    at = rows.at
    return [
        f"h = {at('h')}",
        f"go = {at('go')}",
        f"tilt0 = {at('tilt')}",
        f"tilt1 = {at('new_tilt')}",
        f"radial0 = {at('radial')}",
        f"radial1 = {at('new_radial')}",
        "square0 = tilt0 * tilt0",
        "square1 = tilt1 * tilt1",
        "slope0 = 2.0 * radial0 * h",
        "slope1 = 2.0 * radial1 * h",
        "fell = (1.0 if slope0 < 0.0 else 0.0) * (1.0 if slope1 > 0.0 else 0.0)",
        "rose = (1.0 if slope0 > 0.0 else 0.0) * (1.0 if slope1 < 0.0 else 0.0)",
        "share, extreme = turning_point(square0, square1, slope0, slope1, rose - fell)",
        "extreme = math.sqrt(max(extreme, 0.0))",
        "low = extreme if fell > 0.0 else min(tilt0, tilt1)",
        f"{at('low')} = low",
        # A step towards an event may go beyond it: its ends do not count yet.
        f"ends = 0.0 if {at('aimed')} > 0.0 else max(tilt0, tilt1)",
        f"largest = {at('largest_tilt')}",
        # An extreme that the cubic puts above all others so far is measured by the driver.
        f"peak = go * rose * (1.0 if 2.0 * extreme - ends > largest * {1.0 + _NEW_PEAK!r} else 0.0)",
        f"{at('peak')} = peak",
        "seen = max(ends, extreme * rose) * (1.0 - peak)",
        "seen = seen if go > 0.0 else 0.0",
        f"now = {at('time')} + h * (share if rose > 0.0 else (1.0 if tilt1 > tilt0 else 0.0))",
        f"before = {at('largest_at')}",
        f"{at('largest_at')} = now if seen > largest else before",
        f"{at('largest_tilt')} = max(largest, seen)",
        *(() if shape.planar else _passage(at)),
    ]


def _passage(at: Callable[[str], str]) -> tuple[str, ...]:
    return (
        f"passage = {at('least_passage')}",
        "closer = low if go * fell > 0.0 else passage",
        f"{at('least_passage')} = min(passage, closer)",
    )


def _turning(shape: Shape, rows: Rows) -> list[str]:
    if shape.planar:
        return []
    at = rows.at
    return [
        f"go = {at('go')}",
        f"x1 = {at('new_x')}",
        f"y1 = {at('new_y')}",
        f"momentum0 = {at('momentum')}",
        f"momentum1 = x1 * {at('new_vy')} - y1 * {at('new_vx')}",
        f"{at('turns')} = {at('turns')} + go * winding({at('x')}, {at('y')}, x1, y1, momentum0 + momentum1)",
        f"{at('momentum')} = momentum1 if go > 0.0 else momentum0",
        # A motion that has grown, or turned back, is followed with the usual tolerance.
        f"grown = max({at('new_tilt')} - {at('grown')}, -{at('new_radial')}) * go",
        f"full = {at('atol')}",
        f"atol = {at('atol_now')}",
        f"{at('atol_now')} = full if grown > 0.0 else atol",
    ]


def _keeping(shape: Shape, rows: Rows) -> list[str]:
    at = rows.at
    out = [f"go = {at('go')}"]

    def keep(target: str, value: str) -> None:
        # Both are read before the choice: a choice between two addresses would not become vector code.
        out.extend([f"new = {at(value)}", f"old = {at(target)}", f"{at(target)} = new if go > 0.0 else old"])

    for j in range(shape.order):
        keep(f"last{j}", f"y{j}")
        keep(f"last_slope{j}", f"k0_{j}")
        keep(f"y{j}", f"new{j}")
        keep(f"k0_{j}", f"k{_STAGES}_{j}")
    for name in ("tilt", "radial", "x", "y", "vx", "vy"):
        keep(f"{name}_before", name)
        keep(name, f"new_{name}")
    return out


def _next_step(shape: Shape, rows: Rows) -> list[str]:
    del shape
    at = rows.at
    return [
        f"h = {at('h')}",
        f"t = {at('time')}",
        f"go = {at('go')}",
        f"ok = {at('ok')}",
        f"stop = {at('stop')}",
        "remaining = stop - t",
        "reached = go * (1.0 if h >= remaining else 0.0)",
        f"{at('reached')} = reached",
        f"{at('tried')} = h",
        f"{at('made')} = h * go",
        "t1 = t + h * go",
        "t1 = stop if reached > 0.0 else t1",
        f"{at('time')} = t1",
        f"error = {at('error')}",
        f"error = {_LEAST_ERROR!r} if error < {_LEAST_ERROR!r} else error",
        f"factor = {_SAFETY!r} / math.sqrt(math.sqrt(math.sqrt(error)))",
        # Of a step that ran into NaN the factor is NaN, and the least one is taken.
        f"factor = factor if factor > {_LEAST_FACTOR!r} else {_LEAST_FACTOR!r}",
        f"most = 1.0 if {at('rejected')} > 0.0 else {_LARGEST_FACTOR!r}",
        "factor = factor if factor < most else most",
        f"{at('rejected')} = 1.0 - ok",
        f"{at('aimed')} = {at('aimed')} * ok",
        f"wanted = min(h * factor, {at('longest_step')})",
        f"{at('wanted')} = wanted",
        f"{at('h')} = min(wanted, {at('stop')} - t1)",
        f"{at('steps')} = {at('steps')} + go",
    ]


def _suspicion(shape: Shape, rows: Rows) -> list[str]:
    """Return what marks the lanes that the driver must look at.

    Those held back by an event, at a stop, aimed at an event, out of steps or stuck; in space also those perhaps
    coming to rest, or so near the upright that they pass it in closed form.
    """
    at = rows.at
    near = ["near = 0.0"]
    if not shape.planar:
        c = at("slenderness")
        near = [
            f"square = {at('vx')} * {at('vx')} + {at('vy')} * {at('vy')}",
            f"near = 1.0 if {at('low')} < {at('rest_tilt')} else 0.0",
            f"inward = 1.0 if {at('radial')} < 0.0 else 0.0",
            f"tilt = {at('tilt')}",
            f"close = 1.0 if tilt * tilt < {_HOP_FROM**2!r} * min({c} * {c}, square) else 0.0",
            f"momentum = {at('momentum')}",
            f"straight = 1.0 if momentum * momentum < {_HOP_OFFSET**2!r} * {c} * {c} * square else 0.0",
            "near = near + inward * close * straight",
        ]
    return [
        *near,
        f"over = 1.0 if {at('steps')} >= {at('most_steps')} else 0.0",
        f"stuck = 1.0 if abs({at('tried')}) < {_SHORTEST!r} * abs({at('time')}) + 1e-300 else 0.0",
        f"met = {at('reached')} + {at('aimed')} + {at('peak')} + near + over",
        f"{at('flag')} = {at('held')} + stuck * {at('rejected')} + {at('go')} * met",
    ]


def observation_source(shape: Shape) -> str:
    """Return the source of `observe(buf)`: integrals over the step just made, in the lanes that are watched.

    Each is the trapezoidal rule with its end correction, exact for cubics: of the tilt, and of the lean times
    e^{∓2πi t/T}, T being the period of the base motion.
    """
    rows = shape.rows()
    at = rows.at
    body = [
        f"h = {at('made')}",
        f"weight = h * {at('watched')}",
        f"correction = weight * h * {1.0 / 12.0!r}",
        f"rate0 = {at('radial_before')} / ({at('tilt_before')} + 1e-300)",
        f"rate1 = {at('radial')} / ({at('tilt')} + 1e-300)",
        f"{at('mean_tilt')} = {at('mean_tilt')} + 0.5 * weight * ({at('tilt_before')} + {at('tilt')})"
        " + correction * (rate0 - rate1)",
        f"seen = {at('watched')} * abs(h)",
        f"least = {at('late_least')}",
        f"low = {at('low')}",
        f"{at('late_least')} = min(least, low if seen > 0.0 else least)",
        f"w = {at('per_turn')}",
        f"turns1 = w * {at('time')}",
        "turns0 = turns1 - w * h",
        "cos0 = cos_turns(turns0)",
        "sin0 = cos_turns(turns0 - 0.25)",
        "cos1 = cos_turns(turns1)",
        "sin1 = cos_turns(turns1 - 0.25)",
        "w = 6.283185307179586 * w",
    ]
    for end, source in (("0", "_before"), ("1", "")):
        x, y = ("x_before", "y_before") if source else ("x", "y")
        vx, vy = f"vx{source}", f"vy{source}"
        body += [
            f"x{end} = {at(x)}",
            f"y{end} = {at(y)}",
            # Rates of x and y in a frame that turns with the forcing, and in one that turns against it.
            f"fx{end} = {at(vx)} + w * y{end}",
            f"fy{end} = {at(vy)} - w * x{end}",
            f"bx{end} = {at(vx)} - w * y{end}",
            f"by{end} = {at(vy)} + w * x{end}",
        ]
    for name, x, y, sign in (
        ("forward_cos", "x", "y", "+"),
        ("forward_sin", "y", "x", "-"),
        ("backward_cos", "x", "y", "-"),
        ("backward_sin", "y", "x", "+"),
    ):
        frame = name[0]
        values = [f"({x}{e} * cos{e} {sign} {y}{e} * sin{e})" for e in "01"]
        slopes = [f"({frame}{x}{e} * cos{e} {sign} {frame}{y}{e} * sin{e})" for e in "01"]
        body.append(
            f"{at(name)} = {at(name)} + 0.5 * weight * ({values[0]} + {values[1]})"
            f" + correction * ({slopes[0]} - {slopes[1]})"
        )
    lines = ["@vectorised", "def observe(buf):", "    for i in range(WIDTH):", *(f"        {line}" for line in body)]
    return "\n".join(lines) + "\n"
