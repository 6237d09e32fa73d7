"""Outcome statistics near a bifurcation, started on the orbit that lost its stability there."""

import json
from collections.abc import Sequence

import numpy as np
import xarray as xr

from stylobate.engine import simulate_ensemble
from stylobate.errors import Interrupted, ParameterError, as_numbers, require_positive, require_whole
from stylobate.orbits import Bifurcation
from stylobate.orbits.bifurcations import require_bifurcation
from stylobate.parameter_quantities import attributes_of, quantity_of
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.results.random_numbers import Rng, seed_of
from stylobate.studies.maps.attractors import label_attractors
from stylobate.text import plural


@shows_progress("after the bifurcation")
def after_bifurcation(
    bifurcation: Bifurcation,
    *,
    values: Sequence[float],
    count: int = 48,
    size: float = 1e-3,
    periods: float = 600.0,
    rng: Rng = 0,
    progress: Progress = None,
) -> xr.Dataset:
    """Count the outcomes of runs near the orbit of a bifurcation, at values of the parameter around it.

    Beyond a supercritical loss of stability the runs reach the attractors that branch off, as long as these exist.
    Beyond a subcritical loss the runs reach distant attractors.

    Parameters
    ----------
    bifurcation
        A bifurcation of a branch, see `sb.orbits.continue_branch`.
    values
        Values of the branch's parameter.
    count, size, rng
        Number of runs at each value; standard deviation, in units of c, of the normal disturbances of tilt and of tilt
        rate (per unit of the model's time) from the orbit at the bifurcation; seed or numpy.random.Generator.
    periods
        Duration of each run in periods of the base motion.
    progress
        A function that is called with the number of values done and of all values; a bar by default, False for none.

    Returns
    -------
    xarray.Dataset
        `count` over the parameter and `fate`: overturned, at rest, rolling, modulated and so on, classified as by
        `label_attractors`, with the length of orbits of more than one period; also "not settled".

    Raises
    ------
    ParameterError
        If values or numbers are out of range.
    Interrupted
        On Ctrl-C; `partial` has the values that were done.
    """
    require_bifurcation(bifurcation)
    values = as_numbers("values", values, quantity_of(bifurcation.point.family.name).unit)
    chosen = np.asarray(values, dtype=float)
    if chosen.ndim != 1 or chosen.size == 0 or not np.all(np.isfinite(chosen)):
        raise ParameterError(f"values must be a list of numbers, got {values!r}")
    count, size = require_whole("count", count, least=1), require_positive("size", size)
    orbit, name = bifurcation.orbit, bifurcation.point.family.name
    c, scale = orbit.model.column.slenderness, orbit.model.time_scale
    off = size * c * np.random.default_rng(seed_of(rng)).standard_normal((2, count, 2))
    counted: list[dict[str, int]] = []
    stopped = False
    try:
        for index, value in enumerate(chosen):
            system = orbit.system.changed(**{name: float(value)})
            period = system.motion.period
            assert period is not None
            runs = simulate_ensemble(
                system.model,
                system.motion,
                tilt=orbit.tilt + off[0],
                tilt_rate=orbit.tilt_rate + off[1] / scale,
                duration=require_positive("periods", periods) * period,
                strobes=32,
            )
            counted.append(_counted(label_attractors(runs, system.model, system.motion)))
            report_of(progress)(index + 1, chosen.size)
    except KeyboardInterrupt:
        if not counted:
            raise
        stopped = True
    names = sorted({name for counts in counted for name in counts})
    table = np.array([[counts.get(name, 0) for name in names] for counts in counted])
    found = xr.Dataset(
        {"count": ((name, "fate"), table, {"units": "1", "long_name": "runs"})},
        coords={name: (name, chosen[: len(counted)], attributes_of(name)), "fate": names},
        attrs={
            "kind": "after bifurcation",
            "parameter": name,
            "bifurcation": bifurcation.kind.value,
            "at": bifurcation.parameter,
            "provenance": json.dumps(provenance_of_run(orbit.model, orbit.motion)),
        },
    )
    if stopped:
        raise Interrupted(f"stopped after {len(counted)} of {plural(chosen.size, 'value')}, which `partial` has", found)
    return found


def _counted(labelled: xr.Dataset) -> dict[str, int]:
    counts: dict[str, int] = {}
    for kind, period, number in zip(
        labelled["attractor_kind"].to_numpy(),
        labelled["attractor_period"].to_numpy(),
        labelled["count"].to_numpy(),
        strict=True,
    ):
        name = f"{kind}, period {period}" if period > 1 else str(kind)
        counts[name] = counts.get(name, 0) + int(number)
    return counts
