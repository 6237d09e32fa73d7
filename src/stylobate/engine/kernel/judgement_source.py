"""Writes the loops that judge a step: its error, events in it, extremes of the tilt, turning, the next step."""

from collections.abc import Callable

from stylobate.engine import dop853
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.series_source import polynomial, wanted_lines
from stylobate.engine.kernel.shape import SERIES_ORDER, STAGES, Shape
from stylobate.engine.kernel.stage_source import combination, reciprocal_scales
from stylobate.engine.tolerances import HOP_FROM, HOP_OFFSET, SLIP_SHARE
from stylobate.models import Contact

# Step control as SciPy's: safety 0.9, a step changes by 0.2 to 10, an error below the last number counts as that.
_SAFETY, _LEAST_FACTOR, _LARGEST_FACTOR, _LEAST_ERROR = 0.9, 0.2, 10.0, 1e-12
# A step shorter than this part of the time cannot be made.
_SHORTEST = 2.3e-15
# A largest tilt within a step is measured if it may exceed the largest so far by this part.
_NEW_PEAK = 1e-7


def judgement(shape: Shape, rows: Rows) -> list[str]:
    """Return the loops that accept or reject the step and note what happened in it.

    Each is straight-line code with selects; what one finds goes to the next as numbers 0 and 1 in rows.
    """
    # A loop too short would be unrolled before it could become vector code.
    loops = ((_error, _acceptance), (_extremes, _turning), (_keeping, _next_step, _suspicion))
    lines: list[str] = []
    for parts in loops:
        lines.append("    for i in lanes(WIDTH):")
        lines += [f"        {text}" for part in parts for text in part(shape, rows)]
    return lines


def _error(shape: Shape, rows: Rows) -> list[str]:
    at = rows.at
    if shape.series:  # told with the step
        return []
    out = [
        "e5 = 0.0",
        "e3 = 0.0",
        *_finer(shape, rows),
        *(
            f"scale{j} = {'finer' if j in shape.slip else at('atol_now')}"
            f" + {at('rtol')} * max(abs({at(f'y{j}')}), abs({at(f'new{j}')}))"
            for j in range(shape.order)
        ),
    ]
    out += reciprocal_scales(shape.order)
    for j in range(shape.order):
        stages = [at(f"k{s}_{j}") for s in range(STAGES + 1)]
        for name, weights in (("e5", dop853.E5), ("e3", dop853.E3)):
            out += [f"q = ({combination(weights, stages)}) * per_scale{j}", f"{name} = {name} + q * q"]
    return [
        *out,
        "spread = e5 + 0.01 * e3",
        f"{at('error')} = abs({at('h')}) * e5 / math.sqrt(spread * {float(shape.order)!r} + 1e-300)",
    ]


def _finer(shape: Shape, rows: Rows) -> list[str]:
    """Return what finds the absolute tolerance of slip, of a model whose contact can slip."""
    if not shape.slip:
        return []
    contact, atol = rows.at(f"y{shape.order - 1}"), rows.at("atol_now")
    return [
        f"slips = 1.0 if {contact} == {float(Contact.SLIPPING)!r} or {contact} == {float(Contact.SLIDING)!r} else 0.0",
        f"atol = {atol}",
        f"finer = {SLIP_SHARE!r} * atol if slips > 0.0 else atol",
    ]


def _acceptance(shape: Shape, rows: Rows) -> list[str]:
    """Return what finds the new lean, and whether the step is good, and taken or held back by an event."""
    at = rows.at
    new = [at(f"new{j}") for j in range(shape.order)]
    if shape.planar:
        lean = [f"x1 = {new[0]}", "y1 = 0.0", f"vx1 = {new[1]}", "vy1 = 0.0"]
    else:
        lean = [f"x1, y1, vx1, vy1 = tilt_of({', '.join([*new, *(at(f'p{j}') for j in range(shape.parameters))])})"]
    return [
        *lean,
        "tilt1 = math.sqrt(x1 * x1 + y1 * y1)",
        "radial1 = x1 * vx1 + y1 * vy1",
        *_past(shape, rows),
        f"ok = 1.0 if {at('error')} < 1.0 else 0.0",
        f"ahead = (1.0 if past > 0.0 else 0.0) * (0.0 if {at('aimed')} > 0.0 else 1.0)",
        f"{at('ok')} = ok",
        f"{at('held')} = ok * ahead",
        f"{at('go')} = ok * (1.0 - ahead)",
        *(f"{at(f'new_{name}')} = {name}1" for name in ("x", "y", "vx", "vy", "tilt", "radial")),
    ]


