"""Write a description as TOML, and as the equivalent Python program."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import tomlkit

import stylobate as sb
from stylobate.base_motions.declared import MOTIONS
from stylobate.config.profile_table import Corners
from stylobate.config.simulation import SimulationConfig
from stylobate.kinds import Kinds
from stylobate.models.declared import MODELS
from stylobate.quantities import parameters_of


def as_toml(values: Mapping[str, Any]) -> str:
    """Write plain `values`, such as those of a description, as TOML; keys that are None are left out.

    Examples
    --------
    >>> print(as_toml({"column": {"shape": "dimensionless", "slenderness": 0.1}, "duration": 20.0}), end="")
    duration = 20.0
    <BLANKLINE>
    [column]
    shape = "dimensionless"
    slenderness = 0.1
    """
    return tomlkit.dumps(_without_none(values))


def as_python(description: SimulationConfig) -> str:
    """Write a Python program that computes and plots the described run with public names.

    Values equal to their defaults are left out. A record that is joined, or processed by other steps than scale,
    rotation and tail, is written as a description.

    Examples
    --------
    >>> values = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "tilt": [0.05, 0.0], "duration": 20.0}
    >>> print(as_python(SimulationConfig.parse(values)), end="")
    import stylobate as sb
    <BLANKLINE>
    column = sb.Column.dimensionless(slenderness=0.1)
    model = sb.Wobbling(column)
    run = sb.simulate(model, tilt=(0.05, 0.0), duration=20.0)
    print(run.outcome.name, "-", run.reason)
    sb.plot(run).savefig("run.png")
    """
    model = description.model
    numbers = model.model_dump(exclude={"kind"}, exclude_defaults=True)
    lines = ["import stylobate as sb", "", f"column = {_column(description.column)}"]
    lines.append(f"model = {_maker(MODELS, model.kind)}({_joined(['column', *_of_model(model.make, numbers)])})")
    moved = description.motion.kind != "rest"
    if moved:
        lines.append(f"motion = {_motion(description.motion)}")
    lines += _run(description, moved=moved)
    return "\n".join([*lines, *_SHOWN, ""])


def _column(column: Any) -> str:
    """Return the Python expression of a described column."""
    own = column.model_dump(exclude={"shape", "parts"}, exclude_defaults=True)
    if isinstance(own.get("profile"), dict):
        own["profile"] = _Code(f"sb.Profile({_keywords(own['profile'])})")
    if column.shape == "profile" and "heights" not in own:
        own = {**asdict(Corners.read(Path(own["profile"]))), **own, "profile": Path(own["profile"]).name}
    numbers = _keywords(own)
    maker = "" if column.make is sb.Column else f".{column.make.__name__}"
    parts = [f"[{', '.join(_column(one) for one in column.parts)}]"] if hasattr(column, "parts") else []
    return f"sb.Column{maker}({_joined([*parts, numbers])})"


class _Code:
    """Text that is written as it is, in place of the `repr` of a value."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text


def _of_model(make: Callable[..., Any], numbers: Mapping[str, Any]) -> Iterable[str]:
    """Return the keyword of each number; a word in place of a number is the method of the column that computes it."""
    declared = parameters_of(make)
    for name, value in numbers.items():
        method = declared[name].quantity.by_word.get(value) if isinstance(value, str) else None
        yield _keywords({name: value}) if method is None else f"{name}=column.{method.__name__}()"


def _run(description: SimulationConfig, *, moved: bool) -> Iterable[str]:
    """Return the call of `simulate`, with the rules as an object."""
    options = description.model_dump(exclude={"column", "model", "motion", "rules"}, exclude_defaults=True)
    if options.get("duration", 0.0) is None:  # as long as the record
        del options["duration"]
    given = ["model", *(["motion"] if moved else []), _keywords(options)]
    if description.rules:
        given.append(f"rules=sb.OutcomeRules({_keywords(description.rules)})")
    return [f"run = sb.simulate({_joined(given)})"]


