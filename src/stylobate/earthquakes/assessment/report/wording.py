"""Words, numbers and displacements of an assessment report: verdicts without promises, three significant digits."""

import math
from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np
import xarray as xr

from stylobate.column import STANDARD_GRAVITY
from stylobate.earthquakes.figures.overturning_intervals import undecided_reasons
from stylobate.results.verdict import percent

CENTRAL = "central"
OVERTURNED, STOOD, UNDECIDED = "overturned", "did not overturn", "not decided"
_MOST_NAMES = 8
# A relative difference of the size of rounding does not raise the last digit of an upper bound.
_ROUNDING = 1e-12
_OF_STATE = {1: OVERTURNED, 0: STOOD, -1: UNDECIDED}


def verdict(state: float) -> str:
    """Return the words for the state of a run: 1 overturned, 0 did not overturn, −1 undecided."""
    return _OF_STATE[int(state)]


def number(value: float, digits: int = 3) -> str:
    """Format a number with `digits` significant digits; a dash for NaN."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞"
    return f"{value:.{digits}g}"


def at_most(value: float, digits: int = 4) -> str:
    """Format an upper bound with `digits` significant digits, rounded up; a dash for NaN.

    >>> at_most(0.77251), at_most(0.7725)
    ('0.7726', '0.7725')
    """
    if not math.isfinite(value) or value <= 0.0:
        return number(value, digits)
    step = 10.0 ** (math.floor(math.log10(value)) + 1 - digits)
    return number(math.ceil(value / step * (1.0 - _ROUNDING)) * step, digits)


def tilt(value: float) -> str:
    """Format a peak tilt over α_c; infinity means overturned."""
    return OVERTURNED if math.isinf(value) else number(value)


def least_scale(margins: xr.Dataset) -> str:
    """State the smallest overturning scale of one column, case and record, and the next smaller run that survived."""
    if int(margins["intervals"]) == 0:
        if undecided := _undecided_scales(margins):
            return f"none found; {undecided}"
        return f"none up to {number(float(margins['margin_scale'][-1]))}"
    found, below = float(margins["least_overturning"]), float(margins["largest_below"])
    if not math.isnan(below):
        return f"at most {at_most(found)} (not at {number(below, 4)})"
    if bool(margins["undecided_below"][0]):
        return f"at most {at_most(found)} (not decided just below)"
    return f"at most {at_most(found)}"


def intervals(margins: xr.Dataset) -> str:
    """List the overturning intervals of one column, case and record, and the undecided scales."""
    names = ("interval_from", "interval_to", "open_below", "open_above", "undecided_below", "undecided_above")
    found = []
    for low, high, below, above, unknown_below, unknown_above in zip(
        *(margins[name].to_numpy() for name in names), strict=True
    ):
        if math.isnan(low):
            continue
        ends = [number(low, 4), number(high, 4)]
        words = ends[0] if ends[0] == ends[1] else " to ".join(ends)
        words += " and below" * bool(below and not unknown_below) + " and beyond" * bool(above and not unknown_above)
        found.append(words)
    undecided = _undecided_scales(margins)
    return "; ".join([*(found or ["none found" if undecided else "none"]), *([undecided] if undecided else [])])


def _undecided_scales(margins: xr.Dataset) -> str:
    """List the undecided scales of one column, case and record, with the reasons; empty if there are none."""
    pairs = zip(margins["undecided_from"].to_numpy(), margins["undecided_to"].to_numpy(), strict=True)
    stretches = [f"{number(low, 4)} to {number(high, 4)}" for low, high in pairs if not math.isnan(low)]
    if not stretches:
        return ""
    return f"not decided from {' and from '.join(stretches)} ({', '.join(undecided_reasons(margins['outcome']))})"


def listed(names: Sequence[str], last: str = "") -> str:
    """Join at most eight names with commas; the word `last` stands before the last name.

    >>> listed(("low", "high"), "and")
    'low and high'
    """
    shown = [*names[:_MOST_NAMES], *([f"{len(names) - _MOST_NAMES} more"] if len(names) > _MOST_NAMES else [])]
    if last and len(shown) > 1:
        return f"{', '.join(shown[:-1])} {last} {shown[-1]}"
    return ", ".join(shown)


def in_g(acceleration: float) -> str:
    """Format an acceleration [m/s²] in g."""
    return number(acceleration / STANDARD_GRAVITY)


def scales(values: np.ndarray) -> str:
    """Format scale factors."""
    return ", ".join(f"{value:g}" for value in values)


def degrees(angle: float) -> str:
    """Format an azimuth [rad] in degrees from x."""
    return "–" if math.isnan(angle) else f"{math.degrees(angle) % 360.0:.0f}°"


def near_share(share: float) -> str:
    """State the share of the scales within 10 % that overturned a column; 0 if only scales between them did."""
    return f"{percent(share)} of 41" if share > 0.0 else "an interval between them"


def records(count: int, total: int) -> str:
    """State a number of records in words."""
    if total == 1:
        return "the one record" if count == 1 else "not the one record"
    if count == total:
        return f"all {total} records"
    return f"{count} of {total} records"


_MM = 1000.0
SMALLEST_TILT = 1e-3
"""Smallest tilt over α_c that is worth a figure."""
# Smallest tilt over α_c, tilt [°] and displacement [mm] that are shown as numbers; smaller ones are shown as "< …".
_LEAST = (SMALLEST_TILT, 0.01, 0.1)
TILT_HEADER = ("tilt / α_c", "tilt [°]", "displacement [mm]")


def displacement(angle: float, *, radius: float, height: float) -> float:
    """Compute the horizontal displacement of a point of the axis, relative to the base [m].

    The column stands on its rim and the contact point does not move. A point at the height H of the axis then moves
    by H sin θ + r (1 − cos θ), for any direction of the tilt θ.

    Parameters
    ----------
    angle
        Tilt θ [rad].
    radius, height
        Base radius r, height H of the point above the base [m].
    """
    return height * math.sin(angle) + radius * (1.0 - math.cos(angle))


def shown_point(column: xr.Dataset) -> tuple[float, str]:
    """Return height [m] and name of the displaced point: the top, or the centre of mass if the height is unknown."""
    height = float(column["height"])
    return (float(column["mass_height"]), "centre of mass") if math.isnan(height) else (height, "top")


def tilt_cells(ratio: float, column: xr.Dataset) -> tuple[str, str, str]:
    """Format a peak tilt as a fraction of α_c, in degrees, and as the displacement of the shown point in mm."""
    if not math.isfinite(ratio):
        return tilt(ratio), "–", "–"
    angle = ratio * float(column["tipping_angle"])
    moved = displacement(angle, radius=float(column["radius"]), height=shown_point(column)[0])
    fraction, degrees, millimetres = map(_at_least, (ratio, math.degrees(angle), _MM * moved), _LEAST)
    return fraction, degrees, millimetres


def _at_least(value: float, least: float) -> str:
    return f"< {least:g}" if 0.0 < value < least else number(value)


def tilt_words(ratio: float, column: xr.Dataset) -> str:
    """Describe a peak tilt in words."""
    fraction, angle, moved = tilt_cells(ratio, column)
    return f"{angle}° ({fraction} α_c), which displaces its {shown_point(column)[1]} by {moved} mm"


def cells(data: xr.Dataset, *dims: str) -> Iterator[tuple[tuple[str, ...], xr.Dataset]]:
    """Yield the labels of each cell over `dims` as text, and its data; the last dimension varies fastest."""
    for values in product(*(data[dim].to_numpy() for dim in dims)):
        labels = tuple(f"{value:g}" if dim == "scale" else str(value) for dim, value in zip(dims, values, strict=True))
        yield labels, data.sel(dict(zip(dims, values, strict=True)))
