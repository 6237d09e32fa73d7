"""What is answered of a run: its outcome, measures and history, and how it is drawn."""

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
from stylobate.plots.shape import Shape
from stylobate.quantities import parameters_of

_ANY_NUMBER: Schema = {"type": ["number", "null"]}

_CONTACTS = {kind.value: kind.name.lower() for kind in Contact}

_OUTCOME = word("the outcome", [one.name for one in Outcome])

_COLUMN = table(
    "The numbers of the column that decide.",
    {
        **{name: declared(one) for name, one in OF_ANY_COLUMN.items()},
        "uplift_acceleration": number("c g, the horizontal acceleration that tips the standing column [m/s²]"),
    },
)

_MEASURES = table(
    "Numbers of the run as a whole, null where one is not finite. Models may add further ones.",
    {
        "peak_tilt": or_none(number("[rad]")),
        "peak_tilt_over_c": or_none(number("the same over the slenderness")),
        "time_of_peak_tilt": or_none(number("[s]")),
        "minimum_tilt": or_none(number("[rad]")),
        "least_passage": or_none(number("minimum tilt at a passage of the upright [rad]; null without a passage")),
        "turns": or_none(number("of the contact point round the rim")),
        "steps": or_none(number("of the integration")),
    },
    {
        "mean_rolling_rate": or_none(number("over the last periods of the base [rad/s]")),
        "repetition": or_none(number("by how much the last periods differ, over the slenderness")),
        "mean_tilt_late": or_none(number("over the last periods [rad]")),
        "minimum_tilt_late": or_none(number("over the last periods [rad]")),
        "peak_tilt_late": or_none(number("over the last periods [rad]")),
        "modulation_change": or_none(number("of the modulation over the last periods")),
        "rolling_rate_error": or_none(number("of the mean rate, by the turns")),
        "peak_friction_demand": or_none(number("friction over normal force; null where nothing presses")),
        "peak_pivoting_demand": or_none(number("moment over normal force and radius")),
        "minimum_normal_force": or_none(number("over the weight")),
        **{f"time_{kind}": or_none(number(f"{kind} [s]")) for kind in _CONTACTS.values() if kind != "jammed"},
        "residual_displacement": or_none(number("of the centre of the footprint [m]")),
        "residual_displacement_x": or_none(number("[m]")),
        "residual_displacement_y": or_none(number("[m]")),
        "residual_twist": or_none(number("[rad]")),
        "walking_distance": or_none(number("length of the path of the footprint [m]")),
        "slip_distance": or_none(number("length of the path of the contact on the plane [m]")),
        "impacts": or_none(number("how often it struck the plane")),
        "slips": or_none(number("how often it began to slip")),
        "least_painleve_denominator": or_none(number("1 without friction; a contact jams at 0")),
    },
    _ANY_NUMBER,
)


def _history(about: str) -> Schema:
    return listed(about, _ANY_NUMBER)


_SERIES = table(
    "Histories, all as long as `time`; null where a number is not finite. Models may add further ones.",
    {
        "time": listed("[s]", {"type": "number"}),
        "base_acceleration": listed("along x, y, z [m/s²]", row("", 3)),
        "amplitude": _history("tilt θ [rad]"),
    },
    {
        "azimuth": _history("β, where it leans to [rad]; null where it stands upright"),
        "rolling_rate": _history("rate of the azimuth [rad/s]"),
        "spin": _history("angular velocity about the axis [rad/s]"),
        "friction_demand": _history("friction over normal force"),
        "pivoting_demand": _history("moment over normal force and radius"),
        "normal_force": _history("over the weight"),
        "contact": listed(", ".join(f"{code} {kind}" for code, kind in _CONTACTS.items()), {"enum": list(_CONTACTS)}),
        "clearance": _history("height of the lowest point above the base [m]"),
        "displacement": listed("of the centre of the footprint since the start [m]", listed("", _ANY_NUMBER)),
        "slip_speed": _history("of the contact on the plane [m/s]"),
    },
    listed("", {"anyOf": [_ANY_NUMBER, {"type": "array", "items": _ANY_NUMBER}]}),
)

_DRAWN = table(
    "The motion at equal steps in time, to be drawn: lengths in m in the frame of the base, z upwards. "
    "Null for what the model does not provide.",
    {
        "column": table(
            "The body.",
            {name: declared(one.quantity) for name, one in parameters_of(Shape).items()},
            others={},
        ),
        "plane": table("", {"incline": number("[rad]"), "incline_direction": number("[rad]")}, others={}),
        "time": listed("[s]", {"type": "number"}),
        "tilt": listed("vector θ(cos β, sin β) [rad]", row("", 2)),
        "tilt_rate": listed("its rate [rad/s]", row("", 2)),
        "twist": listed("χ, angle of turn about the axis [rad]", {"type": "number"}),
        "spin": unless_none(listed("angular velocity about the axis [rad/s]", {"type": "number"})),
        "footprint": listed("centre of the circle on the base about which the contact point lies [m]", row("", 2)),
        "contact_point": listed("[m]", row("", 2)),
        "resting": listed("1 where the whole base touches", {"enum": [0, 1]}),
        "clearance": unless_none(listed("height of the lowest point above the base [m]", {"type": "number"})),
        "base": listed("displacement of the base [m]", row("", 3)),
        "rotation": listed("unit quaternion w, x, y, z", row("", 4)),
        "centre": listed("of the bottom circle [m]", row("", 3)),
        "friction_demand": unless_none(_history("friction over normal force")),
        "friction_coefficient": or_none(number("of the contact, where it is known")),
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
        "reason": text("why it is that outcome"),
        "decided_at": number("when that was decided [s]"),
        "uncertain": flag("whether rounding error could change the outcome"),
        "planar": flag("whether it moved in one vertical plane"),
        "warnings": listed("one line each", {"type": "string"}),
        "events": listed(
            "uplifts, impacts and others", table("", {"kind": text("what happened"), "time": number("when [s]")})
        ),
        "measures": ref("Measures"),
        "summary": listed("labels and values", exactly("", text("label"), text("value"))),
        "thresholds": table("The numbers by which the outcome was decided.", {}, others=_ANY_NUMBER),
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
    "Described": table("What a description says, without a run.", {**_SNIPPETS, "column": ref("ColumnNumbers")}),
}
"""The components."""
