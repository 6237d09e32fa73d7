"""Colours of animations: one colour, one meaning, the same as in the page and its viewer on a light background."""

from matplotlib.colors import to_rgb

from stylobate.plots.style import BLUE, VERMILION

BACKGROUND, GROUND_LINE = "#f5f7fa", "#c3ccd8"
SLAB, SLAB_SIDE, SLAB_LINE = "#e3e8ef", "#aeb8c6", "#aab6c6"
STONE, FOOTPRINT, INK = "#f1ebde", "#5d6b7d", "#3c4856"
MARK = VERMILION
"""The marked flute and the radius to it, which turn with the body."""

CONTACT, CONTACT_OLD = BLUE, "#9cc3de"
"""The path of the contact point, recent and old, and the footprint of a column that stands."""

PALE = FOOTPRINT
"""Secondary text."""

CONTACT_POINT = "#0b1622"
"""The present contact point."""

SHADOW, SHADOW_STRENGTH = "#1d2733", 0.3


def mixed(first: str, second: str, fraction: float) -> tuple[float, ...]:
    """Mix two colours with this fraction of the second; return red, green and blue."""
    pairs = zip(to_rgb(first), to_rgb(second), strict=True)
    return tuple((1.0 - fraction) * one + fraction * other for one, other in pairs)


SLAB_LIT = mixed(SLAB_SIDE, SLAB, 0.4)
"""A side of the slab that the light reaches."""
