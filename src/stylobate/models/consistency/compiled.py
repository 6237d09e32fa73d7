"""Check of compiled against plain equations, at random states."""

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any
from weakref import WeakSet

import numpy as np

from stylobate.errors import UnsupportedError
from stylobate.models.consistency.samples import Floats, Subject

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
