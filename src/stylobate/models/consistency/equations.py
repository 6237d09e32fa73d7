"""Checks of the equations of a model: against each other, its derivatives, its forces and its compiled code."""

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any
from weakref import WeakSet

import numpy as np

from stylobate.errors import UnsupportedError
from stylobate.models.consistency.samples import Floats, Subject, not_numbers
from stylobate.models.model import Model, belongs_to_equations, owner_of

_AGREE = 1e-5  # relative, above the error of the differences
_IGNORED = 1e-9  # response to the base that counts as none
_DIRECTIONS = {
    "x": (1.0, 0.0),
    "y": (0.0, 1.0),
    "(x + y)/√2": (0.5**0.5, 0.5**0.5),
    "(y − x)/√2": (-(0.5**0.5), 0.5**0.5),
}


def problems_of_tilt_rate(subject: Subject) -> Iterator[str]:
    """Yield a line if the rate of the tilt that `tilt_of` returns is not the derivative of its tilt along `rates`.

    A state at which one of the two returns a number that is not finite is a line of its own.
    """
    c = subject.slenderness
    for state in subject.random_states(40 if subject.thorough else 4):
        push = (0.2 * c, -0.1 * c, 0.1)
        lean, change = subject.lean(state), subject.tilt_change(state, push)
        if not (np.isfinite(change).all() and np.isfinite(lean).all()):
            rates, at = subject.rates(state, push), subject.described(state, push)
            name, results = ("tilt_of", lean) if np.isfinite(rates).all() else ("rates", rates)
            yield not_numbers(subject, name, len(results), tuple(results.tolist()), at)
            return
        rate, found = lean[2:], change[:2]
        error = np.abs(found - rate)
        if error.max() > _AGREE * (c + np.hypot(*rate)):
            axis = int(np.argmax(error))
            yield (
                f"rates: the tilt along {'xy'[axis]} changes at another rate than tilt_of returns"
                f"{subject.origin('tilt_of')} (by {found[axis]:.4g} per unit of time, not {rate[axis]:.4g}, at "
                f"{subject.described(state, push)}). Return the rate of each state at its place in rates."
            )
            return


def problems_of_push(subject: Subject) -> Iterator[str]:
    """Yield a line if the base pushes the column to the wrong side.

    The base acts on the rim, and the centre of mass lags behind: an acceleration of the base along û accelerates the
    tilt along −û.
    """
    responses, c = _responses(subject), subject.slenderness
    if not _acts(responses):
        return
    for along, (response, _) in responses.items():
        if response > 0.0:
            yield (
                "rates: the column leans with the acceleration of the base instead of against it (a base "
                f"acceleration of {0.1 * c:.4g} g along {along} changes the tilt acceleration by "
                f"{0.1 * c * response:+.4g}, at a tilt of {subject.halfway:.4g} rad). Reverse the sign of this term, "
                "such as −ax for +ax."
            )
            return
        if not response:
            yield (
                f"rates: the base does not act along {along} although it acts along other directions (a base "
                f"acceleration of {0.1 * c:.4g} g along {along} changes the tilt acceleration by 0 along it, at a tilt "
                f"of {subject.halfway:.4g} rad). Add the term of ax to the rate of vx, and of ay to that of vy."
            )
            return


def problems_of_lift(subject: Subject) -> Iterator[str]:
    """Yield a line if an upward acceleration of the base accelerates a small tilt away from the vertical."""
    lifted = _response_to_lift(subject)
    if lifted > 0.0:
        yield (
            "rates: an upward acceleration of the base reduces the weight of the column (a base acceleration of 0.1 g "
            f"changes the tilt acceleration by {0.1 * lifted:+.4g}, at a tilt of {subject.halfway:.4g} rad). Multiply "
            "the terms of the weight by 1 + az."
        )


def lean_under_push(subject: Subject) -> str:
    """Return the side to which the column leans if the base accelerates."""
    if not _acts(_responses(subject)):
        return "the acceleration of the base does not act on the column"
    return "if the base accelerates to +x, the column leans to −x"


def weight_under_lift(subject: Subject) -> str:
    """Return the change of the weight if the base accelerates upwards."""
    change = "the weight grows" if _response_to_lift(subject) else "nothing changes"
    return f"if the base accelerates upwards, {change}"


def _responses(subject: Subject) -> dict[str, tuple[float, float]]:
    """Return the tilt acceleration along and across a direction, per base acceleration along it, by direction."""
    c, tilt, found = subject.slenderness, subject.halfway, {}
    for name, (ux, uy) in _DIRECTIONS.items():
        state = subject.state((tilt * ux, tilt * uy), (0.0, 0.0))
        back, ahead = (subject.tilt_acceleration(state, (a * ux, a * uy, 0.0)).tolist() for a in (-0.1 * c, 0.1 * c))
        x, y = ((after - before) / (0.2 * c) for before, after in zip(back, ahead, strict=True))
        found[name] = _noted(ux * x + uy * y), _noted(ux * y - uy * x)
    return found


