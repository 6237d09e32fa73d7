"""What is answered of jobs: how they stand, what they find on the way, and their results."""

from stylobate.errors import Outcome
from stylobate.lab.schema.notation import (
    Schema,
    exactly,
    listed,
    number,
    or_none,
    ref,
    table,
    text,
    whole,
    word,
)

KINDS = ("exact", "map", "basin", "animation")
"""The kinds of jobs."""

_CODE: Schema = {"type": "integer"}
_NAMES = listed("codes and what they mean", exactly("", _CODE, text("what it means")))
_CODES = listed("a row for each value of x", listed("a code for each value of y", _CODE))
_SIZE = {
    "uncertain": whole("runs whose outcome rounding error could change"),
    "runs": whole("runs in all"),
}


def _share(about: str) -> Schema:
    return or_none(number(about, minimum=0.0, maximum=1.0))


_AXIS = table(
    "A quantity that varies.",
    {"name": text("as in the description"), "values": listed("in SI units", {"type": ["number", "null"]})},
    {"long_name": text("in words"), "units": text("such as rad s-1")},
)

_PLANE_BEGUN = table(
    "The first event of a map or basin: its axes, and what the codes of cells mean.",
    {"axes": table("", {"x": _AXIS, "y": _AXIS}), "names": _NAMES},
)

_CELLS = table(
    "Cells that were computed, from coarse to fine.",
    {
        "stride": whole("of all values along x and y those of so many steps are known now"),
        "cells": listed("", exactly("", whole("place along x"), whole("along y"), _CODE)),
    },
)

_MAP = table(
    "The result of a map: how often which outcome came.",
    {
        **_SIZE,
        "shares": table("Of all runs, by outcome.", {one.label: _share(f"that ended {one.label}") for one in Outcome}),
    },
)

_CONTACT_MAP = table(
    "The result of a map of a model that slides: what the column does.", {**_SIZE, "codes": _CODES, "names": _NAMES}
)

_BASIN = table(
    "The result of a basin: where each start leads.",
    {
        **_SIZE,
        "codes": _CODES,
        "names": _NAMES,
        "attractors": listed(
            "what starts lead to",
            table(
                "",
                {
                    "name": text("as in names"),
                    "kind": text("the kind of outcome"),
                    "period": whole("in periods of the base; 0 where it has none"),
                    "fraction": _share("of all starts"),
                    "fraction_low": _share("lower end of its interval"),
                    "fraction_high": _share("upper end of its interval"),
                },
            ),
        ),
    },
)

_RESULTS = ("ExactOrbits", "MapResult", "ContactMapResult", "BasinResult")

_JOB = table(
    "How a job stands.",
    {
        "id": text("by which it is asked for"),
        "kind": word("what it computes", KINDS),
        "state": word("where it stands", ["waiting", "running", "done", "failed", "cancelled"]),
        "done": whole("runs that are done"),
        "total": whole("runs in all; 0 while that is not known"),
        "note": text("a line about what goes on, such as that a kernel is compiled"),
        "events": listed(
            "what was found, from the event `after` on", {"anyOf": [ref("PlaneBegun"), ref("PlaneCells")]}
        ),
        "next": whole("what to give as `after` the next time"),
        "problems": listed("why it failed, one line each", {"type": "string"}),
        "result": {
            "description": "what it found, when it is done; null until then, and of an animation, which has a file",
            "anyOf": [*(ref(name) for name in _RESULTS), {"type": "null"}],
        },
    },
)

JOBS = {
    "Begun": table("A job that begins.", {"id": text("by which it is asked for")}),
    "Job": _JOB,
    "PlaneBegun": _PLANE_BEGUN,
    "PlaneCells": _CELLS,
    "MapResult": _MAP,
    "ContactMapResult": _CONTACT_MAP,
    "BasinResult": _BASIN,
}
"""The components."""