def _past(shape: Shape, rows: Rows) -> list[str]:
    """Return what is positive where the step goes beyond an event."""
    at = rows.at
    if shape.guards:  # looked at before
        return [f"past = {at('broken')}"]
    tilts = [f"past = min(tilt1 - {at('no_return')}, radial1)", f"past = max(past, tilt1 - {at('tilt_limit')})"]
    if not shape.planar:
        return tilts
    return [
        *tilts,
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
    """Return what notes the least and the largest tilt within the step.

    They are told of the square of the tilt, whose least value at a passage of the upright is kept; in a plane of the
    tilt itself, which may begin at the upright.
    """
    at = rows.at
    return [
        f"h = {at('h')}",
        f"go = {at('go')}",
        f"tilt0 = {at('tilt')}",
        f"tilt1 = {at('new_tilt')}",
        *(_by_series(at) if shape.series else _by_cubic(shape, at)),
        "low = lowest if fell > 0.0 else min(tilt0, tilt1)",
        f"{at('low')} = low",
        # A step towards an event may go beyond it: its ends do not count yet.
        f"ends = 0.0 if {at('aimed')} > 0.0 else max(tilt0, tilt1)",
        f"largest = {at('largest_tilt')}",
        # An extreme that may be above all others so far is measured by the driver, which looks at aimed steps anyway.
        "highest = highest if rose > 0.0 else 0.0",
        f"above = max(2.0 * highest - ends - largest * {1.0 + _NEW_PEAK!r}, {at('aimed')})",
        "peak = go * rose * (1.0 if above > 0.0 else 0.0)",
        f"{at('peak')} = peak",
        "seen = max(ends, highest) * (1.0 - peak)",
        "seen = seen if go > 0.0 else 0.0",
        f"now = {at('time')} + h * (share if rose > 0.0 else (1.0 if tilt1 > tilt0 else 0.0))",
        f"before = {at('largest_at')}",
        f"{at('largest_at')} = now if seen > largest else before",
        f"{at('largest_tilt')} = max(largest, seen)",
        *_least(at, "least_tilt"),
        *(() if shape.planar else _least_passage(at)),
        *_slow(shape, at),
    ]


def _slow(shape: Shape, at: Callable[[str], str]) -> list[str]:
    """Return what tells whether the column may have been slow enough to come to rest within the step.

    Its speed within lies no further below that at the ends than it changed, or its weight may have changed it. A step
    by series may be long: it is always looked at.
    """
    if shape.planar or shape.guards:
        return []
    if shape.series:
        return [f"{at('slow')} = 1.0"]
    before, after = ("vx", "vy"), ("new_vx", "new_vy")
    changes = [f"({at(new)} - {at(old)})" for old, new in zip(before, after, strict=True)]
    squares = [" + ".join(f"{at(name)} * {at(name)}" for name in names) for names in (before, after)]
    return [
        f"pull = h * {at('slenderness')}",
        f"change = {' + '.join(f'{one} * {one}' for one in changes)} + pull * pull",
        f"slowest = min({squares[0]}, {squares[1]})",
        f"{at('slow')} = 1.0 if slowest < 2.0 * (change + {at('slow_square')}) else 0.0",
    ]


# Whether a function falls and then rises between two places with these slopes, or the other way round.
_FELL = "(1.0 if {} < 0.0 else 0.0) * (1.0 if {} > 0.0 else 0.0)"
_ROSE = "(1.0 if {} > 0.0 else 0.0) * (1.0 if {} < 0.0 else 0.0)"


def _by_cubic(shape: Shape, at: Callable[[str], str]) -> list[str]:
    """Return what finds the one extreme of a cubic: `fell` and `lowest`, or `rose`, `highest` and its `share` of it."""
    if shape.planar:
        followed = [
            f"start = {at('side')} * {at('x')}",
            f"end = {at('side')} * {at('new_x')}",
            f"slope0 = {at('side')} * {at('vx')} * h",
            f"slope1 = {at('side')} * {at('new_vx')} * h",
        ]
    else:
        followed = [
            "start = tilt0 * tilt0",
            "end = tilt1 * tilt1",
            f"slope0 = 2.0 * {at('radial')} * h",
            f"slope1 = 2.0 * {at('new_radial')} * h",
        ]
    return [
        *followed,
        f"fell = {_FELL.format('slope0', 'slope1')}",
        f"rose = {_ROSE.format('slope0', 'slope1')}",
        "share, highest = turning_point(start, end, slope0, slope1, rose - fell)",
        "highest = max(highest, 0.0)" if shape.planar else "highest = math.sqrt(max(highest, 0.0))",
        "lowest = highest",
    ]


def _by_series(at: Callable[[str], str]) -> list[str]:
    """Return the same for a step by series, which may be long: cubics over its halves tell places, the series values.

    In each half there is one extreme at most; of two lows or two highs the first is taken.
    """
    *lower, last = (at(f"square{k}") for k in range(SERIES_ORDER + 1))
    out = ["half = 0.5 * h", f"square1 = {last}", "slope1 = 0.0"]
    for coefficient in reversed(lower):
        out += ["slope1 = slope1 * half + square1", f"square1 = square1 * half + {coefficient}"]
    out += [
        "slope1 = slope1 * half",
        "square0 = tilt0 * tilt0",
        "square2 = tilt1 * tilt1",
        f"slope0 = 2.0 * {at('radial')} * half",
        f"slope2 = 2.0 * {at('new_radial')} * half",
    ]
    for name, pattern, value, place, sign in (
        ("fell", _FELL, "lowest", "at_low", -1.0),
        ("rose", _ROSE, "highest", "share", 1.0),
    ):
        out += [
            f"early = {pattern.format('slope0', 'slope1')}",
            f"{name} = max(early, {pattern.format('slope1', 'slope2')})",
            *(f"{end} = {a} if early > 0.0 else {b}" for end, a, b in _HALVES),
            f"{place}, _ = turning_point(start, end, slope, end_slope, {sign!r})",
            f"{place} = 0.5 * ({place} + (0.0 if early > 0.0 else 1.0))",
            f"{value} = math.sqrt(max({polynomial([*lower, last], f'({place} * h)')}, 0.0))",
        ]
    return out


_HALVES = (
    ("start", "square0", "square1"),
    ("end", "square1", "square2"),
    ("slope", "slope0", "slope1"),
    ("end_slope", "slope1", "slope2"),
)


def _least(at: Callable[[str], str], row: str) -> tuple[str, ...]:
    return (
        f"least = {at(row)}",
        "closer = low if go * fell > 0.0 else least",
        f"{at(row)} = min(least, closer)",
    )


def _least_passage(at: Callable[[str], str]) -> tuple[str, ...]:
    """Return what notes the least tilt of passages that are not as slow as rest."""
    return (
        f"square = {at('new_vx')} * {at('new_vx')} + {at('new_vy')} * {at('new_vy')}",
        f"fell = fell if square > {at('rest_square')} else 0.0",
        *_least(at, "least_passage"),
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

    def keep(target: str, value: str, before: str | None = None) -> None:
        # Both are read before the choice: a choice between two addresses would not become vector code. What was
        # before a step that was not made is never looked at.
        out.extend([f"new = {at(value)}", f"old = {at(target)}"])
        if before is not None:
            out.append(f"{at(before)} = old")
        out.append(f"{at(target)} = new if go > 0.0 else old")

    for j in range(shape.order):
        keep(f"y{j}", f"new{j}", f"last{j}")
        if not shape.series:
            keep(f"k0_{j}", f"k{STAGES}_{j}", f"last_slope{j}")
    for name in ("tilt", "radial", "x", "y", "vx", "vy"):
        keep(name, f"new_{name}")
    return out


def _next_step(shape: Shape, rows: Rows) -> list[str]:
    at = rows.at
    return [
        f"h = {at('h')}",
        f"t = {at('time')}",
        f"go = {at('go')}",
        f"ok = {at('ok')}",
        f"stop = {at('stop')}",
        "remaining = stop - t",
        # By a rounding a step shorter than what remains may reach the stop too.
        "reached = go * (1.0 if max(h - remaining, t + h - stop) >= 0.0 else 0.0)",
        f"{at('reached')} = reached",
        f"{at('tried')} = h",
        f"{at('made')} = h * go",
        "t1 = t + h * go",
        "t1 = stop if reached > 0.0 else t1",
        f"{at('time')} = t1",
        *(wanted_lines(rows) if shape.series else _wanted(rows)),
        f"{at('rejected')} = 1.0 - ok",
        f"{at('aimed')} = {at('aimed')} * ok",
        f"{at('wanted')} = wanted",
        f"{at('h')} = min(wanted, {at('stop')} - t1)",
        f"{at('steps')} = {at('steps')} + go",
    ]


def _wanted(rows: Rows) -> list[str]:
    """Return what chooses the next step from the error of this one, before stops cut it."""
    at = rows.at
    return [
        f"error = {at('error')}",
        f"error = {_LEAST_ERROR!r} if error < {_LEAST_ERROR!r} else error",
        f"factor = {_SAFETY!r} / math.sqrt(math.sqrt(math.sqrt(error)))",
        # Of a step that ran into NaN the factor is NaN, and the least one is taken.
        f"factor = factor if factor > {_LEAST_FACTOR!r} else {_LEAST_FACTOR!r}",
        f"most = 1.0 if {at('rejected')} > 0.0 else {_LARGEST_FACTOR!r}",
        "factor = factor if factor < most else most",
        f"wanted = min(h * factor, {at('longest_step')})",
    ]


def _suspicion(shape: Shape, rows: Rows) -> list[str]:
    """Return what marks the lanes that the driver must look at.

    Those held back by an event, at a stop, aimed at an event, out of steps or stuck; in space also those perhaps
    coming to rest, or so near the upright that they pass it in closed form, where no guards tell so.
    """
    at = rows.at
    near = ["near = 0.0"]
    if not shape.planar and not shape.guards:
        c = at("slenderness")
        near = [
            f"square = {at('vx')} * {at('vx')} + {at('vy')} * {at('vy')}",
            f"lowest = {at('slow')} * {at('rest_tilt')}",
            f"near = 1.0 if {at('low')} < max(lowest, {at('passage_tilt')}) else 0.0",
            f"inward = 1.0 if {at('radial')} < 0.0 else 0.0",
            f"tilt = {at('tilt')}",
            f"close = 1.0 if tilt * tilt < {HOP_FROM**2!r} * min({c} * {c}, square) else 0.0",
            f"momentum = {at('momentum')}",
            f"straight = 1.0 if momentum * momentum < {HOP_OFFSET**2!r} * {c} * {c} * square else 0.0",
            "near = near + inward * close * straight",
        ]
    return [
        *near,
        f"over = 1.0 if {at('steps')} >= {_most_steps(shape, at)} else 0.0",
        f"stuck = 1.0 if abs({at('tried')}) < {_SHORTEST!r} * abs({at('time')}) + 1e-300 else 0.0",
        f"met = {at('reached')} + {at('aimed')} + {at('peak')} + near + over",
        f"flag = {at('held')} + stuck * {at('rejected')} + {at('go')} * met",
        # Of a lane without a run, guards tell nothing.
        f"{at('flag')} = flag * (0.0 if {at('run')} < 0.0 else 1.0)" if shape.guards else f"{at('flag')} = flag",
    ]


def _most_steps(shape: Shape, at: Callable[[str], str]) -> str:
    """Return after how many steps the driver must look at a lane."""
    return f"min({at('most_steps')}, {at('stiff_look_at')})" if shape.guards else at("most_steps")
