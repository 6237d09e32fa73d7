"""Links that open a case in the page: `column=dimensionless,slenderness:0.1&model=slender&motion=rest&tilt=0.05,0`.

Such a text stands after the # of the address. The page reads and writes it in `web/src/page/view/link.ts`.
"""

import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any
from urllib.parse import quote

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.column import Column
from stylobate.column.shapes import SHAPES
from stylobate.config.parts import STEADY_MODEL
from stylobate.config.simulation import SimulationConfig, config_of
from stylobate.errors import ConfigError, ParameterError, StylobateError, UnsupportedError
from stylobate.lab.kernels import CASE, program_of
from stylobate.lab.options import lessons, presets
from stylobate.models import Model
from stylobate.provenance import provenance_of_run
from stylobate.quantities import parameters_of
from stylobate.records.joining import sample_names
from stylobate.run_arguments import Accuracy, InitialConditions, arguments_of, numbers_of
from stylobate.studies import steady_start
from stylobate.text import did_you_mean

_PARTS = {"column": "shape", "model": "kind", "motion": "kind"}
"""Parts of a description, each with the name of its kind."""

_ACCURACY = {*arguments_of(Accuracy), "recheck", "samples"} - {"tilt_limit"}
"""Arguments of a run that are no part of its case: the page has its own values."""


_OF_A_RECORD = {"kind", "sample", "scale", "rotation", "tail"}
"""Keys of the records that the page computes: those of the package, without further processing."""


def link_to(values: Mapping[str, Any]) -> str:
    """Write the link to the case that plain values describe.

    Examples
    --------
    >>> case = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "model": {"kind": "slender"}}
    >>> link_to({**case, "motion": {"kind": "straight", "acceleration": 0.2, "angular_frequency": 4.0}, "duration": 20})
    'column=dimensionless,slenderness:0.1&model=slender&motion=straight,acceleration:0.2,angular_frequency:4&duration=20'
    """
    items = [f"{part}={_part(values[part], tag)}" for part, tag in _PARTS.items() if part in values]
    items += [
        f"{name}={','.join(map(_atom, value)) if isinstance(value, (list, tuple)) else _atom(value)}"
        for name, value in values.items()
        if name not in _PARTS and value is not None
    ]
    return "&".join(items)


def _part(part: Mapping[str, Any], tag: str) -> str:
    rest = [f"{name}:{_in_part(value)}" for name, value in part.items() if name != tag and value is not None]
    return ",".join([str(part[tag]), *rest])


def _in_part(value: Any) -> str:
    if isinstance(value, (list, tuple)) and not any(isinstance(one, (list, tuple, Mapping)) for one in value):
        return "/".join(map(_atom, value)) + ("/" if len(value) == 1 else "")
    return _atom(value)


# As a name in a link has a mark before it if it could be read as something else.
_NO_NAME = re.compile(r"[-+.\d'~]|(none|true|false)$")
_UNESCAPED = "!'()*-._~"


