"""Contact maps: regions of sticking, sliding, rocking, hopping and overturning over two parameters."""

import warnings
from collections.abc import Mapping
from enum import IntEnum
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.engine.contact_measures import EQUAL
from stylobate.errors import (
    Named,
    Outcome,
    ParameterError,
    UnlikelyInputWarning,
    UnsupportedError,
    as_float,
    as_numbers,
)
from stylobate.models import Model, Sliding
from stylobate.progress import Progress, shows_progress
from stylobate.results.outcomes import NOT_COMPUTED, flag_attributes
from stylobate.run_arguments import RunOptions
from stylobate.studies.checks import require_values
from stylobate.studies.sweeps import Executor, Sweep
from stylobate.studies.sweeps.labelled import labelled_sweep
from stylobate.text import plural

_PLANE = 2


class ContactClass(Named, IntEnum):
    """Class of a run by the kinds of contact that occurred in it."""

    STAYS = 0
    """The column stood throughout, and its base did not move on the plane."""
    SLIDES = 1
    """The base slid; the column never tipped."""
    ROCKS = 2
    """The column rocked or rolled on its rim without slip."""
    SLIDES_AND_ROCKS = 3
    """The column rocked or rolled, and slipped on its rim or slid on its base."""
    HOPS_UPRIGHT = 4
    """The column left the plane and landed on its base; it never tilted beyond 1e-4 rad."""
    HOPS_AND_ROCKS = 5
    """The column left the plane, and tilted."""
    OVERTURNS = 6
    FAILED = 7


CONTACT_CLASSES = (
    *("stays", "slides", "rocks or rolls", "slides and rocks", "hops upright", "hops and rocks", "overturns", "failed"),
)
"""Names of the classes, in the order of their codes."""

# Maximum tilt of an upright column [rad].
_UPRIGHT = 1e-4


