"""Looks of the classes in maps: one colour and texture per outcome and attractor, the same in every figure.

The hues are from Okabe and Ito's palette for colour-blind readers. The lightness of the usual classes differs by a
tenth of its range or more; textures tell the others apart in print without colour.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import xarray as xr

from stylobate.errors import Outcome
from stylobate.results.outcomes import NOT_COMPUTED


@dataclass(frozen=True, slots=True)
class Look:
    """A fill `colour`, and a `texture` (a hatch of Matplotlib) drawn on it in the colour `ink`."""

    colour: str
    texture: str = ""
    ink: str = "#ffffff"


# Lightness L* in steps of ten, from standing to falling: 95, 85, 74, 63, 51, 41, then 5.
_CREAM, _LILAC, _SKY, _AMBER, _SEA, _BLUE, _NIGHT = (
    "#F6F1DA", "#DAD2E8", "#74C0EA", "#D58900", "#008B65", "#0063A0", "#1B0B16",
)  # fmt: skip
_MAUVE, _ROSE, _MINT = "#A4558C", "#DDA6CD", "#7CCDB4"
_GREY, _SAND = "#767676", "#E5BE8F"
_DARK_INK, _LILAC_INK = "#333333", "#8E7DA3"

_AT_REST, _ROCKING = Look(_CREAM, ink=_DARK_INK), Look(_SKY, ink=_DARK_INK)
_SLIDING = Look(_SAND, "--", _DARK_INK)
_ROLLING, _ROLLING_BACK = Look(_AMBER, ink=_DARK_INK), Look(_BLUE, "\\\\\\")
_MODULATED, _MODULATED_BACK = Look(_SEA, "..."), Look(_MINT, "ooo", _DARK_INK)
_APERIODIC, _MIXED = Look(_MAUVE, "---"), Look(_MAUVE, "+++")
_UNSETTLED, _OVERTURNED = Look(_LILAC, "xx", _LILAC_INK), Look(_NIGHT)
UNFINISHED = Look("#ffffff", "//////", "#b0b0b0")
"""Runs that are not computed: white, finely hatched."""

# From standing to falling.
OUTCOME_LOOKS = {
    Outcome.AT_REST: _AT_REST,
    Outcome.ROCKING: _ROCKING,
    Outcome.ROLLING: _ROLLING,
    Outcome.PERIODIC: replace(_ROCKING, texture="///"),
    Outcome.MODULATED: _MODULATED,
    Outcome.APERIODIC: _MIXED,
    Outcome.SURVIVED: Look(_CREAM, "...", _LILAC_INK),
    Outcome.STILL_MOVING: _UNSETTLED,
    Outcome.OVERTURNED: _OVERTURNED,
    Outcome.LIMIT_REACHED: replace(_OVERTURNED, texture="///"),
    Outcome.LIFTED_OFF: Look(_GREY, "**"),
    Outcome.SLID: _SLIDING,
    Outcome.STOPPED: Look("#ffffff", "oo", _GREY),
    Outcome.FAILED: Look("#ffffff", "xxx", "#D55E00"),
}

KIND_LOOKS = {
    "at rest": _AT_REST,
    "rocking": _ROCKING,
    "rolling anticlockwise": _ROLLING,
    "rolling clockwise": _ROLLING_BACK,
    "modulated anticlockwise": _MODULATED,
    "modulated clockwise": _MODULATED_BACK,
    "aperiodic anticlockwise": _APERIODIC,
    "aperiodic clockwise": Look(_ROSE, "|||", _DARK_INK),
    "aperiodic": _MIXED,
    "overturned": _OVERTURNED,
    "tilt limit reached": OUTCOME_LOOKS[Outcome.LIMIT_REACHED],
    "lifted off": OUTCOME_LOOKS[Outcome.LIFTED_OFF],
    "survived": OUTCOME_LOOKS[Outcome.SURVIVED],
    "not settled": _UNSETTLED,
}
# Textures of the second, third … attractor of a kind; after the last texture the first one follows.
_MORE_TEXTURES = ("///", "...", "|||", "---", "ooo", "+++")


@dataclass(frozen=True, slots=True)
class MapClass:
    """A class of a map: its `code` in the array, its `name` and its `look`."""

    code: int
    name: str
    look: Look


UNFINISHED_CLASS = MapClass(NOT_COMPUTED, "not computed", UNFINISHED)


def classes_of(names: Iterable[object], looks: Iterable[Look]) -> tuple[MapClass, ...]:
    """Return classes of these names and looks, whose codes are their indices."""
    return tuple(MapClass(code, str(name), look) for code, (name, look) in enumerate(zip(names, looks, strict=True)))


def outcome_classes() -> tuple[MapClass, ...]:
    """Return the classes of outcomes, from standing to falling, and last the class of runs not computed."""
    return (*(MapClass(int(one), one.label, look) for one, look in OUTCOME_LOOKS.items()), UNFINISHED_CLASS)


def contact_classes(found: xr.Dataset) -> tuple[MapClass, ...]:
    """Return the classes of a contact map, from standing to falling, and last the class of runs not computed."""
    looks = (_AT_REST, _SLIDING, _ROCKING, _ROLLING_BACK, Look(_GREY, "**"), _MIXED, _OVERTURNED)
    return (*classes_of(found["class_name"].to_numpy(), (*looks, OUTCOME_LOOKS[Outcome.FAILED])), UNFINISHED_CLASS)


def attractor_classes(found: xr.Dataset) -> tuple[MapClass, ...]:
    """Return the classes of attractors in a table over `attractor_index`, of runs not settled and not computed."""
    kinds = [str(kind) for kind in found["attractor_kind"].to_numpy()]
    return (*classes_of(found["attractor_name"].to_numpy(), _looks(kinds)), UNFINISHED_CLASS)


def _looks(kinds: Sequence[str]) -> list[Look]:
    looks = []
    for place, kind in enumerate(kinds):
        look, alike = KIND_LOOKS[kind], kinds[:place].count(kind)
        if alike:
            others = [texture for texture in _MORE_TEXTURES if texture != look.texture]
            look = replace(look, texture=others[(alike - 1) % len(others)])
        looks.append(look)
    return looks
