"""Rows of text that state the results of a run, a `Run`: for its card, the command line and the laboratory."""

import math
from typing import TYPE_CHECKING, Any

from stylobate.results.outcomes import NUMERICALLY_UNCERTAIN
from stylobate.results.verdict import damping_yardstick, yardstick_text
from stylobate.text import four_digits

if TYPE_CHECKING:
    from stylobate.column import Column

Rows = list[tuple[str, str]]
"""Labels and their values."""


def column_rows(column: "Column", capacity: float) -> Rows:
    """Return the rows of the column: its numbers, estimated inertia, and the acceleration that uplifts or moves it.

    `capacity` is the `rest_capacity` of the model. A column that slides first does not uplift at c g.
    """
    onset = "slides above" if capacity < column.slenderness else "uplifts above"
    least = min(capacity, column.slenderness) * column.gravity
    own = column.profile
    estimated = [("profile", f"{own.name}, {own.spread_in_words}")] if own is not None and own.is_estimated else []
    return [
        ("column", f"c = {column.slenderness:.5g}, ω0 = {column.frequency_scale:.5g} rad/s, mass {column.mass:.6g} kg"),
        *estimated,
        (onset, f"{least:.5g} m/s² of horizontal acceleration"),
    ]


def damping_rows(column: "Column", damping: float | None) -> Rows:
    """Return the rows of the damping of a run, if its model has any, and of Housner's damping of its column."""
    own = [] if damping is None else [("damping", f"η = {damping:.4g}")]
    return [*own, ("Housner's impacts lose as", yardstick_text(damping_yardstick(column).values()))]


def outcome_of(run: Any) -> str:
    """Return the outcome in words, with a remark if it is numerically uncertain."""
    return f"{run.outcome.label}" + (f" ({NUMERICALLY_UNCERTAIN})" if run.uncertain else "")


def reason_rows(run: Any) -> Rows:
    """Return the rows of the reason of the outcome and the time of its decision."""
    return [("because", run.reason), ("decided at", f"{run.decided_at:.4f} s")]


def measure_rows(run: Any) -> Rows:
    """Return the rows of the measures of `run`: tilt, final position and contact demand."""
    return [*_motion_rows(run), *_contact_rows(run), *_demand_rows(run)]


def threshold_rows(run: Any) -> Rows:
    """Return the rows of the thresholds that decided the outcome of `run`."""
    return [
        (
            name.replace("_", " "),
            "none" if math.isinf(value) else f"{four_digits(value)} {_UNITS.get(name, '')}".rstrip(),
        )
        for name, value in run.thresholds.items()
    ]


def _motion_rows(run: Any) -> Rows:
    measures = run.measures
    rows = [("peak tilt", f"{measures['peak_tilt']:.6g} rad, {measures['peak_tilt_over_c']:.4g} c")]
    if measures["peak_tilt"] > 0.0:
        rows.append(("reached at", f"{measures['time_of_peak_tilt']:.4f} s"))
        rows.append(("turns of the contact point", f"{measures['turns']:.3f}"))
    if "mean_rolling_rate" in measures:
        rows.append(("mean rolling rate", f"{measures['mean_rolling_rate']:.6g} rad/s"))
    return [*rows, ("events", _events(run)), ("steps", f"{measures['steps']:.0f}")]


def _events(run: Any) -> str:
    events = [event for event in run.events if not event.repeats]
    listed = [f"{event.kind} at {event.time:.4f} s" for event in events[:_SHOWN]]
    if len(events) > _SHOWN:
        listed.append(f"and {len(events) - _SHOWN} more")
    return ", ".join(listed) or "none"


def _contact_rows(run: Any) -> Rows:
    """Return the rows of contact times and residual displacement of a model that slides."""
    measures = run.measures
    if "residual_displacement" not in measures:
        return []
    kinds = ("resting", "sliding", "rolling", "slipping", "flying")
    times = ", ".join(f"{kind} {measures[f'time_{kind}']:.4g} s" for kind in kinds if measures[f"time_{kind}"] > 0.0)
    moved = ", ".join(f"{measures[f'residual_displacement_{axis}']:.4g} m along {axis}" for axis in "xy")
    return [
        ("time", times),
        ("moved by", moved),
        ("twisted by", f"{measures['residual_twist']:.4g} rad"),
        ("slipped", f"{measures['slip_distance']:.4g} m in all"),
        ("impacts", f"{measures['impacts']:.0f}"),
    ]


def _demand_rows(run: Any) -> Rows:
    measures = run.measures
    return [(label, _bounded(measures[name], unit)) for label, name, unit in DEMAND_ROWS if name in measures]


DEMAND_ROWS = (
    ("required friction coefficient", "peak_friction_demand", ""),
    ("required pivoting moment", "peak_pivoting_demand", " of normal force times radius"),
    ("minimum normal force", "minimum_normal_force", " of the weight"),
)
"""Label, measure and unit of each row of the contact demand."""
NO_BOUND = "no bound: nothing presses on the base"


def _bounded(value: float, unit: str) -> str:
    return f"{value:.4g}{unit}" if math.isfinite(value) else NO_BOUND


_UNITS = {
    **dict.fromkeys(("passage_tilt", "no_return_tilt", "tilt_limit", "overturned_tilt"), "rad"),
    **dict.fromkeys(("close_passage", "rest_tilt"), "c"),
    **dict.fromkeys(("rest_energy", "rest_energy_for_good"), "c²"),
}
"""Units of thresholds."""

_SHOWN = 4
"""Maximum number of listed events."""
