"""Displacement of the top of a tilted column, in the words and units of a report."""

import math

import xarray as xr

from stylobate.earthquakes.assessment.report.wording import number, tilt

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
