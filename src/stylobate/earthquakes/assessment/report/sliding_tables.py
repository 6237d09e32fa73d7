"""The tables of an assessment on columns that slide before they rock, and the pictures of their slip."""

import math

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.report.wording import cells_of, degrees, number
from stylobate.earthquakes.figures.sliding import plot_slip_margins, plot_slip_paths
from stylobate.plots.page import PageTable, Picture
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import percent

_STATES = {1: "reached", 0: "not reached", -1: "not known"}
_MILLIMETRES = 1000.0


def sliding_columns(assessment: Assessment) -> tuple[str, ...]:
    """Return the names of the columns whose slip was computed."""
    if "slip_margins" not in assessment.data:
        return ()
    known = assessment.data["slip_margins"]["peak_slip"].notnull().any(("record", "margin_scale"))
    return tuple(str(name) for name in known["column"].to_numpy()[known.to_numpy()])


def slip_table(assessment: Assessment) -> PageTable:
    """Tabulate the slip at the stated scales, with its interval under small variations, and the residual position."""
    header = (
        *("column", "record", "scale", "peak slip [mm]", "5 to 95 % of small variations [mm]"),
        *("residual slip [mm]", "5 to 95 % of small variations [mm]", "direction [°]", "90 % within ± [°]"),
    )
    known = sliding_columns(assessment)
    rows = []
    for where, one in cells_of(assessment, "sliding", "column", "record", "scale"):
        if where[0] in known:
            angles = (degrees(float(one[name])) for name in ("residual_azimuth", "azimuth_within"))
            rows.append((*where, *_slip(one, "peak_slip"), *_slip(one, "residual_slip"), *angles))
    return PageTable(header, rows)


def slip_summary_table(assessment: Assessment) -> PageTable:
    """Tabulate the slip of each column over all records and small variations."""
    header = (
        *("column", "scale", "peak slip, median [mm]", "5 to 95 % [mm]"),
        *("residual slip, median [mm]", "5 to 95 % [mm]"),
    )
    known = sliding_columns(assessment)
    rows = []
    for where, one in cells_of(assessment, "sliding", "column", "scale"):
        if where[0] in known:
            numbers = (
                text
                for name in ("all_peak_slip", "all_residual_slip")
                for text in (_in_millimetres(one, f"{name}_median"), _interval(one, name))
            )
            rows.append((*where, *numbers))
    return PageTable(header, rows)


def limit_table(assessment: Assessment) -> PageTable:
    """Tabulate whether each limit state is reached at the stated scales, and the smallest scale that reaches it."""
    header = (
        *("column", "record", "limit state", "scale", "state", "share of small variations"),
        *("smallest scale that reaches it", "a larger scale does not"),
    )
    known = sliding_columns(assessment)
    rows: list[tuple[str, ...]] = []
    if "limit_state" not in assessment.data.get("sliding", xr.Dataset()).dims:
        return PageTable(header, rows)
    for where, one in cells_of(assessment, "sliding", "column", "record", "limit_state", "scale"):
        column, record, state, _ = where
        if column not in known or state not in stated_limits(assessment, column):
            continue
        margin = assessment.data["slip_margins"].sel(column=column, record=record, limit_state=state)
        least, share = float(margin["least_reaching"]), float(one["reached_share"])
        rows.append(
            (
                *where,
                _STATES[int(one["reached"])],
                "" if math.isnan(share) else percent(share),
                f"none up to {number(float(margin['decided_to']))}" if math.isnan(least) else number(least),
                "yes" if float(margin["falls_back"]) > 0.0 else "no",
            )
        )
    return PageTable(header, rows)


def slip_pictures(assessment: Assessment, column: str) -> dict[str, Picture]:
    """Draw the slip of a column over the scale, and its paths in plan; by name, empty if its slip was not computed."""
    if column not in sliding_columns(assessment):
        return {}
    limits = [
        (one["name"], one["response"], float(one["limit"]))
        for one in assessment.setting.get("limit_states", {}).get(column, ())
    ]
    margins = assessment.data["slip_margins"].sel(column=column)
    paths = assessment.data["slip_paths"].sel(column=column)
    scale = float(paths["scale"])
    stated = paths.drop_vars("scale").assign_attrs(scale=scale)
    stated = stated.assign_coords(
        limit_state=[one[0] for one in limits],
        response=("limit_state", np.array([one[1] for one in limits], dtype=str)),
        limit=("limit_state", np.array([one[2] for one in limits], dtype=float)),
    )
    return {
        "slip": Picture(
            plot_slip_margins(margins, limits),
            f"{column}: largest distance of the base from its start over the scale of each record."
            + (" Horizontal lines are the limits." if limits else ""),
        ),
        "slip-paths": Picture(
            plot_slip_paths(stated),
            f"{column}: path of the base in plan at {scale:g} times the records."
            + (" Circles are the limits about the start." if limits else ""),
        ),
    }


def stated_limits(assessment: Assessment, column: str) -> tuple[str, ...]:
    """Return the names of the limit states of a column."""
    return tuple(one["name"] for one in assessment.setting.get("limit_states", {}).get(column, ()))


def _slip(one: xr.Dataset, name: str) -> tuple[str, str]:
    return _in_millimetres(one, name), _interval(one, name)


def _in_millimetres(one: xr.Dataset, name: str) -> str:
    return number(_MILLIMETRES * float(one[name]))


def _interval(one: xr.Dataset, name: str) -> str:
    """Return the ends of an interval in mm; empty if it is not known."""
    low, high = float(one[f"{name}_low"]), float(one[f"{name}_high"])
    return "" if math.isnan(low) else f"{number(_MILLIMETRES * low)} to {number(_MILLIMETRES * high)}"
