"""What is answered of what there is to choose from, and of records."""

from dataclasses import fields

from stylobate.errors import Outcome
from stylobate.lab.limits import Limits
from stylobate.lab.schema.notation import Schema, flag, listed, number, or_none, ref, table, text, whole, word

_PARAMETER = table(
    "A number one can set.",
    {
        "name": text("as in descriptions"),
        "symbol": text("as in the literature; empty without one"),
        "unit": text("empty without one"),
        "about": text("what it is"),
        "default": {"description": "null without one"},
        "needed": flag("whether it must be given"),
        "varies": flag("whether maps can vary it"),
        "from": or_none(number("lower end of a slider; null where none serves all")),
        "to": or_none(number("its upper end")),
    },
    {"choices": listed("where there are few", {"type": ["integer", "string"]})},
)

_KIND = table(
    "A kind of column, model or motion.",
    {
        "kind": text("as in descriptions"),
        "name": text("in words"),
        "about": text("a line about it"),
        "parameters": listed("its numbers", _PARAMETER),
    },
    {"ends": flag("of motions: whether it comes to an end, so that a run needs no duration")},
)


def _kinds(about: str) -> Schema:
    return listed(about, ref("Kind"))


_ABOUT = table(
    "What there is to choose from.",
    {
        "version": text("of stylobate"),
        "limits": table("How much may be asked for.", {field.name: number() for field in fields(Limits)}),
        "shapes": _kinds("of columns"),
        "models": _kinds("of models"),
        "motions": _kinds("of base motions"),
        "samples": listed("records that are here", table("", {"name": text(), "about": text()})),
        "presets": listed(
            "motions worth seeing",
            table(
                "",
                {
                    "id": text(),
                    "title": text(),
                    "about": text(),
                    "description": {"type": "object", "description": "to be sent to /api/simulate"},
                    "view": {"type": "object", "description": "how the page shows it"},
                },
            ),
        ),
        "outcomes": listed(
            "the possible outcomes",
            table(
                "",
                {
                    "name": word("", [one.name for one in Outcome]),
                    "value": text("in words"),
                    "code": whole("in maps"),
                },
            ),
        ),
    },
)

_UPLOADED = table(
    "A record that is kept.",
    {
        "upload": text('its digest, for the motion {"kind": "record", "upload": …}'),
        "name": text("of the event"),
        "samples": whole("how many"),
        "step": number("between them [s]"),
        "duration": number("[s]"),
        "peaks": table("Largest accelerations [m/s²].", {}, {axis: number(f"along {axis} [m/s²]") for axis in "xyz"}),
        "provenance": listed("where it comes from, one line each", {"type": "string"}),
        "warnings": listed("what may be wrong with its files, one line each", {"type": "string"}),
    },
)

CATALOGUE = {
    "About": _ABOUT,
    "Kind": _KIND,
    "UploadedRecord": _UPLOADED,
    "Problems": table(
        "Why a request was refused.", {"problems": listed("one line each", {"type": "string"}, minItems=1)}
    ),
}
"""The components."""
