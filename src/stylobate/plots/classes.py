"""Looks of the classes in maps: one colour and texture per outcome and attractor, the same in every figure.

The hues are from Okabe and Ito's palette for colour-blind readers. The lightness of the usual classes differs by a
tenth of its range or more; textures tell the others apart in print without colour.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from matplotlib.colors import to_hex, to_rgb

from stylobate.errors import Outcome
from stylobate.results.outcomes import NOT_COMPUTED


@dataclass(frozen=True, slots=True)
class Look:
    """A fill `colour`, and a `texture` (a hatch of Matplotlib) drawn on it in the colour `ink`, by default faint."""

    colour: str
    texture: str = ""
    ink: str = ""

    def __post_init__(self) -> None:
        if not self.ink:
            red, green, blue = to_rgb(self.colour)
            towards = 0.0 if 0.3 * red + 0.6 * green + 0.1 * blue > _DARK else 1.0
            mixed = ((1.0 - _FAINT) * np.array([red, green, blue]) + _FAINT * towards).tolist()
            object.__setattr__(self, "ink", to_hex(mixed))


# Contrast of a texture to its fill, and the brightness below which it is lighter than the fill.
_FAINT, _DARK = 0.2, 0.25
# Lightness L* in steps of ten, from standing to falling: 95, 84, 74, 63, 51, 41, then 5.
_CREAM, _LEAF, _SKY, _AMBER, _SEA, _BLUE, _NIGHT = (
    "#F6F1DA", "#B5D9BE", "#74C0EA", "#D58900", "#008B65", "#0063A0", "#1B0B16",
)  # fmt: skip
_MAUVE, _ROSE, _MINT, _PURPLE = "#A4558C", "#DDA6CD", "#7CCDB4", "#6E4A9E"
_GREY, _SAND, _LILAC, _STEEL = "#767676", "#E5BE8F", "#DAD2E8", "#4F9BD0"

_AT_REST, _ROCKING, _OVERTURNED = Look(_CREAM), Look(_SKY), Look(_NIGHT)
_ROLLING, _MODULATED, _APERIODIC = Look(_AMBER), Look(_SEA), Look(_MAUVE, "\\\\")
_UNSETTLED, _SLIDING, _FLYING = Look(_LILAC, "--"), Look(_SAND, "||"), Look(_GREY, "||")
UNFINISHED = Look("#ffffff", "//////", "#b0b0b0")
"""Runs that are not computed: white, finely hatched."""

# From standing to falling.
OUTCOME_LOOKS = {
    Outcome.AT_REST: _AT_REST,
    Outcome.ROCKING: _ROCKING,
    Outcome.ROLLING: _ROLLING,
    Outcome.PERIODIC: Look(_STEEL, "//"),
    Outcome.MODULATED: _MODULATED,
    Outcome.APERIODIC: _APERIODIC,
    Outcome.SURVIVED: Look(_LEAF),
    Outcome.STILL_MOVING: _UNSETTLED,
    Outcome.OVERTURNED: _OVERTURNED,
    Outcome.LIMIT_REACHED: replace(_OVERTURNED, texture="//"),
    Outcome.LIFTED_OFF: _FLYING,
    Outcome.SLID: _SLIDING,
    Outcome.STOPPED: Look("#ffffff", ".."),
    Outcome.FAILED: Look("#ffffff", "xx", "#D55E00"),
}

KIND_LOOKS = {
    "at rest": _AT_REST,
    "rocking": _ROCKING,
    "rolling anticlockwise": _ROLLING,
    "rolling clockwise": Look(_BLUE),
    "modulated anticlockwise": _MODULATED,
    "modulated clockwise": Look(_MINT, "\\\\"),
    "aperiodic anticlockwise": _APERIODIC,
    "aperiodic clockwise": Look(_ROSE, "||"),
    "aperiodic": Look(_PURPLE, "--"),
    "overturned": _OVERTURNED,
    "tilt limit reached": OUTCOME_LOOKS[Outcome.LIMIT_REACHED],
    "lifted off": OUTCOME_LOOKS[Outcome.LIFTED_OFF],
    "survived": OUTCOME_LOOKS[Outcome.SURVIVED],
    "not settled": _UNSETTLED,
}
# Textures of the second, third … attractor of a kind; after the last texture the first one follows.
_MORE_TEXTURES = ("//", "..", "||", "--", "\\\\", "++")


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
    looks = (_AT_REST, _SLIDING, _ROCKING, Look(_BLUE), Look(_LILAC), _FLYING, _OVERTURNED)
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