def _noted(response: float) -> float:
    return response if abs(response) > _IGNORED else 0.0


def _acts(responses: dict[str, tuple[float, float]]) -> bool:
    """Return whether the base acts on the column in some direction."""
    return any(any(response) for response in responses.values())


def _response_to_lift(subject: Subject) -> float:
    """Return the tilt acceleration per upward base acceleration, at half of the tipping angle; 0 if negligible."""
    c = subject.slenderness
    state = subject.state((subject.halfway, 0.0), (0.0, 0.0))
    down, up = (float(subject.tilt_acceleration(state, (0.0, 0.0, a))[0]) for a in (-0.1, 0.1))
    return c * _noted((up - down) / (0.2 * c))


_STEP = 1e-4
_AGREE_IN_PLANE = 1e-6  # relative, above the error of the differences


def problems_of_maps(subject: Subject) -> Iterator[str]:
    """Yield a line if `tilt_of` does not return the tilt and the rate from which `start` makes a state."""
    c = subject.slenderness
    given = np.array([0.3 * c, -0.4 * c, 0.1 * c, 0.2 * c])
    state = subject.state((given[0], given[1]), (given[2], given[3]))
    found = np.array(subject.model.tilt_of(*state, *subject.numbers), dtype=float)
    if np.abs(found - given).max() > _AGREE_IN_PLANE * c:
        yield (
            "tilt_of: does not return the tilt and the rate from which start made the state "
            f"({_listed(given)} became {_listed(found)}). Return x, y, vx, vy, the rate in the time of the model."
        )


def problems_in_planes(subject: Subject) -> Iterator[str]:
    """Yield a line if `rates` along a line differ from `planar_rates`, at random states."""
    model, c = subject.model, subject.slenderness
    if model.planar_rates is None or model.from_plane is None:
        return
    random = subject.generator()
    for _ in range(40 if subject.thorough else 4):
        tilt = min(c * random.uniform(0.1, 2.0), 1.0) * random.choice([-1.0, 1.0])
        rate, horizontal = (c * random.uniform(-1.0, 1.0, 2)).tolist()
        vertical, azimuth = random.uniform(-0.5, 0.5), random.uniform(0.0, 2.0 * np.pi)
        line = (float(np.cos(azimuth)), float(np.sin(azimuth)))
        problem = _mapped_wrongly(subject, (tilt, rate), line) or _moved_wrongly(
            subject, (tilt, rate), line, (horizontal, vertical)
        )
        if problem:
            yield problem
            return


def _state(subject: Subject, motion: tuple[float, float], line: tuple[float, float]) -> np.ndarray:
    """Return the state of a tilt and its rate along a line."""
    assert subject.model.from_plane is not None
    return np.array(subject.model.from_plane(*motion, *line, *subject.numbers), dtype=float)


def _mapped_wrongly(subject: Subject, motion: tuple[float, float], line: tuple[float, float]) -> str:
    found = np.array(subject.model.tilt_of(*_state(subject, motion, line), *subject.numbers), dtype=float)
    if np.abs(found - np.outer(motion, line).ravel()).max() <= _AGREE_IN_PLANE * subject.slenderness:
        return ""
    return (
        f"from_plane{subject.origin('from_plane')}: does not return a state with the tilt {motion[0]:.3g} rad and the "
        f"rate {motion[1]:.3g} along ({_listed(np.array(line))}) (got {_listed(found)}). Make it agree with tilt_of."
    )


def _moved_wrongly(
    subject: Subject, motion: tuple[float, float], line: tuple[float, float], push: tuple[float, float]
) -> str:
    assert subject.model.planar_rates is not None
    (tilt, rate), side = motion, float(np.sign(motion[0]))
    falling, acceleration = subject.model.planar_rates(tilt, rate, side, *push, *subject.numbers)
    before, after = (_state(subject, (tilt + t * falling, rate + t * acceleration), line) for t in (-_STEP, _STEP))
    planar = (after - before) / (2.0 * _STEP)
    here = tuple(_state(subject, motion, line).tolist())
    spatial = subject.rates(here, (push[0] * line[0], push[0] * line[1], push[1]))
    error = np.abs(planar - spatial)
    if not np.isfinite(spatial).all() or error.max() <= _AGREE_IN_PLANE * (np.abs(spatial).max() + subject.slenderness):
        return ""
    worst = int(np.argmax(error))
    return (
        f"planar_rates: does not agree with rates{subject.origin('planar_rates')} "
        f"(rate of {subject.model.state_names[worst]} {planar[worst]:.4g}, not {spatial[worst]:.4g} as by rates, "
        f"at tilt {tilt:.3g} rad). Define planar_rates with the terms of rates, or set planar_rates = None."
    )


