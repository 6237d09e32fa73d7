"""`stylobate records`: which files make which record, and the numbers of each."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stylobate import config, earthquakes
from stylobate.cli import options as opt
from stylobate.cli.given import Given
from stylobate.cli.output import check_place, check_writable, print_json, print_table, save_figure
from stylobate.cli.source import read_source
from stylobate.errors import FileError, ParameterError
from stylobate.files import csv_text, write_whole
from stylobate.text import plural

if TYPE_CHECKING:
    from stylobate.base_motions import Record
    from stylobate.base_motions.records.listing import ComponentRow

Sources = Annotated[
    list[str] | None,
    typer.Argument(
        help="folders, patterns such as 'quakes/*.AT2', files; or a study (.toml)",
        show_default=False,
        metavar="SOURCE…",
    ),
]
SampleRecords = Annotated[
    list[str] | None, typer.Option(help='a record that comes with the package: "el centro 1940"', show_default=False)
]
Damping = Annotated[float, typer.Option(help="damping ratio of the spectra in the figure", show_default=False)]
Output = Annotated[
    Path | None,
    typer.Option(help="save the table into this file (.csv)", rich_help_panel="Output", show_default=False),
]

_PERIODS = (0.05, 5.0, 60)
_COLUMNS = {
    "record": "record",
    "axis": "axis",
    "origin": "from",
    "samples": "samples",
    "step": "step [s]",
    "pga": "PGA [m/s²]",
    "pga_g": "PGA [g]",
    "pgv": "PGV [m/s]",
    "pgd": "PGD [m]",
    "arias": "Arias [m/s]",
    "duration_5_95": "D5-95 [s]",
    "residual_velocity": "residual velocity [m/s]",
}
_SHOWN = tuple(name for name in _COLUMNS if name not in ("origin", "pga"))


def records(
    context: typer.Context,
    sources: Sources = None,
    sample_records: SampleRecords = None,
    units: opt.Units = None,
    step: opt.TimeStep = None,
    single: opt.Single = None,
    spectral_damping: Damping = 0.05,
    figure: opt.Figure = None,
    output: Output = None,
    as_json: opt.Json = False,
) -> None:
    """List the records in a folder: which files were joined, peaks, Arias intensity, duration, residual velocity.

    Files are joined as in all commands: by record number, header or name, or as a study lists them. Examples:

    stylobate records quakes --figure quakes.png --output quakes.csv

    stylobate records 'a/RSN786*.AT2' 'b/*_NS.txt' 'b/*_EW.txt' --units g --step 0.01

    stylobate records study.toml
    """
    check_writable(figure)
    _check_table(output)
    given = Given.of(context)
    given.use("sources", "sample_records", "figure", "output", *(("spectral_damping",) if figure else ()))
    values = _values(sources or [], given)
    given.refuse_unused()
    description = config.RecordsConfig.parse(values)
    found = list(description.build().values())
    from stylobate.base_motions.records.listing import component_rows, notes_on  # noqa: PLC0415

    rows = {record.name: component_rows(record) for record in found}
    notes = [note for record in found for note in notes_on(record)]
    if output is not None:
        _save(rows, output)
    if figure is not None:
        _draw(found, spectral_damping, figure)
    if as_json:
        print_json({"records": [_summary(record, rows[record.name]) for record in found], "notes": notes})
        return
    cells = [[_written(value) for value in _row(row, _SHOWN)] for group in rows.values() for row in group]
    print_table(plural(len(found), "record"), cells, [_COLUMNS[name] for name in _SHOWN])
    for name, group in rows.items():
        print(f"{name}: {'; '.join(f'{row.axis} {row.origin}' for row in group)}")
    for note in notes:
        print(note)


def _values(sources: Sequence[str], given: Given) -> dict[str, Any]:
    """Return the plain values of a description of records, options over those of a study."""
    values = _described(sources)
    if given["sample_records"]:
        values["samples"] = tuple(given["sample_records"])
    of_files = ("units", "step", "single") if values.get("source") or values.get("event") else ()  # samples state them
    return values | {name: given[name] for name in of_files if given[name] is not None}


def _described(sources: Sequence[str]) -> dict[str, Any]:
    studies = [source for source in sources if source.endswith(".toml")]
    if not studies:
        return {"source": tuple(sources)}
    if len(sources) > 1:
        message = f"SOURCE: a study must stand alone (got {', '.join(sources)}). List its records by themselves"
        raise ParameterError(message)
    values = read_source(Path(studies[0]))
    if "records" not in values:
        message = f"{studies[0]}: the study has no records. Add a table [records], or name files"
        raise FileError(message)
    described = values["records"]
    return dict(described) if isinstance(described, Mapping) else {"source": described}


def _check_table(output: Path | None) -> None:
    if output is None:
        return
    if output.suffix != ".csv":
        message = f"--output must end with .csv, got {str(output)!r}"
        raise ParameterError(message)
    check_place(output)


def _save(rows: Mapping[str, Sequence["ComponentRow"]], output: Path) -> None:
    table = (_row(row, tuple(_COLUMNS)) for group in rows.values() for row in group)
    write_whole(output, csv_text(_COLUMNS.values(), table))


def _draw(found: Sequence["Record"], damping: float, figure: Path) -> None:
    import numpy as np  # noqa: PLC0415

    from stylobate.base_motions.records import response_spectra  # noqa: PLC0415

    moving = [record for record in found if record.axes]
    if not moving:
        message = "--figure: no record accelerates, so there is nothing to draw. Check the files"
        raise ParameterError(message)
    spectra = {record.name: response_spectra(record, np.geomspace(*_PERIODS), damping=damping) for record in moving}
    save_figure(earthquakes.plot_records(moving, spectra), figure)


def _row(row: "ComponentRow", names: Sequence[str]) -> list[Any]:
    return [getattr(row, name) for name in names]


def _summary(record: "Record", rows: Sequence["ComponentRow"]) -> dict[str, Any]:
    components = [{name: value for name, value in row._asdict().items() if name != "record"} for row in rows]
    return {"name": record.name, "components": components, "provenance": list(record.provenance)}


def _written(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
