"""Schemas of the options, of uploaded records and of refusals."""

from dataclasses import fields

from stylobate.errors import Outcome
from stylobate.lab.limits import Limits
from stylobate.lab.schema.notation import Schema, flag, listed, number, or_none, ref, table, text, whole, word

_PARAMETER = table(
    "A parameter.",
    {
        "name": text("name as in descriptions"),
        "symbol": text("symbol in the literature; empty if there is none"),
        "unit": text("unit; empty if there is none"),
        "about": text("one-line description"),
        "default": {"description": "default value; null if there is none"},
        "needed": flag("whether the parameter is required"),
        "varies": flag("whether maps can vary the parameter"),
        "from": or_none(number("lower end of the slider; null if no range suits all cases")),
        "to": or_none(number("upper end of the slider")),
    },
    {"choices": listed("possible values, if there are few", {"type": ["integer", "string"]})},
)

_KIND = table(
    "A kind of column, model or motion.",
    {
        "kind": text("kind as in descriptions"),
        "name": text("name in words"),
        "about": text("one-line description"),
        "parameters": listed("parameters", _PARAMETER),
    },
    {"ends": flag("for motions: whether the motion ends, so that a run needs no duration")},
)


def _kinds(about: str) -> Schema:
    return listed(about, ref("Kind"))


_ABOUT = table(
    "Options of the laboratory.",
    {
        "version": text("version of stylobate"),
        "limits": table("Limits on requests.", {field.name: number() for field in fields(Limits)}),
        "shapes": _kinds("kinds of columns"),
        "models": _kinds("kinds of models"),
        "motions": _kinds("kinds of base motions"),
        "samples": listed("sample records", table("", {"name": text(), "about": text()})),
        "presets": listed(
            "example motions",
            table(
                "",
                {
                    "id": text(),
                    "title": text(),
                    "about": text(),
                    "description": {"type": "object", "description": "body for /api/simulate"},
                    "view": {"type": "object", "description": "view on the page"},
                },
            ),
        ),
        "outcomes": listed(
            "the possible outcomes",
            table(
                "",
                {
                    "name": word("", [one.name for one in Outcome]),
                    "value": text("outcome in words"),
                    "code": whole("code in maps"),
                },
            ),
        ),
    },
)

_UPLOADED = table(
    "An uploaded record.",
    {
        "upload": text('digest, for the motion {"kind": "record", "upload": …}'),
        "name": text("name of the event"),
        "samples": whole("number of samples"),
        "step": number("time step [s]"),
        "duration": number("duration [s]"),
        "peaks": table("Peak accelerations [m/s²].", {}, {axis: number(f"along {axis} [m/s²]") for axis in "xyz"}),
        "provenance": listed("origin, one line each", {"type": "string"}),
        "warnings": listed("possible mistakes in its files, one line each", {"type": "string"}),
    },
)

CATALOGUE = {
    "About": _ABOUT,
    "Kind": _KIND,
    "UploadedRecord": _UPLOADED,
    "Problems": table(
        "Reasons for the refusal of a request.", {"problems": listed("one line each", {"type": "string"}, minItems=1)}
    ),
}
"""Components of the OpenAPI document."""
