"""How an assessment says things: verdicts without promises, numbers with three digits."""

import math

import numpy as np
import xarray as xr

CENTRAL = "central"
OVERTURNED, STOOD, UNDECIDED = "overturned", "did not overturn", "not decided"
_OF_STATE = {1: OVERTURNED, 0: STOOD, -1: UNDECIDED}


def verdict(state: float) -> str:
    """Return the words for a run: 1 overturned, 0 did not, −1 does not tell."""
    return _OF_STATE[int(state)]


def number(value: float, digits: int = 3) -> str:
    """Return a number with so many significant digits; a dash where there is none."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞"
    return f"{value:.{digits}g}"


def tilt(value: float) -> str:
    """Return a largest tilt over α in words."""
    return OVERTURNED if math.isinf(value) else number(value)


def least_scale(margins: xr.Dataset) -> str:
    """Return the least scale that overturned, of one column, case and record, with the next below that did not."""
    if int(margins["bands"]) == 0:
        return f"none up to {number(float(margins['margin_scale'][-1]))}"
    found, below = float(margins["least_overturning"]), float(margins["largest_below"])
    if math.isnan(below):
        return f"{number(found)} or below"
    return f"{number(found, 4)} (not at {number(below, 4)})"


def bands(margins: xr.Dataset) -> str:
    """Return all bands of scales that overturned, of one column, case and record."""
    told = []
    for low, high, below, above in zip(
        *(margins[name].to_numpy() for name in ("band_from", "band_to", "open_below", "open_above")), strict=True
    ):
        if math.isnan(low):
            continue
        first = f"{number(low, 4)} or below" if below else number(low, 4)
        last = f"{number(high, 4)} and beyond" if above else number(high, 4)
        told.append(f"{first} to {last}" if first != last else first)
    return "; ".join(told) or "none"


def scales(values: np.ndarray) -> str:
    """Return scale factors in words."""
    return ", ".join(f"{value:g}" for value in values)


def degrees(angle: float) -> str:
    """Return an azimuth in degrees from x."""
    return "–" if math.isnan(angle) else f"{math.degrees(angle) % 360.0:.0f}°"


def records(count: int, total: int) -> str:
    """Return how many of the records, in words."""
    if total == 1:
        return "the one record" if count == 1 else "not the one record"
    return f"{count} of {total} records"
