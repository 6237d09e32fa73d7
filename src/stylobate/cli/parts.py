"""Columns, models and base motions: their kinds, and the options made from the declarations of these."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from stylobate.cli.declarations import MAX_NAMED_KINDS, Group, Option, listed, text_of, type_of
from stylobate.cli.own_classes import Chosen
from stylobate.quantities import Parameter, parameters_of

KINDS_IN_FILES = ("sum", "one_of", "scaled", "rotated", "delayed")
"""Kinds of base motion that consist of others: no options state their numbers."""

# Two numbers of these names have one option: the model takes it if it has the number, the run otherwise.
_OF_MODEL_OR_RUN = ("friction_coefficient",)
# --velocity is that of the column at the start.
_RENAMED = {("motion", "velocity"): "pulse_velocity"}


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a configuration that has kinds.

    Parameters
    ----------
    table
        Its name in a file, such as "column".
    tag
        The key in this table that chooses the kind.
    flag
        The option that chooses it, without hyphens.
    noun
        As in messages.
    makers
        Gives the class or constructor of each kind that has declared numbers.
    others
        The kinds without.
    """

    table: str
    tag: str
    flag: str
    noun: str
    makers: Callable[[], Mapping[str, Callable[..., Any]]]
    others: tuple[str, ...] = ()

    @property
    def kinds(self) -> tuple[str, ...]:
        """All kinds that the package has."""
        return (*self.makers(), *self.others)


def _shapes() -> Mapping[str, Callable[..., Any]]:
    from stylobate.column import SHAPES  # noqa: PLC0415  heavy imports wait until they are needed

    return SHAPES


def _models() -> Mapping[str, Callable[..., Any]]:
    from stylobate.models.declared import MODELS  # noqa: PLC0415

    return MODELS


def _motions() -> Mapping[str, Callable[..., Any]]:
    from stylobate.base_motions.declared import MOTIONS  # noqa: PLC0415

    return {kind: MOTIONS[kind] for kind in MOTIONS if kind not in ("rest", "record", *KINDS_IN_FILES)}


PARTS = {
    "column": Part("column", "shape", "shape", "column shape", _shapes),
    "model": Part("model", "kind", "model", "model", _models),
    "motion": Part("motion", "kind", "motion", "base motion", _motions, ("rest", "record", *KINDS_IN_FILES)),
}


def part_group(
    part: Part, panel: str, *, kinds: tuple[str, ...] = (), left_out: tuple[str, ...] = (), default: str = ""
) -> Group:
    """Make the options of a part: one that chooses the kind, and those of the numbers.

    Parameters
    ----------
    part
        The part.
    panel
        Heading of the help.
    kinds
        The kinds that a command offers; all by default, but for those in `left_out`.
    default
        What help shows behind the kinds.
    """

    def made(chosen: Chosen) -> Iterable[Option]:
        makers = dict(part.makers())
        if part.table in chosen.classes:
            makers[chosen.kinds[part.table]] = chosen.classes[part.table]
        offered = tuple(kind for kind in kinds or part.kinds if kind not in (*KINDS_IN_FILES, *left_out))
        in_files = f"; in a file also {listed(KINDS_IN_FILES)}" if part.table == "motion" and not kinds else ""
        text = f"{listed(offered)}{default}{in_files}"
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
    """Make the option of a number that some kinds have; it follows the declaration of the `chosen` kind, if any."""
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
    )


COLUMN = part_group(PARTS["column"], "Column", default="; by default the shape that the other numbers imply")
MODEL = part_group(PARTS["model"], "Model", default=" (slender by default), or FILE.py:CLASS")
MODEL_WITHOUT_SLIDING = part_group(
    PARTS["model"], "Model", left_out=("sliding",), default=" (slender by default), or FILE.py:CLASS"
)
SLIDING = part_group(PARTS["model"], "Model", kinds=("sliding",))
MOTION = part_group(PARTS["motion"], "Base motion", default=" (rest by default), or FILE.py:CLASS")
MOTION_WITHOUT_RECORDS = part_group(
    PARTS["motion"], "Base motion", default=" (rest by default), or FILE.py:CLASS", left_out=("record",)
)
HORIZONTAL_MOTION = part_group(
    PARTS["motion"], "Base motion", kinds=("circular", "straight", "elliptic"), default=""
).without("angular_frequency", "start_phase", "ramp")


def joined(groups: Iterable[Iterable[Option]]) -> list[Option]:
    """Join the options of groups; the name of a number that another option has gets its part before it."""
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
