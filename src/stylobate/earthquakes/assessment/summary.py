"""Summary of an assessment: numbers of records that overturned a column, or left the verdict open."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.earthquakes.assessment.inputs import CENTRAL, OTHER_LAW
from stylobate.studies.maps.uncertainty_exponent import overturned_or_not

_ACTS = "with"


def summary_of(data: Mapping[str, xr.Dataset], governing: list[str]) -> xr.Dataset:
    """Count the records by their outcomes, and collect the extreme results over them.

    Parameters
    ----------
    data
        The parts of an assessment.
    governing
        Governing record of each column.

    Returns
    -------
    xarray.Dataset
        Over `column` and `scale`, numbers of records: `overturned`, `undecided` and `stood` in the central case
        (central dissipation with the vertical component); `overturned_in_some`, `undecided_in_some` and
        `uncertain_in_some` in at least one case; `on_dissipation` and `on_vertical`, with a verdict that depends on
        dissipation or vertical component; `overturned_other_law`, overturned with the other contact law at some level;
        `in_band`, with an overturning scale within 10 %; `variations_disagree`, overturned by some small variations
        but not by all; `undecided_word`, undecided under small variations; `planar_differs`, with another outcome
        of the planar column. Also `peak_tilt_ratio`; `friction_demand`, the largest of all runs, and over `record` too
        `friction_by_record`.

        Over `column`: `governing`; `least_overturning`, the smallest overturning scale of the central case, NaN if
        none, and its record `least_record`, empty if none; `least_of_all`, the smallest of all cases; of the cases with
        the given contact law: `friction_to_margin`, the largest, `least_slipping`, the smallest, and `slips_first`,
        whether in some case a record needs more than the stated friction below the smallest overturning scale; of the
        cases with the other contact law `least_slipping_other_law`, the smallest, NaN if none; `slides_first`,
        whether the stated friction is below r/h, so that the column slides before it rocks. Numbers of records in the
        central case: `never_overturned`, `stands_again`, and `scan_undecided`, with undecided runs in
        the scan of the margin; `decided_to`, the largest scale up to which all runs of the central case were decided,
        NaN if the first scale was not.
    """
    verdicts, margins = data["verdicts"], data["margins"]
    fallen = verdicts["overturned"]
    central = fallen.sel(dissipation=CENTRAL, vertical=_ACTS, drop=True)
    counts = {
        "stood": (central == 0).sum("record"),
        "overturned": (central == 1).sum("record"),
        "undecided": (central < 0).sum("record"),
        "overturned_in_some": (fallen == 1).any(("dissipation", "vertical")).sum("record"),
        "undecided_in_some": (fallen < 0).any(("dissipation", "vertical")).sum("record"),
        "uncertain_in_some": (verdicts["uncertain"] == 1).any(("dissipation", "vertical")).sum("record"),
        "on_dissipation": _differs(fallen.sel(vertical=_ACTS, drop=True), "dissipation"),
        "on_vertical": _differs(fallen.sel(dissipation=CENTRAL, drop=True), "vertical"),
    }
    others = margins["case"].str.endswith(OTHER_LAW)
    own_law, other_law = margins.isel(case=~others), margins.isel(case=others)
    if bool(others.any()):
        law = _at_scales(margins, verdicts["scale"]).where(others, drop=True)
        counts["overturned_other_law"] = (law == 1).any("case").sum("record")
    counts["in_band"] = (margins["in_band"] > 0).any("case").sum("record")
    if "variations" in data:
        shares = data["variations"]
        counts["variations_disagree"] = ((shares["overturned"] > 0) & (shares["overturned"] < shares["runs"])).sum(
            "record"
        )
        counts["undecided_word"] = (shares["word"] == "undecided").sum("record")
    if "planar" in data:
        tilts = data["planar"]["planar_tilt_ratio"]
        decided = (central >= 0) & tilts.notnull()
        counts["planar_differs"] = (decided & (np.isinf(tilts) != (central == 1))).sum("record")
    tilt = verdicts["tilt_ratio"].sel(dissipation=CENTRAL, vertical=_ACTS, drop=True)
    least = margins["least_overturning"]
    central_margins = margins.sel(case=CENTRAL, drop=True)
    return xr.Dataset(
        {
            **counts,
            "peak_tilt_ratio": tilt.max("record"),
            "friction_demand": verdicts["friction_demand"].max(("record", "dissipation", "vertical")),
            "friction_by_record": verdicts["friction_demand"].max(("dissipation", "vertical")),
            "governing": ("column", governing),
            "least_overturning": central_margins["least_overturning"].min("record"),
            "least_record": ("column", _least_records(central_margins)),
            "least_of_all": least.min(("record", "case")),
            "friction_to_margin": own_law["friction_to_margin"].max(("record", "case")),
            "least_slipping": own_law["least_slipping"].min(("record", "case")),
            "least_slipping_other_law": other_law["least_slipping"].reduce(_least, ("record", "case")),
            "slips_first": _slips_first(own_law).any(("record", "case")).astype(np.int8),
            "slides_first": margins["standing_slip"].notnull().any(("record", "case")).astype(np.int8),
            "never_overturned": (central_margins["intervals"] == 0).sum("record"),
            "stands_again": (central_margins["stands_again"] > 0).sum("record"),
            "scan_undecided": (central_margins["unknown"] > 0).sum("record"),
            "decided_to": central_margins["decided_to"].min("record", skipna=False),
        }
    ).transpose("column", ...)


def _at_scales(margins: xr.Dataset, scales: xr.DataArray) -> xr.DataArray:
    """Return the states of the scan at the stated scales: 1 overturned, 0 not, negative undecided."""
    state = margins["outcome"].copy(data=overturned_or_not(margins))
    stated = [state.sel(margin_scale=scale, method="nearest").drop_vars("margin_scale") for scale in scales.to_numpy()]
    joined: xr.DataArray = xr.concat(stated, dim=scales)
    return joined


def _least_records(margins: xr.Dataset) -> list[str]:
    """Return the record with the smallest overturning scale of each column; the first by name among equals."""
    least = margins["least_overturning"].transpose("column", "record").to_numpy()
    names = margins["record"].to_numpy()
    return [str(names[np.nanargmin(row)]) if np.isfinite(row).any() else "" for row in least]


def _least(values: npt.NDArray[np.float64], axis: tuple[int, ...]) -> Any:
    """Return the minimum of the numbers, also of none; NaN without any."""
    least = np.fmin.reduce(values, axis=axis, initial=np.inf)
    return np.where(np.isinf(least), np.nan, least)


def _slips_first(margins: xr.Dataset) -> xr.DataArray:
    """Return whether a scale below the smallest overturning scale (if any) needs more than the stated friction."""
    slipping, falling = margins["least_slipping"], margins["least_overturning"]
    return slipping.notnull() & ~(slipping >= falling)


def _differs(states: xr.DataArray, dim: str) -> xr.DataArray:
    return ((states == 1).any(dim) & (states == 0).any(dim)).sum("record")
