"""Schemas of response curves, from theory and from exact orbits, and of initial conditions on them."""

from stylobate.lab.schema.notation import Schema, flag, listed, number, or_none, row, table, text, word

_SENSE = word("sense of rolling, seen from above", ["anticlockwise", "clockwise"])
_FREQUENCIES = listed("[rad/s]", {"type": "number"})


def _over_frequency(about: str) -> Schema:
    return listed(f"{about}, null if there is no such rolling", {"type": ["number", "null"]})


_CURVES = table(
    "Steady rolling over frequency, from theory; all lists are as long as `angular_frequency`.",
    {
        "angular_frequency": _FREQUENCIES,
        "branches": listed(
            "one for each sense and branch",
            table(
                "",
                {
                    "sense": _SENSE,
                    "branch": word("one of the two solutions", ["lower", "upper"]),
                    "amplitude": _over_frequency("tilt [rad]"),
                    "phase": _over_frequency("phase of the lean relative to the base acceleration [rad]"),
                    "stable": listed("whether the motion is stable", {"type": "boolean"}),
                },
            ),
        ),
        "backbone": _over_frequency("tilt of free rolling [rad]"),
        "critical": listed(
            "frequencies at which the upper branch loses its stability",
            table("", {"sense": _SENSE, "angular_frequency": or_none(number("[rad/s], null if there is none"))}),
        ),
        "averaged": flag("whether the curves are approximate (averaging) rather than exact"),
    },
)

_EXACT = table(
    "Exact periodic orbits, the result of a job `exact`.",
    {
        "families": listed(
            "families of orbits; all lists of a family have the same length",
            table(
                "",
                {
                    "name": text("name of the family"),
                    "angular_frequency": _FREQUENCIES,
                    "mean_tilt": listed("[rad]", {"type": "number"}),
                    "minimum_tilt": listed("[rad]", {"type": "number"}),
                    "peak_tilt": listed("[rad]", {"type": "number"}),
                    "phase": listed("[rad]", {"type": ["number", "null"]}),
                    "stable": listed("whether the motion is stable", {"type": "boolean"}),
                    "tilt": listed("tilt at t = 0, along x and y [rad]", row("", 2)),
                    "tilt_rate": listed("tilt rate at t = 0 [rad/s]", row("", 2)),
                },
            ),
        ),
        "bifurcations": listed(
            "bifurcations of the family",
            table(
                "",
                {
                    "kind": text("kind, such as Neimark-Sacker"),
                    "angular_frequency": number("[rad/s]"),
                    "mean_tilt": number("[rad]"),
                    "supercritical": {
                        "type": ["boolean", "null"],
                        "description": "whether it is supercritical; null if undecided",
                    },
                },
            ),
        ),
    },
)

_START = table(
    "Initial conditions of a run.",
    {
        "tilt": row("tilt along x and y [rad]", 2),
        "tilt_rate": row("[rad/s]", 2),
        "spin": number("angular velocity about the axis [rad/s]"),
        "warnings": listed("one line if the start is approximate, or its orbit unstable", {"type": "string"}),
    },
)

CURVES = {"ResponseCurves": _CURVES, "ExactOrbits": _EXACT, "Start": _START}
"""Components of the OpenAPI document."""
