"""Rotation of components with known directions to the axes x, y and z of a record."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from stylobate.base_motions.records.component import Direction
from stylobate.base_motions.records.record import Floats
from stylobate.errors import FileError

# Tolerance of a right angle between azimuths that are rounded in file names [degrees].
_RIGHT_ANGLE_TOLERANCE = 2.0
# Minimum sine of the angle between horizontal components that determine the motion.
_LEAST_SINE = 0.5


class Directed(NamedTuple):
    """Accelerations of shape (n,) that are positive in this direction, with their file or column."""

    label: str
    direction: Direction
    samples: Floats


def is_one_set(directions: Sequence[Direction]) -> bool:
    """Return whether one event can have these directions: at most one vertical and two perpendicular horizontal ones.

    >>> is_one_set([Direction(azimuth=0.0), Direction(azimuth=90.0)]), is_one_set([Direction(axis="x")] * 2)
    (True, False)
    """
    flat = [one for one in directions if not one.vertical]
    return len(directions) - len(flat) <= 1 and len(flat) <= 2 and (len(flat) < 2 or _sine(*flat) != 0.0)  # noqa: PLR2004


def are_perpendicular(first: Direction, second: Direction) -> bool:
    """Return whether two azimuths differ by a right angle, within 2°.

    >>> a, b, c = (Direction(azimuth=azimuth) for azimuth in (55.0, 325.0, 100.0))
    >>> are_perpendicular(a, b), are_perpendicular(a, c)
    (True, False)
    """
    if first.azimuth is None or second.azimuth is None:
        return False
    return abs((second.azimuth - first.azimuth) % 180.0 - 90.0) <= _RIGHT_ANGLE_TOLERANCE


def along_axes(event: str, components: Sequence[Directed]) -> tuple[dict[str, Floats], str]:
    """Rotate components to x, y and z; return the accelerations by axis, and their origin as a line of text.

    Raises
    ------
    FileError
        If there are more than two horizontal components or one vertical, or two are not independent.

    Notes
    -----
    x points along the lower azimuth θ1 of two, y 90° anticlockwise from x, z up, see `read_records`. Two perpendicular
    components of unknown azimuth are x and y, in the order of their axes.
    """
    up = [one for one in components if one.direction.vertical]
    flat = sorted((one for one in components if not one.direction.vertical), key=_order)
    if len(up) > 1 or len(flat) > 2:  # noqa: PLR2004
        message = (
            f"{event}: two horizontal components and a vertical one at most, got {_listed(components)}. If they are of "
            "several events, list the files of each event together"
        )
        raise FileError(message)
    axes, lines = _horizontal(event, flat)
    if up:
        axes["z"] = up[0].direction.vertical * up[0].samples
        lines.append(f"z up, from {up[0].label} ({up[0].direction})")
    return axes, "; ".join(lines)


def _order(one: Directed) -> float:
    return one.direction.azimuth if one.direction.azimuth is not None else float(one.direction.axis == "y")


def _listed(components: Sequence[Directed]) -> str:
    return ", ".join(f"{one.label} ({one.direction})" for one in components)


def _sine(first: Direction, second: Direction) -> float:
    """Return the sine of the angle between two horizontal directions; 0 if they are not independent."""
    if first.azimuth is None or second.azimuth is None:
        return float(None not in (first.axis, second.axis) and first.axis != second.axis)
    sine = math.sin(math.radians(second.azimuth - first.azimuth))
    return sine if abs(sine) >= _LEAST_SINE else 0.0


def _horizontal(event: str, flat: list[Directed]) -> tuple[dict[str, Floats], list[str]]:
    if not flat:
        return {}, []
    first = flat[0]
    if len(flat) == 1:
        where = f"at {first.direction}" if first.direction.axis is None else f"along the {first.direction}"
        return {"x": first.samples}, [f"x {where}, from {first.label}"]
    second = flat[1]
    if _sine(first.direction, second.direction) == 0.0:
        message = (
            f"{event}: horizontal components must be perpendicular, or nearly so, got {_listed(flat)}. State "
            "directions, or list the files of each event together"
        )
        raise FileError(message)
    if first.direction.azimuth is None or second.direction.azimuth is None:
        lines = [
            f"{axis} from {one.label} ({one.direction}, azimuth unknown)" for axis, one in zip("xy", flat, strict=True)
        ]
        return {"x": first.samples, "y": second.samples}, lines
    turn = math.radians(second.direction.azimuth - first.direction.azimuth)
    # exact right angles: the rounding error of cos 90° must not mix the components
    across = abs(math.cos(turn)) < 1e-12  # noqa: PLR2004
    cos, sin = (0.0, math.copysign(1.0, math.sin(turn))) if across else (math.cos(turn), math.sin(turn))
    lines = [
        f"x at {first.direction}, from {first.label}",
        f"y at azimuth {(first.direction.azimuth - 90.0) % 360.0:g}°, from {second.label} ({second.direction})",
    ]
    return {"x": first.samples, "y": (first.samples * cos - second.samples) / sin}, lines
