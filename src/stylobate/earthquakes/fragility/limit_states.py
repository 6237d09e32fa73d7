"""Limit states of columns: peak tilts and overturning, from the results of ensembles."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.earthquakes.fragility.observations import LIMIT_STATE, NOT_KNOWN
from stylobate.errors import Outcome, ParameterError, require_positive
from stylobate.results.outcomes import NOT_COMPUTED, flag_attributes
from stylobate.studies.maps.safe_distance import UNRESOLVED


def limit_states(
    runs: xr.Dataset,
    *,
    slenderness: npt.ArrayLike | xr.DataArray | None = None,
    tilt_ratios: Sequence[float] = (1e-3, 0.1, 0.5, 1.0),
) -> xr.DataArray:
    """Find the limit states that each run reached: peak tilts in fractions of α_c = arctan c, and overturning.

    The tipping angle α_c is the tilt at which the centre of mass stands above the contact point. The smallest default
    tilt, 0.001 α_c, separates columns that rock from those that stand. It is not uplift: an upright column lifts if
    |a_h| > c (g + a_z), and may then tilt less.

    Parameters
    ----------
    runs
        Runs with `outcome` and `peak_tilt` [rad], such as from `simulate_ensemble`, `overturning_map` or a sweep.
    slenderness
        c of each run; by default the coordinate `slenderness` of `runs`.
    tilt_ratios
        Peak tilts over α_c, positive. A run that starts at a larger tilt has reached it from the start.

    Returns
    -------
    xarray.DataArray
        Over `limit_state` and the dimensions of `runs`: 1 reached, 0 not, −1 not known. A run that overturned has
        reached all limit states. A run that failed, lifted off or stopped at a tilt limit has reached the limit states
        below its peak tilt; the others are undecided. A run that was not computed is undecided. A run that is
        STILL_MOVING did not overturn by its end and counts as SURVIVED.

    Raises
    ------
    ParameterError
        If `runs` lack a variable, the slenderness is not known, or a ratio is not positive.

    Examples
    --------
    >>> import xarray as xr
    >>> from stylobate import Outcome
    >>> codes = [Outcome.AT_REST, Outcome.SURVIVED, Outcome.OVERTURNED]
    >>> runs = xr.Dataset({"outcome": ("run", codes), "peak_tilt": ("run", [0.0, 0.06, 0.09])})
    >>> states = limit_states(runs, slenderness=0.1)
    >>> print(states.sel(limit_state="tilt 0.5 α").values, states.sel(limit_state="overturning").values)
    [0 1 1] [0 0 1]
    """
    for name in ("outcome", "peak_tilt"):
        if name not in runs:
            raise ParameterError(
                f"runs must hold the variable {name}, got {', '.join(map(str, runs.data_vars)) or 'none'}"
            )
    critical = np.arctan(_slenderness(runs, slenderness))
    codes, tilt = runs["outcome"], runs["peak_tilt"]
    fallen = codes == Outcome.OVERTURNED
    decided = ~codes.isin([NOT_COMPUTED, *UNRESOLVED])
    limits = {
        f"tilt {require_positive(f'tilt_ratios[{place}]', ratio):g} α": ratio for place, ratio in enumerate(tilt_ratios)
    }
    exceeded = [fallen | (tilt > ratio * critical) for ratio in limits.values()]
    computed = codes != NOT_COMPUTED
    unreached = xr.zeros_like(codes, dtype=np.int8).where(decided, np.int8(NOT_KNOWN))
    states = [unreached.where(~(reached & computed), np.int8(1)) for reached in [*exceeded, fallen]]
    names = xr.DataArray([*limits, "overturning"], dims=LIMIT_STATE, name=LIMIT_STATE)
    joined: xr.DataArray = xr.concat(states, dim=names).rename("reached")
    joined.attrs = {}
    return joined.assign_attrs(
        flag_attributes("limit state reached", ["NOT_KNOWN", "NOT_REACHED", "REACHED"], first=NOT_KNOWN)
    )


def _slenderness(runs: xr.Dataset, given: npt.ArrayLike | xr.DataArray | None) -> xr.DataArray:
    if given is None:
        if "slenderness" not in runs.coords:
            raise ParameterError("slenderness must be given if runs have no coordinate of that name, got None")
        return runs["slenderness"]
    if isinstance(given, xr.DataArray):
        values = given
    else:
        array = np.asarray(given, dtype=float)
        if array.ndim and array.shape != runs["outcome"].shape:
            raise ParameterError(
                f"slenderness must be a number or have the shape of runs, {runs['outcome'].shape}; got {array.shape}"
            )
        values = xr.DataArray(array, dims=runs["outcome"].dims if array.ndim else ())
    numbers = values.to_numpy()
    bad = numbers[~(np.isfinite(numbers) & (numbers > 0.0))]
    if bad.size:
        require_positive("slenderness", bad.flat[0])
    return values
