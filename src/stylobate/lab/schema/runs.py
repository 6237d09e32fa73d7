"""Schemas of a run: outcome, measures, histories and motion to draw."""

from stylobate.errors import Outcome
from stylobate.lab.parameter_info import OF_ANY_COLUMN
from stylobate.lab.schema.notation import (
    Schema,
    declared,
    exactly,
    flag,
    listed,
    number,
    or_none,
    ref,
    row,
    table,
    text,
    unless_none,
    word,
)
from stylobate.models.sliding.phases import Contact
from stylobate.plots.geometry import Shape
from stylobate.quantities import parameters_of
from stylobate.results.outcomes import NUMERICALLY_UNCERTAIN

_ANY_NUMBER: Schema = {"type": ["number", "null"]}

_CONTACTS = {kind.value: kind.name.lower() for kind in Contact}

_OUTCOME = word("the outcome", [one.name for one in Outcome])

_COLUMN = table(
    "The decisive numbers of the column.",
    {
        **{name: declared(one) for name, one in OF_ANY_COLUMN.items()},
        "uplift_acceleration": number("c g, the horizontal acceleration at which the standing column uplifts [m/s²]"),
    },
)

_MEASURES = table(
    "Numbers of the run as a whole, null if not finite. Models may add further numbers.",
    {
        "peak_tilt": or_none(number("[rad]")),
        "peak_tilt_over_c": or_none(number("peak tilt over the slenderness")),
        "time_of_peak_tilt": or_none(number("[s]")),
        "minimum_tilt": or_none(number("[rad]")),
        "least_passage": or_none(number("minimum tilt at a passage through the vertical [rad]; null if none")),
        "turns": or_none(number("turns of the contact point round the rim")),
        "steps": or_none(number("steps of the integration")),
    },
    {
        "mean_rolling_rate": or_none(number("mean rolling rate over the last periods of the base [rad/s]")),
        "repetition": or_none(number("difference of the last periods, over the slenderness")),
        "mean_tilt_late": or_none(number("mean tilt over the last periods [rad]")),
        "minimum_tilt_late": or_none(number("minimum tilt over the last periods [rad]")),
        "peak_tilt_late": or_none(number("peak tilt over the last periods [rad]")),
        "repeats_after": or_none(number("periods of the base after which the motion repeats; 0 if it does not")),
        "modulation_change": or_none(number("change of the modulation over the second half of the run")),
        "rolling_rate_error": or_none(number("error of the mean rolling rate, from the turns")),
        "peak_friction_demand": or_none(number("peak friction over normal force; null without a normal force")),
        "peak_pivoting_demand": or_none(number("peak moment over normal force and radius")),
        "minimum_normal_force": or_none(number("minimum normal force over weight")),
        **{f"time_{kind}": or_none(number(f"time {kind} [s]")) for kind in _CONTACTS.values() if kind != "jammed"},
        "residual_displacement": or_none(number("residual displacement of the centre of the footprint [m]")),
        "residual_displacement_x": or_none(number("[m]")),
        "residual_displacement_y": or_none(number("[m]")),
        "residual_twist": or_none(number("[rad]")),
        "walking_distance": or_none(number("length of the path of the footprint [m]")),
        "slip_distance": or_none(number("length of the path of the contact on the plane [m]")),
        "impacts": or_none(number("number of impacts on the plane")),
        "slips": or_none(number("number of starts of slip")),
        "least_painleve_denominator": or_none(number("1 without friction; dynamic jamming at 0")),
    },
    _ANY_NUMBER,
)


def _history(about: str) -> Schema:
    return listed(about, _ANY_NUMBER)


