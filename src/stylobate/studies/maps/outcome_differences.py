"""Differences of the outcomes of two models over two parameters."""

import json
from collections.abc import Mapping
from enum import Enum
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.errors import Outcome
from stylobate.models import Model
from stylobate.progress import Progress, shows_progress
from stylobate.results.outcomes import NOT_COMPUTED, flag_attributes
from stylobate.run_arguments import RunOptions
from stylobate.studies.maps.overturning import overturning_map
from stylobate.studies.sweeps import Executor

if TYPE_CHECKING:
    import xarray as xr


class Comparison(Enum):
    """Comparison of the outcomes of two models, in the order of the codes."""

    BOTH_STAY = "overturns in neither"
    ONLY_FIRST = "overturns in the first only"
    ONLY_SECOND = "overturns in the second only"
    BOTH_OVERTURN = "overturns in both"
    UNDECIDED = "undecided"
    """A run failed, or lifted off, or was stopped by a tilt limit."""


@shows_progress("outcome differences")
def outcome_differences(
    first: Model,
    second: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, npt.ArrayLike],
    duration: float | None = None,
    periods: float | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> "xr.Dataset":
    """Compare, over two parameters, whether a column overturns in two models.

    If the models differ in one assumption, such as `Slender` and `SlenderRolling`, the map shows where this assumption
    decides the outcome.

    Parameters
    ----------
    first, second
        The models, usually of one column.
    motion, over, duration, periods, executor, progress, **options
        As in `overturning_map`; `over` names parameters of both models.

    Returns
    -------
    xarray.Dataset
        Of kind "outcome differences": over the two names `comparison`, codes of `Comparison`; `first_outcome`,
        `second_outcome`, and `first_peak_tilt`, `second_peak_tilt` [rad], with demands=True also the contact demands of
        both; `count` and `share` over `comparison_name`.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    Interrupted
        After Ctrl-C; `partial` is the overturning map of the model that was interrupted.

    Examples
    --------
    >>> import stylobate as sb
    >>> column = sb.Column.dimensionless(slenderness=0.1)
    >>> held, free = sb.Slender(column, damping=0.1), sb.SlenderRolling(column, damping=0.1, spin_damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.13, angular_frequency=3.0)
    >>> over = {"angular_frequency": [2.0, 3.0], "acceleration": [0.12, 0.13]}
    >>> found = sb.studies.outcome_differences(held, free, motion, over=over, periods=60.0)
    >>> print(found["comparison"].dims, int(found["count"].sum()))
    ('angular_frequency', 'acceleration') 4
    """
    shared: dict[str, Any] = {"duration": duration, "periods": periods, "executor": executor, "progress": progress}
    maps = [overturning_map(model, motion, over=over, **shared, **options) for model in (first, second)]
    codes = _compared_pair(*(found["outcome"].to_numpy() for found in maps))
    return _dataset(maps, codes, (first, second))


def _compared_pair(first: npt.NDArray[np.int8], second: npt.NDArray[np.int8]) -> npt.NDArray[np.int8]:
    fallen = Outcome.OVERTURNED
    places = {one: code for code, one in enumerate(Comparison)}
    codes = np.where(first == fallen, places[Comparison.ONLY_FIRST], places[Comparison.BOTH_STAY])
    codes = np.where(second == fallen, codes + places[Comparison.ONLY_SECOND], codes)
    unclear = [Outcome.FAILED, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED]
    codes = np.where(np.isin(first, unclear) | np.isin(second, unclear), places[Comparison.UNDECIDED], codes)
    return np.where((first == NOT_COMPUTED) | (second == NOT_COMPUTED), NOT_COMPUTED, codes).astype(np.int8)


# Variables of each model's runs in the result; demands only if they were computed.
_COMPARED = ("outcome", "peak_tilt", "peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force")


def _dataset(maps: "list[xr.Dataset]", codes: npt.NDArray[np.int8], models: tuple[Model, Model]) -> "xr.Dataset":
    import xarray as xr

    dims = maps[0]["outcome"].dims
    names = [one.value for one in Comparison]
    meanings = ["NOT_COMPUTED", *(one.name for one in Comparison)]
    about = flag_attributes("comparison of the two models", meanings, first=NOT_COMPUTED)
    count = np.array([np.count_nonzero(codes == code) for code in range(len(names))], dtype=np.int64)
    variables: dict[str, Any] = {
        "comparison": (dims, codes, about),
        "count": ("comparison_name", count, {"units": "1", "long_name": "runs compared so"}),
        "share": ("comparison_name", count / max(codes.size, 1), {"units": "1", "long_name": "share of the runs"}),
    }
    provenance = {}
    for place, found in zip(("first", "second"), maps, strict=True):
        variables |= {f"{place}_{name}": found[name].variable for name in _COMPARED if name in found}
        provenance[place] = json.loads(found.attrs["provenance"])
    return xr.Dataset(
        variables,
        coords={**{dim: maps[0][dim] for dim in dims}, "comparison_name": names},
        attrs={
            "kind": "outcome differences",
            "first": models[0].name,
            "second": models[1].name,
            "provenance": json.dumps(provenance),
        },
    )
