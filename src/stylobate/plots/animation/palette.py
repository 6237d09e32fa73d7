"""Colours of the things in a picture: one colour, one meaning, those of the page and its viewer on a light ground."""

from stylobate.plots.animation.canvas import Colour, rgb
from stylobate.plots.style import BLUE, VERMILION

BACKGROUND, GROUND_LINE = rgb("#f5f7fa"), rgb("#c3ccd8")
SLAB, SLAB_SIDE, SLAB_LINE = rgb("#e3e8ef"), rgb("#aeb8c6"), rgb("#aab6c6")
STONE, FOOTPRINT, INK = rgb("#f1ebde"), rgb("#5d6b7d"), rgb("#3c4856")
MARK = rgb(VERMILION)
"""The marked flute and the radius to it: what turns with the body."""

CONTACT, CONTACT_OLD = rgb(BLUE), rgb("#9cc3de")
"""What touches: the path of the contact point, lately and long ago, and the footprint of a column that stands."""

PALE = FOOTPRINT
"""Text beside that in ink, and lines that are to be found rather than seen."""

CONTACT_POINT = rgb("#0b1622")
"""The point that touches now."""

SHADOW, SHADOW_STRENGTH = rgb("#1d2733"), 0.3


def mixed(first: Colour, second: Colour, part: float) -> Colour:
    """Return a colour between two: this part of the second."""
    return tuple(round((1.0 - part) * one + part * other) for one, other in zip(first, second, strict=True))


SLAB_LIT = mixed(SLAB_SIDE, SLAB, 0.4)
"""A side of the slab that the light reaches."""

SHADE = (*SHADOW, round(255 * SHADOW_STRENGTH))
GROUND_SHADE = mixed(BACKGROUND, SHADOW, SHADOW_STRENGTH)
"""Shadows on the slab, through which its lines are seen, and on the ground, where they overlap."""
