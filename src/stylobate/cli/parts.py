"""Columns, models and base motions: their kinds, and the options from the declarations of these kinds."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from stylobate.cli.declarations import MAX_NAMED_KINDS, Group, Option, listed, text_of, type_of
from stylobate.cli.own_classes import Chosen
from stylobate.kinds import loaded
from stylobate.quantities import Parameter, parameters_of

# Two numbers of these names share one option: the model uses the option if it has the number, otherwise the run.
_OF_MODEL_OR_RUN = ("friction_coefficient",)
# --velocity is the initial velocity of the column.
_RENAMED = {("motion", "velocity"): "pulse_velocity"}


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a configuration that has kinds.

    Parameters
    ----------
    table
        Name of the table in a file, such as "column".
    tag
        The key in this table that chooses the kind.
    flag
        The option that chooses the kind, without hyphens.
    noun
        Name of the part in messages.
    place
        Module and name of the registry of classes or constructors; imported on first use.
    """

    table: str
    tag: str
    flag: str
    noun: str
    place: str

    @property
    def kinds(self) -> tuple[str, ...]:
        """All kinds that the package has."""
        return tuple(loaded(self.place))

    def makers(self) -> dict[str, Callable[..., Any]]:
        """Return the class or constructor of each kind that has declared numbers and options for them."""
        others = kinds_in_files()
        return {kind: make for kind, make in loaded(self.place).items() if kind not in others and parameters_of(make)}


_MOTIONS = "stylobate.base_motions.declared"


def _motions_by(function: str) -> tuple[str, ...]:
    kinds: tuple[str, ...] = loaded(f"{_MOTIONS}:{function}")()
    return kinds


kinds_in_files = partial(_motions_by, "composite_kinds")
"""Returns the kinds of base motion that combine others: no options state their numbers."""

PARTS = {
    "column": Part("column", "shape", "shape", "column shape", "stylobate.column:SHAPES"),
    "model": Part("model", "kind", "model", "model", "stylobate.models.declared:MODELS"),
    "motion": Part("motion", "kind", "motion", "base motion", f"{_MOTIONS}:MOTIONS"),
}


def part_group(
    part: Part,
    panel: str,
    *,
    kinds: Callable[[], tuple[str, ...]] | None = None,
    left_out: tuple[str, ...] = (),
    default: str = "",
) -> Group:
    """Make the options of a part: one for the kind, and one for each number.

    Parameters
    ----------
    part
        The part.
    panel
        Heading of the help.
    kinds
        Function that returns the kinds of a command; by default all kinds except `left_out`.
    default
        Text after the kinds in the help.
    """

    def made(chosen: Chosen) -> Iterable[Option]:
        makers, in_files = part.makers(), kinds_in_files()
        if part.table in chosen.classes:
            makers[chosen.kinds[part.table]] = chosen.classes[part.table]
        known = part.kinds if kinds is None else kinds()
        offered = tuple(kind for kind in known if kind not in (*in_files, *left_out))
        others = f"; in a file also {listed(in_files)}" if part.table == "motion" and kinds is None else ""
        text = f"{listed(offered)}{default}{others}"
        yield Option(part.flag, text, str, panel=panel, part=part.table, number=part.tag, kinds=offered)
        shown = {*offered, *chosen.kinds.values()}
        declared = {kind: parameters_of(make) for kind, make in makers.items()}
        for number in dict.fromkeys(name for numbers in declared.values() for name in numbers):
            having = {kind: numbers[number] for kind, numbers in declared.items() if number in numbers}
            if shown & having.keys():
                some = tuple(kind for kind in having if kind in shown)
                only = some if len(some) <= MAX_NAMED_KINDS and len(some) < len(shown & makers.keys()) else ()
                yield _option(part, number, having, chosen.kinds.get(part.table, ""), panel, only)

    return Group(made)


def _option(
    part: Part, number: str, having: Mapping[str, Parameter], chosen: str, panel: str, only: tuple[str, ...]
) -> Option:
    """Make the option of a number of some kinds, from the declaration of the `chosen` kind, if any."""
    parameter = having.get(chosen) or next(iter(having.values()))
    types = {type_of(one) for one in having.values() if one.quantity.components == parameter.quantity.components}
    return Option(
        _RENAMED.get((part.table, number), number),
        text_of(parameter, only),
        types.pop() if len(types) == 1 else float,
        panel=panel,
        part=part.table,
        number=number,
        kinds=tuple(having),
        unit=parameter.quantity.unit,
        words=tuple(parameter.quantity.by_word),
    )


COLUMN = part_group(PARTS["column"], "Column", default="; by default the shape that the other numbers imply")
_WOBBLING = " (wobbling by default), or FILE.py:CLASS"
MODEL = part_group(PARTS["model"], "Model", default=_WOBBLING)
MODEL_OF_STEADY_ROLLING = part_group(PARTS["model"], "Model", default=" (slender by default), or FILE.py:CLASS")
MODEL_WITHOUT_SLIDING = part_group(PARTS["model"], "Model", left_out=("sliding",), default=_WOBBLING)
SLIDING = part_group(PARTS["model"], "Model", kinds=lambda: ("sliding",))
MOTION = part_group(PARTS["motion"], "Base motion", default=" (rest by default), or FILE.py:CLASS")
MOTION_WITHOUT_RECORDS = part_group(
    PARTS["motion"], "Base motion", default=" (rest by default), or FILE.py:CLASS", left_out=("record",)
)
HORIZONTAL_MOTION = part_group(
    PARTS["motion"], "Base motion", kinds=partial(_motions_by, "kinds_by_acceleration")
).without("angular_frequency", "start_phase", "ramp")


def joined(groups: Iterable[Iterable[Option]]) -> list[Option]:
    """Join the options of groups; a number with the name of another option gets its part as a prefix."""
    result: dict[str, Option] = {}
    for option in (one for group in groups for one in group):
        name = option.name
        if name in result and name in _OF_MODEL_OR_RUN:
            result[name] = replace(result[name], part=option.part, number=option.number, kinds=option.kinds)
        elif name in result:
            result[f"{option.part}_{name}"] = replace(option, name=f"{option.part}_{name}")
        else:
            result[name] = option
    return list(result.values())
