"""Paths of columns that slide before they rock, in plan."""

import json
import math
from collections.abc import Sequence

import numpy as np
import xarray as xr

from stylobate.base_motions import OneOf
from stylobate.earthquakes.fragility.displacement_limits import LimitState, checked_limit_states
from stylobate.earthquakes.slip_study import (
    checked_sliding,
    limit_coordinates,
    require_slip_first,
    sampled_finely,
    slip_under,
)
from stylobate.earthquakes.study_inputs import Records, named_records
from stylobate.errors import require_positive
from stylobate.models import Sliding
from stylobate.provenance import provenance_of_run
from stylobate.studies.sweeps.designs import Floats

# Maximum number of points of a path.
_POINTS = 1000


def slip_paths(
    model: Sliding, records: Records, *, scale: float = 1.0, limit_states: Sequence[LimitState] = ()
) -> xr.Dataset:
    """Compute the paths of a column that slides before it rocks, under each record at one scale.

    Parameters
    ----------
    model, records, limit_states
        As for `slip_analysis`.
    scale
        Factor of the records.

    Returns
    -------
    xarray.Dataset
        Of kind "slip paths". Over `record` and `sample`: `time` [s] and the position `slip_x`, `slip_y` relative to the
        base [m] while the column slips, at most 1000 points, and last the residual position. NaN beyond, and for a
        record under which the base falls faster than g. Over `limit_state`: `limit` [m] and `response`.

    Raises
    ------
    ParameterError
        As `slip_analysis`.

    Examples
    --------
    >>> import stylobate as sb
    >>> column = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
    >>> pulse = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0)
    >>> found = slip_paths(sb.Sliding(column, friction_coefficient=0.15), pulse)
    >>> round(1000.0 * float(abs(found["slip_x"]).max()), 1)
    109.9
    """
    require_slip_first([checked_sliding(model)])
    limits = checked_limit_states(limit_states)
    named, factor = named_records(records), require_positive("scale", scale)
    friction, gravity = float(model.friction_coefficient), model.column.gravity
    paths = []
    for motion in named.values():
        slid = slip_under(motion, friction, factor, gravity, traced=True)
        times, path = sampled_finely(motion).times, slid.trace[0]
        # a record that begins before t = 0 may have a first point between its samples
        known = np.append(np.zeros(len(path)), times[times >= 0.0])[-len(path) :]
        paths.append(_thinned(known, path, slid.residual[0], flies=bool(slid.flies[0])))
    longest = max(len(one) for one in paths)
    values = np.full((len(paths), longest, 3), np.nan)
    for place, one in enumerate(paths):
        values[place, : len(one)] = one
    over = ("record", "sample")
    provenance = provenance_of_run(model, OneOf(motions=tuple(named.values())), scale=factor)
    return xr.Dataset(
        {
            "time": (over, values[..., 0], {"units": "s", "long_name": "time"}),
            "slip_x": (over, values[..., 1], {"units": "m", "long_name": "slip along x"}),
            "slip_y": (over, values[..., 2], {"units": "m", "long_name": "slip along y"}),
        },
        coords={"record": list(named), **limit_coordinates(limits)},
        attrs={"kind": "slip paths", "scale": factor, "provenance": json.dumps(provenance)},
    )


def _thinned(times: Floats, path: Floats, residual: Floats, *, flies: bool) -> Floats:
    """Return rows of time and position while the column slips, at most `_POINTS`, and the end of the record."""
    if flies:
        return np.full((1, 3), np.nan)
    moved = np.any(np.diff(path, axis=0) != 0.0, axis=1)
    kept = np.append(moved, False) | np.append(False, moved)  # both ends of each step with slip
    kept[0] = True
    rows = np.column_stack([times, path])[kept]
    rows = rows[:: max(1, math.ceil(len(rows) / _POINTS))]
    return np.vstack([rows, [times[-1], *residual]])
