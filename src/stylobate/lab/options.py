"""Options of the page: columns, models and motions with their parameters, and presets, from their declarations."""

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from importlib.metadata import version
from importlib.resources import files
from typing import Any, get_args

from pydantic_core import PydanticUndefined

from stylobate.base_motions.declared import composite_kinds, motion_quantities
from stylobate.column.shapes import SHAPES
from stylobate.config.description import Config
from stylobate.config.parts import DESCRIBED_MODELS, ColumnConfig, MotionConfig, moves
from stylobate.engine.parameters import COLUMN_NAMES, MOTION_NAMES
from stylobate.lab import answers
from stylobate.lab.limits import Limits
from stylobate.models.declared import column_quantities, model_quantities
from stylobate.quantities import Quantity
from stylobate.records.joining import sample_names


def about(limits: Limits) -> answers.About:
    """Return all options."""
    motions = _kinds(_members(MotionConfig), "kind")
    return answers.About(
        version=version("stylobate"),
        limits=asdict(limits),
        shapes=[
            answers.Kind(**one)
            for one in _kinds(_members(ColumnConfig), "shape")
            if one["kind"] in SHAPES  # the others are available in files only
        ],
        models=[answers.Kind(**one) for one in _kinds(DESCRIBED_MODELS, "kind")],
        motions=[
            answers.Kind(**one, moves=moves(one))
            for one in motions
            if one["kind"] not in composite_kinds()  # available in files only
        ],
        samples=list(sample_names()),
        presets=presets(),
        lessons=lessons(),
    )


def _members(union: Any) -> tuple[type[Config], ...]:
    """Return the members of an annotated union of configurations."""
    members: tuple[type[Config], ...] = get_args(get_args(union)[0])
    return members


def _kinds(descriptions: Iterable[type[Config]], tag: str) -> Iterator[dict[str, Any]]:
    for description in descriptions:
        summary = (description.__doc__ or "").partition("\n")[0]
        fields = sorted(description.model_fields.items(), key=lambda item: not item[1].is_required())
        parameters = [_parameter(name, field) for name, field in fields if name != tag and not _is_table(field)]
        for kind in get_args(description.model_fields[tag].annotation):
            yield {"kind": kind, "name": kind.replace("_", " "), "about": summary, "parameters": parameters}


def _is_table(field: Any) -> bool:
    """Return whether a field holds an optional description, such as the profile of a column that results keep."""
    return any(isinstance(one, type) and issubclass(one, Config) for one in get_args(field.annotation))


def _parameter(name: str, field: Any) -> answers.Parameter:
    quantity = NUMBERS.get(name, Quantity())
    first, last = quantity.slider or (None, None)
    default = None if field.default is PydanticUndefined else field.default
    choices = [*quantity.choices, *(one for one in get_args(field.annotation) if isinstance(one, str))]
    return answers.Parameter(
        name=name,
        symbol=quantity.symbol,
        unit=quantity.unit,
        about=quantity.text,
        default=list(default) if isinstance(default, tuple) else default,
        needed=field.is_required(),
        varies=name in VARIED,
        **{"from": first, "to": last},
        **({"choices": choices} if choices else {}),
    )


# Numbers

NUMBERS: Mapping[str, Quantity] = {
    **column_quantities(),
    **model_quantities(),
    **motion_quantities(),
    "scale": Quantity(text="scale factor", slider=(0.1, 4.0)),
    "rotation": Quantity(unit="rad", text="rotation about the vertical", slider=(-3.142, 3.142)),
    "tail": Quantity(unit="s", text="free-vibration time after the record"),
}
"""The numbers of columns, models and base motions; without a range a slider is centred on the present value."""

_PATHS_AND_RATES = ("m", "m/s", "Hz", "1/min")

CASE_NUMBERS = {
    # A sweep varies a radius at constant mass; the mass of a body of a described shape depends on its radius.
    "column": {name: one for name, one in column_quantities().items() if name not in COLUMN_NAMES or name == "radius"},
    # Displacements and rates, from which acceleration and angular frequency follow; a sweep supports these.
    "motion": {
        name: one for name, one in motion_quantities().items() if one.unit in _PATHS_AND_RATES and one.components == 1
    },
}
"""Numbers that an axis can vary besides the quantities of sweeps, by the part that they describe."""

VARIED = frozenset(
    {*COLUMN_NAMES, *MOTION_NAMES, *model_quantities(), *CASE_NUMBERS["column"], *CASE_NUMBERS["motion"]}
)
"""The numbers of columns, models and base motions that a map can vary."""

# Presets and lessons


def presets() -> list[answers.Preset]:
    """Return all presets, from `presets.toml` beside this file."""
    return [answers.Preset(**{"view": {}, **one}) for one in _listed("preset")]


def lessons() -> list[answers.Lesson]:
    """Return the lessons of the tour, from `lessons.toml` beside this file; the page opens with the first."""
    return [answers.Lesson(**{"view": {}, **one}) for one in _listed("lesson")]


def _listed(name: str) -> list[dict[str, Any]]:
    text = (files("stylobate.lab") / f"{name}s.toml").read_text(encoding="utf-8")
    found: list[dict[str, Any]] = tomllib.loads(text)[name]
    return found