@shows_progress("contact map")
def contact_map(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, npt.ArrayLike],
    duration: float | None = None,
    periods: float | None = None,
    least_share: float = 1e-3,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Compute a contact map: the kinds of contact over two parameters, such as friction and base acceleration.

    Parameters
    ----------
    model
        A model that changes between kinds of contact, `Sliding`.
    motion, over, duration, periods, store, executor, resume, progress, **options
        As for `overturning_map`.
    least_share
        Minimum fraction of a run for a kind of contact to count.

    Returns
    -------
    xarray.Dataset
        Of kind "contact map": the runs over the two names, with `contact_class` (see its `flag_meanings`),
        `lands_flat` and all variables of ensembles, such as `peak_tilt`; over `class_name`, `count` and `share` of the
        computed runs; and `computed`. A run that `lands_flat` hops at a tilt of exactly 0: a small initial tilt can
        change its class. Count with `upright`.

    Raises
    ------
    ParameterError
        If `over` does not have two names with at least one value each, or an argument is out of range.
    UnsupportedError
        If the model does not change between kinds of contact.
    """
    if not model.switches:
        message = f"model {model.name} assumes permanent contact without slip. A contact map needs Sliding(column)."
        raise UnsupportedError(message)
    if not isinstance(over, Mapping) or len(over) != _PLANE:
        message = f'over must name two parameters, such as "friction_coefficient" and "acceleration"; got {over!r}'
        raise ParameterError(message)
    least_share = as_float("least_share", least_share)
    if not 0.0 <= least_share < 1.0:
        message = f"least_share must lie between 0 and 1, got {least_share!r}"
        raise ParameterError(message)
    require_values("over", over)
    remark_on_knife_edge("over", model, over)
    sweep = Sweep.grid(model, motion, over=over, duration=duration, periods=periods, **options)

    def label(runs: xr.Dataset) -> xr.Dataset:
        return class_shares(runs, least_share)

    return labelled_sweep(sweep, label, store=store, executor=executor, resume=resume, progress=progress)


def class_shares(runs: xr.Dataset, least_share: float = 1e-3) -> xr.Dataset:
    """Convert `runs` to a contact map: add the class of each run, and count and share of each class."""
    classes = contact_classes(runs, least_share)
    count = np.array([int((classes == kind).sum()) for kind in ContactClass], dtype=np.int64)
    computed = int((classes != NOT_COMPUTED).sum())
    return runs.assign(
        contact_class=classes,
        lands_flat=lands_flat(runs),
        count=("class_name", count, {"units": "1", "long_name": "runs of this class"}),
        share=("class_name", count / max(computed, 1), {"units": "1", "long_name": "share of the runs computed"}),
        computed=((), computed, {"units": "1", "long_name": "runs computed"}),
        class_name=np.array(CONTACT_CLASSES),
    ).assign_attrs(kind="contact map", least_share=least_share)


def contact_classes(runs: xr.Dataset, least_share: float = 1e-3) -> xr.DataArray:
    """Classify each run by its `ContactClass`; −1 marks runs that are not computed."""
    least = least_share * runs["end_time"]

    def took(*kinds: str) -> xr.DataArray:
        return sum((runs[f"time_{kind}"] for kind in kinds[1:]), runs[f"time_{kinds[0]}"]) > least

    rocks, slides, outcome = took("rolling", "slipping"), took("sliding", "slipping"), runs["outcome"]
    known: list[tuple[Any, ContactClass]] = [
        (outcome == Outcome.FAILED, ContactClass.FAILED),
        (outcome == Outcome.OVERTURNED, ContactClass.OVERTURNS),
        (took("flying") & (rocks | (runs["peak_tilt"] > _UPRIGHT)), ContactClass.HOPS_AND_ROCKS),
        (took("flying"), ContactClass.HOPS_UPRIGHT),
        (rocks & slides, ContactClass.SLIDES_AND_ROCKS),
        (rocks, ContactClass.ROCKS),
        (slides, ContactClass.SLIDES),
    ]
    classes = xr.full_like(outcome, int(ContactClass.STAYS), dtype=np.int8)
    for where, kind in reversed(known):
        classes = classes.where(~where, int(kind))
    classes = classes.where(outcome != NOT_COMPUTED, NOT_COMPUTED).astype(np.int8)
    meanings = ["NOT_COMPUTED", *(kind.name for kind in ContactClass)]
    return classes.assign_attrs(flag_attributes("contact of the column", meanings, first=NOT_COMPUTED))


def lands_flat(runs: xr.Dataset) -> xr.DataArray:
    """Return which runs hop and land at a tilt of exactly 0 over the last periods, or throughout if these are short.

    Such a landing is exact in a computation only: it strikes the whole base at once, and no friction tips the column.
    """
    tilt = runs["mean_tilt"].fillna(runs["peak_tilt"])
    hops = (runs["time_flying"] > 0.0) & (runs["outcome"] != Outcome.OVERTURNED)
    return (hops & (tilt == 0.0)).assign_attrs(long_name="hops and lands at a tilt of exactly 0")


def stays_in_a_plane(runs: xr.Dataset) -> xr.DataArray:
    """Return which runs tilt and move in exactly one vertical plane, as from a tilt in the plane of vibration.

    Such a motion is exact in a computation only: a part a millionth of a radian beside the plane can move otherwise.
    """
    tilts = runs["peak_tilt"] > 0.0
    return (runs["planar"].astype(bool) & tilts).assign_attrs(long_name="tilts and moves in exactly one vertical plane")


def knife_edge_remarks(runs: xr.Dataset) -> list[str]:
    """Return a remark with the number of runs that land exactly flat, and one with those that stay in one plane."""
    flat, planar = int(lands_flat(runs).sum()), int(stays_in_a_plane(runs).sum())
    return [
        *(
            [f"{plural(flat, 'run')} landed at a tilt of exactly 0: pass a tilt, and count with `upright`"]
            if flat
            else []
        ),
        *([f"{plural(planar, 'run')} stayed in exactly one vertical plane: pass a tilt out of it"] if planar else []),
    ]


def remark_on_knife_edge(where: str, model: Model, over: Mapping[str, npt.ArrayLike]) -> None:
    """Warn if a friction coefficient equals the slenderness: rounding then decides between sliding and rocking."""
    if not isinstance(model, Sliding) or {"radius", "mass_height"} & set(over):
        return
    varied = over.get("static_friction_coefficient", over.get("friction_coefficient"))
    known = model.static_friction_coefficient is not None and "static_friction_coefficient" not in over
    ratios = (
        model.numbers.static if known or varied is None else varied,
        over.get("slenderness", model.column.slenderness),
    )
    frictions, slender = (np.atleast_1d(np.asarray(as_numbers(where, one), dtype=float)) for one in ratios)
    equal = (np.abs(frictions[:, np.newaxis] - slender) <= EQUAL * slender).any(axis=1)
    if equal.any():
        message = (
            f"{where}: a friction coefficient equals the slenderness c (got {float(frictions[equal][0]):g}). Sliding "
            "and rocking begin together there, and rounding decides. Choose values below and above c."
        )
        warnings.warn(message, UnlikelyInputWarning, stacklevel=3)
