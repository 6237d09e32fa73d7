"""`stylobate records`: files, components and intensities of ground-motion records."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, earthquakes
from stylobate.cli.command import Positional, command
from stylobate.cli.options import Options, read_source
from stylobate.cli.output import check_place, check_writable, print_json, print_table, save_figure
from stylobate.config.options import FIGURE, JSON, ONE_COMPONENT, SAMPLE, STEP, UNITS, Group, Option
from stylobate.errors import FileError, ParameterError
from stylobate.files import csv_text, write_whole
from stylobate.text import plural

if TYPE_CHECKING:
    from stylobate.base_motions import Record
    from stylobate.records.intensities import ComponentRow

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


@command(
    argument=Positional(
        name="sources",
        several=True,
        text="folders, patterns such as 'quakes/*.AT2', files; or a study (.toml)",
        metavar="SOURCE…",
    ),
    groups=(
        Group.of(
            "Records",
            Option("sample_records", SAMPLE, list[str]),
            UNITS,
            STEP,
            ONE_COMPONENT,
            Option("spectral_damping", "damping ratio of the spectra in the figure; 0.05 by default", default=0.05),
        ),
        Group.of("Output", FIGURE, Option("output", "save the table into this file (.csv)", Path), JSON),
    ),
)
def records(options: Options) -> None:
    """List ground-motion records, their components and their intensities.

    The components of an event are joined as in all commands: by record number, header or name, or as a study lists
    them. The table holds peaks, Arias intensity, significant duration and residual velocity. Examples:

    stylobate records quakes --figure quakes.png --output quakes.csv

    stylobate records 'a/RSN786*.AT2' 'b/*_NS.txt' 'b/*_EW.txt' --units g --step 0.01

    stylobate records study.toml
    """
    figure, output = options["figure"], options["output"]
    check_writable(figure)
    _check_table(output)
    if figure is not None:
        options.use("spectral_damping")
    values = _values(options["sources"] or [], options)
    options.refuse_unused()
    listed = list(config.RecordsConfig.parse(values).build().values())
    from stylobate.records.intensities import component_rows, notes_on

    rows = {record.name: component_rows(record) for record in listed}
    notes = [note for record in listed for note in notes_on(record)]
    if output is not None:
        _save(rows, output)
    if figure is not None:
        _draw(listed, options["spectral_damping"], figure)
    if options["as_json"]:
        print_json({"records": [_summary(record, rows[record.name]) for record in listed], "notes": notes})
        return
    cells = [[_written(value) for value in _row(row, _SHOWN)] for group in rows.values() for row in group]
    print_table(plural(len(listed), "record"), cells, [_COLUMNS[name] for name in _SHOWN])
    for name, group in rows.items():
        print(f"{name}: {'; '.join(f'{row.axis} {row.origin}' for row in group)}")
    for note in notes:
        print(note)


def _values(sources: Sequence[str], options: Options) -> dict[str, Any]:
    """Return the plain values of a description of records; options override the values of a study."""
    values = _described(sources, options)
    if options["sample_records"]:
        values["samples"] = tuple(options["sample_records"])
    # Samples state these numbers.
    of_files = ("units", "step", "one_component") if values.get("source") or values.get("event") else ()
    return values | options.pick(*of_files)


def _described(sources: Sequence[str], options: Options) -> dict[str, Any]:
    studies = [source for source in sources if source.endswith(".toml")]
    if not studies:
        return {"source": tuple(sources)}
    if len(sources) > 1:
        raise ParameterError(
            f"SOURCE: a study must stand alone (got {', '.join(sources)}). List its records by themselves"
        )
    values = read_source(options, Path(studies[0]))
    if "records" not in values:
        raise FileError(f"{studies[0]}: the study has no records. Add a table [records], or name files")
    described = values["records"]
    return dict(described) if isinstance(described, Mapping) else {"source": described}


def _check_table(output: Path | None) -> None:
    if output is None:
        return
    if output.suffix != ".csv":
        raise ParameterError(f"--output must end with .csv, got {str(output)!r}")
    check_place(output)


def _save(rows: Mapping[str, Sequence["ComponentRow"]], output: Path) -> None:
    table = (_row(row, tuple(_COLUMNS)) for group in rows.values() for row in group)
    write_whole(output, csv_text(_COLUMNS.values(), table))


def _draw(listed: Sequence["Record"], damping: float, figure: Path) -> None:
    import numpy as np

    from stylobate.records import response_spectra

    moving = [record for record in listed if record.axes]
    if not moving:
        raise ParameterError("--figure: no record accelerates, so there is nothing to draw. Check the files")
    spectra = {record.name: response_spectra(record, np.geomspace(*_PERIODS), damping=damping) for record in moving}
    save_figure(earthquakes.plot_records(moving, spectra), figure)


def _row(row: "ComponentRow", names: Sequence[str]) -> list[Any]:
    return [getattr(row, name) for name in names]


def _summary(record: "Record", rows: Sequence["ComponentRow"]) -> dict[str, Any]:
    components = [{name: value for name, value in row._asdict().items() if name != "record"} for row in rows]
    return {"name": record.name, "components": components, "provenance": list(record.provenance)}


def _written(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
