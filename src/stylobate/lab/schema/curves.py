"""What is answered of response curves, by theory and of exact orbits."""

from stylobate.lab.schema.notation import Schema, flag, listed, number, or_none, row, table, text, word

_SENSE = word("which way it rolls, seen from above", ["anticlockwise", "clockwise"])
_FREQUENCIES = listed("[rad/s]", {"type": "number"})


def _over_frequency(about: str) -> Schema:
    return listed(f"{about}, null where there is no such rolling", {"type": ["number", "null"]})


_CURVES = table(
    "Steady rolling over frequency, by theory; all lists as long as `angular_frequency`.",
    {
        "angular_frequency": _FREQUENCIES,
        "branches": listed(
            "one for each sense and branch",
            table(
                "",
                {
                    "sense": _SENSE,
                    "branch": word("which of the two solutions", ["lower", "upper"]),
                    "amplitude": _over_frequency("tilt [rad]"),
                    "phase": _over_frequency("of the lean to the base acceleration [rad]"),
                    "stable": listed("whether it is stable", {"type": "boolean"}),
                },
            ),
        ),
        "backbone": _over_frequency("tilt of free rolling [rad]"),
        "critical": listed(
            "where the upper branch loses its stability",
            table("", {"sense": _SENSE, "angular_frequency": or_none(number("[rad/s], null where there is none"))}),
        ),
        "averaged": flag("whether the curves are approximate, by averaging, rather than exact"),
    },
)

_EXACT = table(
    "Exact periodic orbits, the result of a job `exact`.",
    {
        "families": listed(
            "orbits that go over into one another; all lists of a family are of one length",
            table(
                "",
                {
                    "name": text("which family"),
                    "angular_frequency": _FREQUENCIES,
                    "mean_tilt": listed("[rad]", {"type": "number"}),
                    "minimum_tilt": listed("[rad]", {"type": "number"}),
                    "peak_tilt": listed("[rad]", {"type": "number"}),
                    "phase": listed("[rad]", {"type": ["number", "null"]}),
                    "stable": listed("whether it is stable", {"type": "boolean"}),
                    "tilt": listed("at t = 0, along x and y [rad]", row("", 2)),
                    "tilt_rate": listed("at t = 0 [rad/s]", row("", 2)),
                },
            ),
        ),
        "bifurcations": listed(
            "where stability changes",
            table(
                "",
                {
                    "kind": text("such as Neimark-Sacker"),
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
    "Where a run begins.",
    {
        "tilt": row("along x and y [rad]", 2),
        "tilt_rate": row("[rad/s]", 2),
        "spin": number("angular velocity about the axis [rad/s]"),
        "warnings": listed("whether the start is approximate or its orbit unstable, one line each", {"type": "string"}),
    },
)

CURVES = {"ResponseCurves": _CURVES, "ExactOrbits": _EXACT, "Start": _START}
"""The components."""