def _listed(values: np.ndarray) -> str:
    return ", ".join(f"{value:.4g}" for value in values)


def problems_of_derivatives(subject: Subject) -> Iterator[str]:
    """Yield a line if an entry of `jacobian` is not the derivative of a rate."""
    model, c = subject.model, subject.slenderness
    if model.jacobian is None:
        return
    for state in subject.random_states(4):
        point = np.array([*state, 0.2 * c, -0.3 * c, 0.1, *subject.numbers])
        found = np.array(model.jacobian(*point.tolist()), dtype=float)
        expected = np.stack([_difference(subject, point, place) for place in range(point.size)], axis=1)
        if found.shape != expected.shape:
            yield f"jacobian: has the shape {found.shape}, not {expected.shape}. Return a row for each state."
            return
        error = np.abs(found - expected) / (1.0 + np.abs(expected))
        if error.max() > _AGREE:
            row, place = np.unravel_index(int(np.argmax(error)), error.shape)
            yield (
                f"jacobian: entry ({row}, {place}) is not the derivative of rates{subject.origin('jacobian')} "
                f"({found[row, place]:.6g}, not {expected[row, place]:.6g}). Define it for these rates, or set "
                "jacobian = None."
            )
            return


def _difference(subject: Subject, point: np.ndarray, place: int) -> np.ndarray:
    step = 1e-5 * max(abs(point[place]), subject.slenderness)
    ahead, behind = point.copy(), point.copy()
    ahead[place] += step
    behind[place] -= step
    rates = [np.array(subject.model.rates(*one.tolist()), dtype=float) for one in (ahead, behind)]
    found: np.ndarray = (rates[0] - rates[1]) / (2.0 * step)
    return found


def problems_of_forces(subject: Subject) -> Iterator[str]:
    """Yield a line if `contact` is inherited although `rates` are new: its forces belong to other equations."""
    kind = type(subject.model)
    if subject.model.contact is None or belongs_to_equations(kind, "contact"):
        return
    owner = owner_of(kind, "contact")
    if not _moves_as(subject, owner):
        yield (
            f"contact: inherited from {owner.__name__}, returns forces of the equations of {owner.__name__}, which "
            "rates or parameters replace. Define contact for these equations, or set contact = None."
        )


def _moves_as(subject: Subject, owner: type) -> bool:
    """Return whether the equations of `owner` give the same rates with the parameters of the model."""
    assert issubclass(owner, Model)
    for state in subject.random_states(3):
        push = (0.1, -0.2, 0.1)
        try:
            theirs = np.array(owner.rates(*state, *push, *subject.numbers), dtype=float)
        except TypeError:
            return False
        ours = subject.rates(state, push)
        if theirs.shape != ours.shape or not np.allclose(theirs, ours, rtol=1e-9, atol=0.0, equal_nan=True):
            return False
    return True


_COUNT = 64  # states that are compared; a multiple of the width of every vector
_LAST_PLACES = 64.0 * float(np.finfo(float).eps)  # relative changes that count as rounding
_TRIALS, _SEVERAL = 8, 4.0

_COMPARED: WeakSet[Callable[..., Any]] = WeakSet()


def problems_of_compilation(subject: Subject) -> Iterator[str]:
    """Yield a line if compiled equations give other results than Python; the cheap check compares a function once.

    A compiler may fuse products with sums. Such rounding changes a result by less than changes of the last places of
    each argument do, or than the last places of the largest result.
    """
    for name in _equations(subject):
        function = getattr(subject.model, name)
        if subject.thorough or function not in _COMPARED:
            _COMPARED.add(function)
            yield from _problem(subject, name)


def compilation(subject: Subject) -> str:
    """Return whether compiled and plain equations agree."""
    for name in _equations(subject):
        if _both(subject, name) is None:
            return f"not compared with compiled code, because {name} is not compiled"
    return f"compiled code and Python agree ({' and '.join(_equations(subject))})"


def _equations(subject: Subject) -> tuple[str, ...]:
    """Return the names of the equations that runs use; the cheap check takes one."""
    model = subject.model
    if model.planar_rates is None:
        return ("rates",)
    if model.planar_only:
        return ("planar_rates",)
    return ("rates", "planar_rates") if subject.thorough else ("rates",)


