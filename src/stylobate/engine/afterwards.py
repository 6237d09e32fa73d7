"""How long a run lasts where that is not told, and what may yet come of a column that moves when its run ends."""

import math

import xarray as xr

from stylobate.column import Column
from stylobate.errors import ParameterError, require_positive
from stylobate.models import Model
from stylobate.motions import BaseMotion
from stylobate.spec.simulation import duration_with_tail

# What models call the energy that free motion can only lose.
_ENERGY = {"long_name": "energy above rest", "units": "J"}


def duration_of(duration: float | None, model: Model, motion: BaseMotion) -> float:
    """Return how long a run lasts [s]: for the `duration`, or to a free tail of 20/p after a motion that ends.

    Raises
    ------
    ParameterError
        If it is not positive; or if there is none, and the base stays at rest or never does.
    """
    if duration is not None:
        return require_positive("duration", duration, "s")
    if not 0.0 < motion.duration < math.inf:
        what = "a base at rest" if motion.duration == 0.0 else "a base motion that never ends"
        message = f"duration must be given, in s, with {what}, such as duration=60.0; got None"
        raise ParameterError(message)
    return duration_with_tail(model, motion)


def told_of_its_end(data: xr.Dataset, column: Column, motion: BaseMotion) -> str:
    """Return what is known of a column that moves at the end of its run: whether it can yet overturn.

    After a base motion the energy of a column can only fall. With less than it has at rest on its balance, on this side
    of it, it cannot overturn any more.

    Parameters
    ----------
    data
        The history of the run.
    column, motion
        What was followed.
    """
    end = float(data["time"][-1])
    if end < motion.duration:
        return f"{_MOVED}, {motion.duration - end:.4g} s before the base motion stops; {_OPEN}"
    after = end - motion.duration
    followed = motion.duration > 0.0 and after > 0.0
    moved = f"{_MOVED}, {after:.4g} s after the base motion stopped" if followed else _MOVED
    share = _share_of_the_balance(data, column)
    if share < 1.0 and float(data["amplitude"][-1]) < column.tipping_angle:
        return f"{moved}, but cannot overturn any more: it has {100.0 * share:.2g} % of the energy that takes"
    return f"{moved}; {_OPEN}"


_MOVED = "it moved to the end of the run"
_OPEN = "it may yet overturn: follow it longer"


def _share_of_the_balance(data: xr.Dataset, column: Column) -> float:
    """Return the energy at the end over that on the balance, m g (R − h); infinite where the model tells none."""
    energy = data.get("energy")
    if energy is None or any(energy.attrs.get(name) != value for name, value in _ENERGY.items()):
        return math.inf
    return float(energy[-1]) / (column.mass * column.gravity * (column.rim_distance - column.mass_height))
