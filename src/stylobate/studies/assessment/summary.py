"""The counts that a reader sees first: of how many records a column overturned, and of how many that is not sure."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stylobate.studies.assessment.inputs import CENTRAL

_ACTS = "with"


def summary_of(data: Mapping[str, xr.Dataset], governing: list[str]) -> xr.Dataset:
    """Return the counts over the records.

    Parameters
    ----------
    data
        The parts of an assessment.
    governing
        The record that governs each column.

    Returns
    -------
    xarray.Dataset
        Over `column` and `scale`: `overturned`, `undecided` and `stood`, numbers of records at the central dissipation
        with the vertical component; `overturned_in_some`, numbers of records that overturned it in some run, whatever
        the dissipation; `on_dissipation` and `on_vertical`, of records whose verdict depends on these; `not_robust`, of
        those with a verdict that a small change flips; `planar_differs`, of those by which the planar column does
        otherwise; `largest_tilt_ratio`; `friction_demand`, the largest of all runs, and over `record` too
        `friction_by_record`. Over `column`: `governing`, `least_overturning` of the central case and, of all cases,
        `least_of_all`, NaN where none overturned; `friction_to_margin`, the largest of all cases, and the
        `least_slipping` of them; `slips_first`, whether in some case a record needs more than the stated friction below
        the scale that overturns; `never_overturned` and `stands_again`, numbers of records in the central case.
    """
    verdicts, margins = data["verdicts"], data["margins"]
    fallen = verdicts["overturned"]
    central = fallen.sel(dissipation=CENTRAL, vertical=_ACTS, drop=True)
    counts = {
        "stood": (central == 0).sum("record"),
        "overturned": (central == 1).sum("record"),
        "undecided": (central < 0).sum("record"),
        "overturned_in_some": (fallen == 1).any(("dissipation", "vertical")).sum("record"),
        "on_dissipation": _differs(fallen.sel(vertical=_ACTS, drop=True), "dissipation"),
        "on_vertical": _differs(fallen.sel(dissipation=CENTRAL, drop=True), "vertical"),
    }
    if "robustness" in data:
        counts["not_robust"] = (data["robustness"]["flipped"] > 0).sum("record")
    if "planar" in data:
        planar = np.isinf(data["planar"]["planar_tilt_ratio"])
        counts["planar_differs"] = ((central >= 0) & (planar != (central == 1))).sum("record")
    tilt = verdicts["tilt_ratio"].sel(dissipation=CENTRAL, vertical=_ACTS, drop=True)
    least = margins["least_overturning"]
    bands = margins["bands"].sel(case=CENTRAL, drop=True)
    return xr.Dataset(
        {
            **counts,
            "largest_tilt_ratio": tilt.max("record"),
            "friction_demand": verdicts["friction_demand"].max(("record", "dissipation", "vertical")),
            "friction_by_record": verdicts["friction_demand"].max(("dissipation", "vertical")),
            "governing": ("column", governing),
            "least_overturning": least.sel(case=CENTRAL, drop=True).min("record"),
            "least_of_all": least.min(("record", "case")),
            "friction_to_margin": margins["friction_to_margin"].max(("record", "case")),
            "least_slipping": margins["least_slipping"].min(("record", "case")),
            "slips_first": _slips_first(margins).any(("record", "case")).astype(np.int8),
            "never_overturned": (bands == 0).sum("record"),
            "stands_again": (margins["stands_again"].sel(case=CENTRAL, drop=True) > 0).sum("record"),
        }
    ).transpose("column", ...)


def _slips_first(margins: xr.Dataset) -> xr.DataArray:
    """Return whether more than the stated friction is needed below the least scale that overturned, or none did."""
    slipping, falling = margins["least_slipping"], margins["least_overturning"]
    return slipping.notnull() & ~(slipping >= falling)


def _differs(states: xr.DataArray, dim: str) -> xr.DataArray:
    return ((states == 1).any(dim) & (states == 0).any(dim)).sum("record")