def _motion(motion: Any) -> str:
    """Return the Python expression of a described motion."""
    kind = str(motion.kind)
    numbers = motion.model_dump(exclude={"kind", "motion", "motions"}, exclude_defaults=True, exclude_none=True)
    if kind == "record":
        return _record(motion, numbers)
    if kind == "offset":
        return f"{_motion(motion.motion)}.offset({_keywords(numbers)})"
    if kind in _CHANGES:
        return _motion(motion.motion) + _changed(kind, numbers)
    own = []
    if hasattr(motion, "motions"):
        own = [f"motions=({', '.join(_motion(member) for member in motion.motions)},)"]
    elif hasattr(motion, "motion"):
        own = [f"motion={_motion(motion.motion)}"]
    return f"{_maker(MOTIONS, kind)}({_joined([*own, _keywords(numbers)])})"


def _maker(kinds: Kinds, kind: str) -> str:
    """Return the Python expression of the class or constructor of a kind: its public name, or its place."""
    if kind not in kinds:
        return f"sb.kinds.loaded({kind!r})"
    name = kinds.places[kind].rpartition(":")[2]
    return f"sb.{name}" if name.partition(".")[0] in sb.__all__ else f"sb.base_motions.{name}"


def _record(motion: Any, numbers: Mapping[str, Any]) -> str:
    plain = {"sample", "path", "units", "step", "scale", "rotation", "tail", "directions", "one_component"}
    several = not isinstance(numbers.get("path", ""), str)
    by_name = several and isinstance(numbers.get("directions"), Mapping)
    if set(numbers) - plain or ("directions" in numbers and not by_name):
        unchanged = {name for name, kind in _LAST.items() if numbers.get(name) == _CHANGES[kind][1]}
        values = {name: value for name, value in motion.values().items() if name not in unchanged}
        return f"sb.config.RecordMotion.parse({values!r}).build()"
    if "sample" in numbers:
        made = f"sb.sample_record({numbers['sample']!r})"
    else:
        names = ("units", "step", *(("directions", "one_component") if several else ()))
        reading = {name: value for name, value in numbers.items() if name in names}
        paths = [list(numbers["path"])] if several else numbers["path"]
        read = "sb.read_records" if several else "sb.read_record"
        made = f"{read}({_joined([repr(paths), _keywords(reading)])})" + ("[0]" if several else "")
    for name, kind in _LAST.items():
        made += _changed(kind, {_CHANGES[kind][0]: numbers[name]}) if name in numbers else ""
    return made


def _changed(kind: str, numbers: Mapping[str, Any]) -> str:
    """Return the call that changes a motion; empty if its number changes nothing."""
    name, neutral = _CHANGES[kind]
    change = numbers[name]
    # By default the vertical component is scaled with the horizontal ones.
    apart = {other: value for other, value in numbers.items() if other != name and value != change}
    if change == neutral and not apart:
        return ""
    return f".{kind}({_joined([repr(change), _keywords(apart)])})"


def _keywords(values: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={value!r}" for name, value in values.items())


def _joined(parts: Iterable[str]) -> str:
    return ", ".join(part for part in parts if part)


def _without_none(values: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: _without_none(value) if isinstance(value, Mapping) else value
        for name, value in values.items()
        if value is not None
    }


_CHANGES = {
    "scaled": ("factor", 1.0),
    "rotated": ("angle", 0.0),
    "delayed": ("delay", 0.0),
    "with_tail": ("length", 0.0),
}
"""Number of each change of a motion, and the value of the number that changes nothing."""

_LAST = {"scale": "scaled", "rotation": "rotated", "tail": "with_tail"}
"""Last changes of a record, in their order."""

_SHOWN = ('print(run.outcome.name, "-", run.reason)', 'sb.plot(run).savefig("run.png")')
"""Last lines of each program: the outcome and a figure of the history."""
