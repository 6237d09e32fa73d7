"""Overturning maps: outcomes over any two parameters; of a column that can slip, the kinds of contact too."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Unpack

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.declared import is_pulse, with_numbers
from stylobate.config.study import Classes, Study
from stylobate.errors import Outcome, ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.quantities import Quantity
from stylobate.results.outcomes import (
    CONTACT_CLASSES,
    NOT_COMPUTED,
    ContactClass,
    contact_classes,
    knife_edge_remarks,
    lands_flat,
)
from stylobate.results.tables import ResultTable, number_of_runs
from stylobate.run_arguments import duration_with_tail
from stylobate.studies.study import StudyArguments, described, study

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.studies.sweeps import Sweep
    from stylobate.studies.sweeps.running import Label

_PLANE = 2
_LEAST_SHARE = 1e-3
_SHARE = Quantity(text="minimum fraction of a run for a kind of contact to count; only with sliding", ge=0.0, lt=1.0)


def _shares(result: "xr.Dataset") -> list[tuple[str, int, float]]:
    """Return the name of each outcome, or class of contact, with the count and share of its runs."""
    names = "class_name" if "class_name" in result else "outcome_name"
    table = (result[name].to_numpy() for name in (names, "count", "share"))
    return [(str(name), int(count), float(share)) for name, count, share in zip(*table, strict=True)]


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    outcomes = {name: {"count": count, "share": share} for name, count, share in _shares(result)}
    return {"outcomes": outcomes, "uncertain": int(result["uncertain"].sum())}


def _table(result: "xr.Dataset") -> ResultTable:
    rows = [(name, str(count), f"{100.0 * share:.2f} %") for name, count, share in _shares(result) if count]
    title = number_of_runs(result, f" over {' and '.join(map(str, result['outcome'].dims))}")
    uncertain = int(result["uncertain"].sum())
    remarks = [f"{uncertain} numerically uncertain: rounding could alter them"] if uncertain else []
    if {Outcome.AT_REST.label, Outcome.SURVIVED.label} <= {row[0] for row in rows}:
        remarks.append("columns at rest and those that survived stand: the latter still move, but cannot overturn")
    if "class_name" in result:
        remarks = [f"{one}, count outcomes with `upright`" for one in remarks] + knife_edge_remarks(result)
    return ResultTable("; ".join([title, *remarks]), ("outcome", "runs", "share"), rows)


def _arguments(config: Any, setup: Any) -> Mapping[str, Any]:
    """Return the duration of runs under pulses of several frequencies: that of the longest pulse, with its tail."""
    frequencies = setup.options["over"].get("angular_frequency")
    if frequencies is None or config.duration is not None or config.periods is not None:
        return {}
    if not is_pulse(setup.motion):
        return {}
    longest = with_numbers(setup.motion, {"angular_frequency": float(frequencies.min())})
    return {"duration": duration_with_tail(longest.duration, setup.model.column.frequency_parameter)}


@study(
    "map",
    Study(
        name="map",
        source="TOML description, or a saved map (.nc) or store (.zarr) to show or repeat",
        help="""Compute the overturning map over two parameters.

    Each run stays, rocks, rolls or overturns; with --model sliding it may also slide, slip or fly. A number of column,
    model, base motion or initial state varies along each axis: angular-frequency, acceleration, start-phase, damping,
    size, tilt-x … A saved map is shown; options that change it compute it again. Examples:

    stylobate map --slenderness 0.1 --damping 0.1 --motion circular --x angular-frequency 0.5 6 100
    --y acceleration 0.05 0.6 100 --periods 100 --output map.zarr --figure map.png

    stylobate map map.zarr --resume
    """,
        axes=("x", "y"),
        early=True,
        arguments=_arguments,
        classes=(Classes("contact_class", "class_name"), Classes("outcome", "outcome_name")),
        completed=lambda saved, _, options: saved if "count" in saved else labelled(saved, options.get("least_share")),
        table=_table,
        summary=_summary,
    ),
)
def overturning_map(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, npt.ArrayLike],
    least_share: Annotated[float | None, _SHARE] = None,
    **run: Unpack[StudyArguments],
) -> "tuple[Sweep, Label]":
    """Compute the outcome of a column over two parameters, from rest or a given initial state.

    Parameters
    ----------
    model, motion
        The column and its base motion. The quantities in `over` replace their values. With a model that changes between
        kinds of contact, `Sliding`, the map has the kinds of contact too.
    over
        Two names with their values: parameters of the column, the model or the base motion, such as
        angular_frequency [rad/s], acceleration [m/s²], start_phase [rad], damping, size; or components of the initial
        condition, tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y [rad/s].
    least_share
        Minimum fraction of a run for a kind of contact to count, 0.001 by default; only with `Sliding`.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "overturning map". Over the two names: `outcome`, `decided_at`, `uncertain` and all variables of
        `simulate_ensemble`. Over `outcome_name`: `count` and `share` of the runs computed. `computed` counts the runs.

        With `Sliding`, of kind "contact map": also `contact_class` (see its `flag_meanings`) and `lands_flat`, with
        `count` and `share` over `class_name`. A run that `lands_flat` hops at a tilt of exactly 0: a small initial tilt
        can change its class. Count with `stylobate.conveying.upright`.

    Raises
    ------
    ParameterError
        If `over` does not have two names with at least one value each, or an argument is out of range.
    UnsupportedError
        If `least_share` is given and the model does not change between kinds of contact.

    Notes
    -----
    With `end_converged=True` runs on a circularly moving base end early once they have converged to steady rolling,
    which the model must state in closed form; see "End converged runs early" on the page on ensembles. It saves time in
    maps of 300 periods and more that begin near steady rolling, and costs time in shorter ones.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)
    >>> over = {"angular_frequency": [0.5, 6.0], "acceleration": [0.09, 0.15]}
    >>> found = sb.studies.overturning_map(model, motion, over=over, periods=30.0)
    >>> found["share"].sel(outcome_name=["at rest", "overturned"]).values
    array([0.5 , 0.25])
    """
    from stylobate.engine.parameters import own_numbers
    from stylobate.studies.checks import remark_on_knife_edge, require_values
    from stylobate.studies.sweeps import Sweep

    if not isinstance(over, Mapping) or len(over) != _PLANE:
        raise ParameterError(
            f'over must name two parameters, such as "angular_frequency" and "acceleration"; got {over!r}'
        )
    if least_share is not None:
        least_share = _SHARE.checked("least_share", least_share)
        if not model.switches:
            raise UnsupportedError(
                f"least_share: model {model.name} assumes permanent contact without slip (got {least_share!r}). "
                "Kinds of contact need Sliding(column)."
            )
    require_values("over", over, own_numbers(model, motion))
    remark_on_knife_edge("over", model, over)
    return Sweep.grid(model, motion, over=over, **described(run)), lambda runs: labelled(runs, least_share)


def labelled(runs: "xr.Dataset", least_share: float | None = None) -> "xr.Dataset":
    """Return `runs` as a map: with the class of each run that can slip, and the count and share of each outcome."""
    if "time_flying" in runs:
        least_share = _LEAST_SHARE if least_share is None else least_share
        classes = contact_classes(runs, least_share)
        runs = runs.assign(contact_class=classes, lands_flat=lands_flat(runs))
        names = dict(zip(map(int, ContactClass), CONTACT_CLASSES, strict=True))
        return _counted(runs, classes.to_numpy(), "class_name", names).assign_attrs(
            kind="contact map", least_share=least_share
        )
    names = {int(outcome): outcome.label for outcome in Outcome}
    return _counted(runs, runs["outcome"].to_numpy(), "outcome_name", names).assign_attrs(kind="overturning map")


def _counted(runs: "xr.Dataset", codes: npt.NDArray[np.int8], dim: str, names: Mapping[int, str]) -> "xr.Dataset":
    """Return `runs` with the count and share of the runs of each code along `dim`."""
    count = np.array([np.count_nonzero(codes == code) for code in names], dtype=np.int64)
    computed = int(np.count_nonzero(codes != NOT_COMPUTED))
    what = "runs with this outcome" if dim == "outcome_name" else "runs of this class"
    return runs.assign(
        {
            "count": (dim, count, {"units": "1", "long_name": what}),
            "share": (dim, count / max(computed, 1), {"units": "1", "long_name": "share of the runs computed"}),
            "computed": ((), computed, {"units": "1", "long_name": "runs computed"}),
            dim: np.array(list(names.values())),
        }
    )
