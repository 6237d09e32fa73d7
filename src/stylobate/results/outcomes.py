"""Outcomes and contact classes of runs as codes with names."""

from collections.abc import Iterable
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from stylobate.errors import Named, Outcome
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

NUMERICALLY_UNCERTAIN = "numerically uncertain: rounding or the rest threshold could alter it"
"""What `uncertain` means, in the same words everywhere."""

NOT_COMPUTED = -1
"""The code of a run that has not been computed."""


def outcome_label(code: int) -> str:
    """Return the label of the outcome with this `code`, or of a run that has not been computed."""
    return "not computed" if code == NOT_COMPUTED else Outcome(code).label


def outcome_attributes() -> dict[str, Any]:
    """Return the attributes of a variable that holds outcomes."""
    flags = flag_attributes("outcome", ["NOT_COMPUTED", *(outcome.name for outcome in Outcome)], first=NOT_COMPUTED)
    return flags | {"comment": "compare with a member, outcome == stylobate.Outcome.OVERTURNED, never with a text"}


def flag_attributes(
    long_name: str, meanings: Iterable[str], *, first: int = 0, dtype: npt.DTypeLike = np.int8
) -> dict[str, Any]:
    """Return the attributes of a variable that holds the codes `first`, `first` + 1, …, after the CF conventions.

    Parameters
    ----------
    long_name
        Quantity that the codes represent.
    meanings
        Meaning of each code, one word without spaces.
    first
        The first code.
    dtype
        Type of the codes among the attributes.
    """
    words = list(meanings)
    values = np.arange(first, first + len(words), dtype=dtype)
    return {"long_name": long_name, "flag_values": values, "flag_meanings": " ".join(words)}


class ContactClass(Named, IntEnum):
    """Class of a run by the kinds of contact that occurred in it."""

    STAYS = 0
    """The column stood throughout, and its base did not move on the plane."""
    SLIDES = 1
    """The base slid; the column never tipped."""
    ROCKS = 2
    """The column rocked or rolled on its rim without slip."""
    SLIDES_AND_ROCKS = 3
    """The column rocked or rolled, and slipped on its rim or slid on its base."""
    HOPS_UPRIGHT = 4
    """The column left the plane and landed on its base; it never tilted beyond 1e-4 rad."""
    HOPS_AND_ROCKS = 5
    """The column left the plane, and tilted."""
    OVERTURNS = 6
    FAILED = 7


CONTACT_CLASSES = (
    *("stays", "slides", "rocks or rolls", "slides and rocks", "hops upright", "hops and rocks", "overturns", "failed"),
)
"""Names of the classes, in the order of their codes."""

# Maximum tilt of an upright column [rad].
_UPRIGHT = 1e-4


def contact_classes(runs: "xr.Dataset", least_share: float = 1e-3) -> "xr.DataArray":
    """Classify each run by its `ContactClass`; −1 marks runs that are not computed."""
    least = least_share * runs["end_time"]

    def took(*kinds: str) -> "xr.DataArray":
        return sum((runs[f"time_{kind}"] for kind in kinds[1:]), runs[f"time_{kinds[0]}"]) > least

    rocks, slides, outcome = took("rolling", "slipping"), took("sliding", "slipping"), runs["outcome"]
    known: list[tuple[Any, ContactClass]] = [
        (outcome == Outcome.FAILED, ContactClass.FAILED),
        (outcome == Outcome.OVERTURNED, ContactClass.OVERTURNS),
        (took("flying") & (rocks | (runs["peak_tilt"] > _UPRIGHT)), ContactClass.HOPS_AND_ROCKS),
        (took("flying"), ContactClass.HOPS_UPRIGHT),
        (rocks & slides, ContactClass.SLIDES_AND_ROCKS),
        (rocks, ContactClass.ROCKS),
        (slides, ContactClass.SLIDES),
    ]
    import xarray as xr

    classes = xr.full_like(outcome, int(ContactClass.STAYS), dtype=np.int8)
    for where, kind in reversed(known):
        classes = classes.where(~where, int(kind))
    classes = classes.where(outcome != NOT_COMPUTED, NOT_COMPUTED).astype(np.int8)
    meanings = ["NOT_COMPUTED", *(kind.name for kind in ContactClass)]
    return classes.assign_attrs(flag_attributes("contact of the column", meanings, first=NOT_COMPUTED))


def lands_flat(runs: "xr.Dataset") -> "xr.DataArray":
    """Return which runs hop and land at a tilt of exactly 0 over the last periods, or throughout if these are short.

    Such a landing is exact in a computation only: it strikes the whole base at once, and no friction tips the column.
    """
    tilt = runs["mean_tilt"].fillna(runs["peak_tilt"])
    hops = (runs["time_flying"] > 0.0) & (runs["outcome"] != Outcome.OVERTURNED)
    return (hops & (tilt == 0.0)).assign_attrs(long_name="hops and lands at a tilt of exactly 0")


def stays_in_a_plane(runs: "xr.Dataset") -> "xr.DataArray":
    """Return which runs tilt and move in exactly one vertical plane, as from a tilt in the plane of vibration.

    Such a motion is exact in a computation only: a part a millionth of a radian beside the plane can move otherwise.
    """
    tilts = runs["peak_tilt"] > 0.0
    return (runs["planar"].astype(bool) & tilts).assign_attrs(long_name="tilts and moves in exactly one vertical plane")


def knife_edge_remarks(runs: "xr.Dataset") -> list[str]:
    """Return a remark with the number of runs that land exactly flat, and one with those that stay in one plane."""
    flat, planar = int(lands_flat(runs).sum()), int(stays_in_a_plane(runs).sum())
    return [
        *(
            [f"{plural(flat, 'run')} landed at a tilt of exactly 0: pass a tilt, and count with `upright`"]
            if flat
            else []
        ),
        *([f"{plural(planar, 'run')} stayed in exactly one vertical plane: pass a tilt out of it"] if planar else []),
    ]


def stability_of(orbits: "xr.Dataset") -> str:
    """Return the meaning of "stable": neutrally stable without damping, in the plane for planar orbits."""
    neutral = "" if orbits.attrs.get("friction", 1) else "neutrally "
    return f"{neutral}stable{' in the plane' if orbits.attrs.get('planar', 0) else ''}"


LOSSES = {1: "supercritical", 0: "subcritical", -1: ""}
"""Kind of a loss of stability, by its code in `supercritical`; empty if undecided."""