def _atom(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        return repr(value).removesuffix(".0")
    if isinstance(value, str):
        return ("'" if _NO_NAME.match(value) else "") + quote(value, safe=_UNESCAPED)
    text = json.dumps(value, separators=(",", ":"), ensure_ascii=False)
    return "none" if value is None else f"~{quote(text, safe=_UNESCAPED)}"


def link_to_listed(group: str, identity: str) -> tuple[str, str]:
    """Return the link to a preset (`group` "case") or a lesson (`group` "lesson"), and its title.

    Raises
    ------
    ParameterError
        If the page has no such group, preset or lesson.
    """
    if group not in ("case", "lesson"):
        raise ParameterError(f"group: unknown group (got {group!r}). Use case or lesson.")
    titles = {one.identity: one.title for one in (presets() if group == "case" else lessons())}
    if identity not in titles:
        remedy = did_you_mean(identity, titles) or f"Use one of {', '.join(titles)}."
        raise ParameterError(f"{group}: unknown {group} (got {identity!r}). {remedy}")
    return f"{group}={identity}", titles[identity]


def case_of_provenance(provenance: Mapping[str, Any]) -> dict[str, Any]:
    """Return the case of a run from its `provenance` as the shortest plain values that describe it.

    Raises
    ------
    UnsupportedError
        If descriptions do not support the model or base motion of the run.
    """
    return shortest(config_of(provenance))


def case_of_objects(objects: Iterable[object]) -> dict[str, Any] | None:
    """Return the case of the only model and the only base motion among these `objects`, without initial condition.

    Returns
    -------
    dict or None
        None if there are no such objects, or several. If the model is the slender one and rolls steadily under the
        motion, `start` is the branch of steady rolling on which the page starts the run.
    """
    found = list(objects)
    models = [one for one in found if isinstance(one, Model)]
    motions = [one for one in found if isinstance(one, BaseMotion)]
    if not (len(models) == len(motions) == 1):
        return None
    (model,), (motion,) = models, motions
    try:
        case = case_of_provenance(provenance_of_run(model, motion))
    except (ConfigError, UnsupportedError):
        return None
    return {**case, "start": UPPER} if case["model"]["kind"] == STEADY_MODEL and _rolls(model, motion) else case


UPPER = "upper"


def _rolls(model: Model, motion: BaseMotion) -> bool:
    if not isinstance(motion, Harmonic):
        return False
    try:
        steady_start(model, motion, branch=UPPER)
    except StylobateError:
        return False
    return True


def shortest(described: SimulationConfig) -> dict[str, Any]:
    """Return plain values of a described run without defaults and without its accuracy.

    A column that its mass and inertia describe is a dimensionless or a solid one if that has the same numbers.
    """
    values: dict[str, Any] = described.model_dump(mode="json", exclude_defaults=True, exclude_none=True)
    parts = {
        part: {tag: getattr(getattr(described, part), tag), **values.get(part, {})} for part, tag in _PARTS.items()
    }
    if parts["column"]["shape"] == "given":
        given = described.column.build()
        parts["column"] = next((one for one in _with_fewer_numbers(given) if _has(one, given)), parts["column"])
    parts["motion"] = _scaled(parts["motion"], described.motion)
    others = {name: value for name, value in values.items() if name not in (*_PARTS, *_ACCURACY)}
    return {**parts, **others}


def _scaled(motion: Mapping[str, Any], described: Any) -> dict[str, Any]:
    """Return a motion in plain values; a record that is only scaled has `scale` in place of its processing."""
    steps = [step.model_dump(exclude_none=True) for step in getattr(described, "processing", ())]
    match steps:
        case [{"method": "scaled", "factor": factor, **rest}] if not rest and "scale" not in motion:
            return {**{name: value for name, value in motion.items() if name != "processing"}, "scale": factor}
    return dict(motion)


_DIGITS = 12


def _with_fewer_numbers(column: Column) -> Iterator[dict[str, Any]]:
    """Yield descriptions that a column may have besides that by its mass and inertia."""
    base = column.mass * column.radius**2
    yield _described("dimensionless", column, inertia_ratio=column.mass_height, axial_ratio=column.axial_inertia / base)
    if column.height is not None:
        yield _described("solid", column, density=column.mass / (math.pi * column.radius**2 * column.height))


def _described(shape: str, column: Column, **numbers: float) -> dict[str, Any]:
    """Describe a column by the numbers of a shape; `numbers` are those that a column does not have."""
    declared = {name: one for name, one in parameters_of(SHAPES[shape]).items() if name != "mass"}
    exact = {name: numbers[name] if name in numbers else getattr(column, name) for name in declared}
    rounded = {name: float(f"{value:.{_DIGITS}g}") for name, value in exact.items()}
    return {"shape": shape, **{name: value for name, value in rounded.items() if value != declared[name].default}}


def _has(described: Mapping[str, Any], column: Column) -> bool:
    """Return whether a described column has the numbers of `column`, to rounding."""
    shape, *_ = described.values()
    numbers = {name: value for name, value in described.items() if name != "shape"}
    try:
        made = SHAPES[shape](**numbers)
    except ParameterError:
        return False
    pairs = [(getattr(made, name), getattr(column, name)) for name in parameters_of(Column)]
    return all(
        one == other or (None not in (one, other) and math.isclose(one, other, rel_tol=10.0 ** (1 - _DIGITS)))
        for one, other in pairs
    )


def is_answered_in_the_page(values: Mapping[str, Any]) -> bool:
    """Return whether the page computes the run that these plain values describe, without a server."""
    shapes = {variant.of for variant in CASE.variants.values()}
    known = {*_PARTS, *numbers_of(InitialConditions), "duration", "start"}
    if not set(values) <= known or f"column_{values['column']['shape']}" not in shapes:
        return False
    motion = values["motion"]
    if motion["kind"] == "record" and not (motion.keys() <= _OF_A_RECORD and motion.get("sample") in sample_names()):
        return False
    return program_of(values) is not None