_SERIES = table(
    "Histories, all as long as `time`; null for numbers that are not finite. Models may add further histories.",
    {
        "time": listed("[s]", {"type": "number"}),
        "base_acceleration": listed("base acceleration along x, y, z [m/s²]", row("", 3)),
        "amplitude": _history("tilt θ [rad]"),
    },
    {
        "azimuth": _history("azimuth β of the lean [rad]; null if the column stands upright"),
        "rolling_rate": _history("rate of the azimuth [rad/s]"),
        "spin": _history("angular velocity about the axis [rad/s]"),
        "friction_demand": _history("friction over normal force"),
        "pivoting_demand": _history("moment over normal force and radius"),
        "normal_force": _history("normal force over weight"),
        "contact": listed(", ".join(f"{code} {kind}" for code, kind in _CONTACTS.items()), {"enum": list(_CONTACTS)}),
        "clearance": _history("height of the lowest point above the base [m]"),
        "displacement": listed(
            "displacement of the centre of the footprint since the start [m]", listed("", _ANY_NUMBER)
        ),
        "slip_speed": _history("slip speed of the contact on the plane [m/s]"),
    },
    listed("", {"anyOf": [_ANY_NUMBER, {"type": "array", "items": _ANY_NUMBER}]}),
)

_DRAWN = table(
    "The motion to draw, at equal time steps: lengths in m in the frame of the base, z upwards. "
    "Null for quantities that the model does not provide.",
    {
        "column": table(
            "The body.",
            {name: declared(one.quantity) for name, one in parameters_of(Shape).items()},
            others={},
        ),
        "plane": table("", {"incline": number("[rad]"), "incline_direction": number("[rad]")}, others={}),
        "time": listed("[s]", {"type": "number"}),
        "tilt": listed("tilt vector θ(cos β, sin β) [rad]", row("", 2)),
        "tilt_rate": listed("rate of the tilt vector [rad/s]", row("", 2)),
        "twist": listed("twist χ about the axis [rad]", {"type": "number"}),
        "spin": unless_none(listed("angular velocity about the axis [rad/s]", {"type": "number"})),
        "footprint": listed("centre of the circle on the base about which the contact point lies [m]", row("", 2)),
        "contact_point": listed("[m]", row("", 2)),
        "resting": listed("1 if the whole base face is in contact", {"enum": [0, 1]}),
        "clearance": unless_none(listed("height of the lowest point above the base [m]", {"type": "number"})),
        "base": listed("displacement of the base [m]", row("", 3)),
        "rotation": listed("unit quaternion w, x, y, z", row("", 4)),
        "centre": listed("centre of the bottom circle [m]", row("", 3)),
        "friction_demand": unless_none(_history("friction over normal force")),
        "friction_coefficient": or_none(number("friction coefficient of the contact, if known")),
        "outcome": _OUTCOME,
        "decided_at": number("[s]"),
        "title": text("a line that states the outcome"),
    },
    others={},
)

_SNIPPETS = {
    "toml": text("the description as a file for the command line"),
    "python": text("the same run as a Python program"),
}

_RUN = table(
    "One run.",
    {
        "outcome": _OUTCOME,
        "label": word("the outcome in words", [one.label for one in Outcome]),
        "reason": text("reason for the outcome"),
        "decided_at": number("time at which the outcome was decided [s]"),
        "uncertain": flag(f"whether the outcome is {NUMERICALLY_UNCERTAIN}"),
        "planar": flag("whether the motion stayed in one vertical plane"),
        "warnings": listed("one line each", {"type": "string"}),
        "events": listed(
            "uplifts, impacts and other events", table("", {"kind": text("kind of event"), "time": number("time [s]")})
        ),
        "measures": ref("Measures"),
        "summary": listed("labels and values", exactly("", text("label"), text("value"))),
        "thresholds": table("The thresholds that decided the outcome.", {}, others=_ANY_NUMBER),
        "column": ref("ColumnNumbers"),
        "drawn": ref("DrawnMotion"),
        "series": ref("Series"),
        **_SNIPPETS,
    },
)

RUNS = {
    "Run": _RUN,
    "Measures": _MEASURES,
    "Series": _SERIES,
    "DrawnMotion": _DRAWN,
    "ColumnNumbers": _COLUMN,
    "Described": table(
        "The snippets and the column of a description, without a run.", {**_SNIPPETS, "column": ref("ColumnNumbers")}
    ),
}
"""Components of the OpenAPI document."""