def _problem(subject: Subject, name: str) -> Iterator[str]:
    both = _both(subject, name)
    if both is None:
        return
    rows, plain, compiled = both
    off = np.where(np.isfinite(compiled), np.abs(compiled - plain), np.inf)
    if off.max() <= _LAST_PLACES * np.abs(plain).max():
        return
    beyond = off - _rounding(getattr(subject.model, name), rows, plain)
    row, place = np.unravel_index(int(np.argmax(beyond)), off.shape)
    if beyond[row, place] > 0.0:
        yield (
            f"{name}: compiled code gives other results than Python (result {place + 1} is "
            f"{compiled[row, place]:.9g}, not {plain[row, place]:.9g}, for the arguments "
            f"{', '.join(f'{number:.6g}' for number in rows[row])}). Compute with floats, and pass numbers that "
            "change as parameters."
        )


def _both(subject: Subject, name: str) -> tuple[Floats, Floats, Floats] | None:
    """Return arguments, and results of Python and of compiled code; None if one of the two cannot compute."""
    function = getattr(subject.model, name)
    rows, plain = _plain(function, _arguments(subject, name))
    compiled = _compiled(function, rows, plain.shape[1], subject.model.name) if len(rows) else None
    return None if compiled is None else (rows, plain, compiled)


def _arguments(subject: Subject, name: str) -> Floats:
    """Return random arguments of the equations, shape (n, arguments)."""
    model, c, random = subject.model, subject.slenderness, subject.generator()
    numbers = np.tile(subject.numbers, (_COUNT, 1))
    push = random.uniform((-c, -c, -0.5), (c, c, 0.5), (_COUNT, 3))
    if name == "planar_rates":
        tilt, rate = random.uniform(-2.0 * c, 2.0 * c, (2, _COUNT))
        return np.column_stack([tilt, rate, np.sign(tilt), push[:, 0], push[:, 2], numbers])
    states = np.resize(np.array(subject.random_states(4)), (_COUNT, len(model.state_names)))
    varied = states * random.uniform(0.7, 1.3, states.shape)
    kept = [place in model.kept_states for place in range(len(model.state_names))]
    return np.hstack([np.where(kept, states, varied), push, numbers])


def _plain(function: Callable[..., Any], arguments: Floats) -> tuple[Floats, Floats]:
    """Return the rows at which plain Python gives finite numbers, repeated to the full count, and these numbers."""
    rows, found = [], []
    for row in arguments.tolist():
        try:
            result = np.array(function(*row), dtype=float)
        except (ArithmeticError, ValueError):
            continue
        if np.isfinite(result).all():
            rows.append(row)
            found.append(result)
    if not rows:
        return arguments[:0], arguments[:0]
    places = np.resize(np.arange(len(rows)), _COUNT)
    return np.array(rows)[places], np.array(found)[places]


def _compiled(function: Callable[..., Any], rows: Floats, results: int, name: str) -> Floats | None:
    """Return the results of compiled code, or None if the function is not compiled."""
    from stylobate.compiler.kept import runs_plain

    if runs_plain():
        return None
    out = np.empty((results, _COUNT))
    try:
        _program(function, rows.shape[1], results, name)(np.ascontiguousarray(rows.T), out)
    except UnsupportedError:
        return None
    return out.T


@cache
def _program(function: Callable[..., Any], arguments: int, results: int, name: str) -> Callable[..., int]:
    """Compile a function as kernels do: vectorised, with fused products and sums."""
    from stylobate.compiler.compiled import Compiled
    from stylobate.compiler.programs import Written
    from stylobate.compiler.unit import ArrayArgument

    lines = [
        "from stylobate.compiler.marks import fast, lanes",
        "@fast",
        "def evaluate(rows, out):",
        f"    for i in lanes({_COUNT}):",
        f"        found = function({', '.join(f'rows[{j}, i]' for j in range(arguments))})",
        *(f"        out[{j}, i] = found[{j}]" for j in range(results)),
    ]
    return Compiled(
        name="evaluate",
        program=lambda: Written("\n".join(lines) + "\n"),
        functions={"function": function},
        arguments=(ArrayArgument((arguments, _COUNT)), ArrayArgument((results, _COUNT))),
        model=name,
        description=f"{name}, {getattr(function, '__name__', 'function')} at random states",
        brief=True,
    )


def _rounding(function: Callable[..., Any], rows: Floats, plain: Floats) -> Floats:
    """Return the bound of the rounding error of each result: several times its largest change in all trials."""
    random = np.random.default_rng(1)
    bound: Floats = np.full(plain.shape[1], _LAST_PLACES * np.abs(plain).max())
    for _ in range(_TRIALS):
        factors = 1.0 + _LAST_PLACES * random.choice([-1.0, 1.0], rows.shape)
        changed = np.array([function(*row) for row in (rows * factors).tolist()], dtype=float)
        bound = np.maximum(bound, _SEVERAL * np.abs(changed - plain).max(axis=0))
    return bound
