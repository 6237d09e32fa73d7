"""Options of the laboratory: columns, models and motions with their parameters, and presets."""

from collections.abc import Iterable
from dataclasses import asdict
from importlib.metadata import version
from typing import Any, get_args

from pydantic_core import PydanticUndefined

from stylobate.base_motions.declared import composite_kinds
from stylobate.config.columns import ColumnConfig
from stylobate.config.description import Config
from stylobate.config.models import DESCRIBED_MODELS
from stylobate.config.motions import MotionConfig, is_to_end
from stylobate.errors import Outcome
from stylobate.lab.limits import Limits
from stylobate.lab.parameter_info import NUMBERS, VARIED, Number
from stylobate.lab.presets import presets
from stylobate.records.joining import sample_names


def about(limits: Limits) -> dict[str, Any]:
    """Return all options as plain values."""
    motions = (
        {**kind, "ends": is_to_end(kind)}
        for kind in _kinds(_members(MotionConfig), "kind")
        if kind["kind"] not in composite_kinds()  # available in files only
    )
    return {
        "version": version("stylobate"),
        "limits": asdict(limits),
        "shapes": list(_kinds(_members(ColumnConfig), "shape")),
        "models": list(_kinds(DESCRIBED_MODELS, "kind")),
        "motions": list(motions),
        "samples": [{"name": name, "about": "sample record"} for name in sample_names()],
        "presets": [
            {
                "id": one.identity,
                "title": one.title,
                "about": one.about,
                "description": one.description,
                "view": one.view,
            }
            for one in presets()
        ],
        "outcomes": [{"name": one.name, "value": one.label, "code": int(one)} for one in Outcome],
    }


def _members(union: Any) -> tuple[type[Config], ...]:
    """Return the members of an annotated union of configurations."""
    members: tuple[type[Config], ...] = get_args(get_args(union)[0])
    return members


def _kinds(descriptions: Iterable[type[Config]], tag: str) -> Iterable[dict[str, Any]]:
    for description in descriptions:
        summary = (description.__doc__ or "").partition("\n")[0]
        fields = sorted(description.model_fields.items(), key=lambda item: not item[1].is_required())
        numbers = [_parameter(name, field) for name, field in fields if name != tag]
        for kind in get_args(description.model_fields[tag].annotation):
            yield {"kind": kind, "name": kind.replace("_", " "), "about": summary, "parameters": numbers}


def _parameter(name: str, field: Any) -> dict[str, Any]:
    number = NUMBERS.get(name, Number())
    default = None if field.default is PydanticUndefined else field.default
    choices = [*number.choices, *(one for one in get_args(field.annotation) if isinstance(one, str))]
    return {
        "name": name,
        "symbol": number.symbol,
        "unit": number.unit,
        "about": number.about,
        "default": list(default) if isinstance(default, tuple) else default,
        "needed": field.is_required(),
        "varies": name in VARIED,
        "from": number.first,
        "to": number.last,
        **({"choices": choices} if choices else {}),
    }
