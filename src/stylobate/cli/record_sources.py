"""Options of commands that name the records of a study, in place of those of its description."""

from collections.abc import Mapping
from typing import Any

from stylobate.cli.options import Options
from stylobate.config.options import ONE_COMPONENT, SAMPLE, STEP, UNITS, Option

RECORD_SOURCES = (
    Option("records", "folder of records, pattern such as 'quakes/*.AT2', or file; repeat it", list[str]),
    Option("sample_records", SAMPLE, list[str]),
    UNITS,
    STEP,
    ONE_COMPONENT,
)
"""Options that name records."""

_SOURCES = ("source", "event", "samples", "only")


def with_record_sources(values: Mapping[str, Any], options: Options) -> dict[str, Any]:
    """Return the values of a study with the records that options name; options override the description."""
    records = values.get("records")
    table: dict[str, Any] = dict(records) if isinstance(records, Mapping) else {"source": records} if records else {}
    if options["records"] or options["sample_records"]:
        table = {name: value for name, value in table.items() if name not in _SOURCES}
        table |= {"source": tuple(options["records"])} if options["records"] else {}
        table |= {"samples": tuple(options["sample_records"])} if options["sample_records"] else {}
    if table.get("source") or table.get("event"):  # samples state their units
        table |= options.pick("units", "step", "one_component")
    return {**values, "records": table} if table else dict(values)
