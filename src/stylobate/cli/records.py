"""`stylobate records`: files, components and intensities of ground-motion records."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, earthquakes
from stylobate.cli.command import Positional, command
from stylobate.cli.options import Options, read_source
from stylobate.cli.output import check_place, check_writable, print_json, print_table, save_figure
from stylobate.cli.terminal import say
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.config.options import FIGURE, JSON, ONE_COMPONENT, RESPONSE, SAMPLE, STEP, UNITS, Group, Option
from stylobate.errors import FileError, ParameterError, require_positive
from stylobate.files import csv_text, write_whole, write_workbook
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.text import plural

if TYPE_CHECKING:
    from stylobate.base_motions import Record
    from stylobate.records.intensities import ComponentRow
    from stylobate.records.intensity_table import HorizontalRow

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
_HORIZONTAL = {
    "record": "record",
    "pga_rotd50": "PGA RotD50 [g]",
    "pga_rotd100": "PGA RotD100 [g]",
    "pgv_rotd50": "PGV RotD50 [m/s]",
    "pgv_rotd100": "PGV RotD100 [m/s]",
    "sa_rotd50": "Sa({period:g} s) RotD50 [g]",
    "sa_rotd100": "Sa({period:g} s) RotD100 [g]",
    "cav": "CAV [m/s]",
    "arias": "Arias [m/s]",
    "duration_5_95": "D5-95 [s]",
    "fiv3": "FIV3({period:g} s) [m/s]",
}
_IN_G = ("pga_rotd50", "pga_rotd100", "sa_rotd50", "sa_rotd100")
_TABLES = (".csv", ".xlsx")


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
            RESPONSE,
            Option("period", "natural period of Sa and FIV3; 1 s by default", default=1.0, unit="s"),
            Option(
                "spectral_damping", "damping ratio of Sa, and of spectra in the figure; 0.05 by default", default=0.05
            ),
        ),
        Group.of("Output", FIGURE, Option("output", "save the tables into this file (.csv, .xlsx)", Path), JSON),
    ),
)
def records(options: Options) -> None:
    """List ground-motion records, their components and their intensities.

    The components of an event are joined as in all commands: by record number, header or name, or as a study lists
    them. The first table holds peaks, Arias intensity, significant duration and residual velocity of each component.
    The second holds measures of the horizontal motion: median (RotD50) and maximum (RotD100) over its directions; CAV,
    Arias intensity, duration and FIV3 are medians. Archives, workbooks and waveform files are read like folders. For
    example:

    stylobate records quakes --figure quakes.png --output quakes.csv

    stylobate records PEER.zip --period 0.5 --output quakes.xlsx

    stylobate records event.mseed --response station.xml

    stylobate records 'a/RSN786*.AT2' 'b/*_NS.txt' 'b/*_EW.txt' --units g --step 0.01

    stylobate records study.toml
    """
    figure, output, period = options["figure"], options["output"], require_positive("--period", options["period"], "s")
    check_writable(figure)
    _check_table(output)
    damping = options["spectral_damping"]
    values = _values(options["sources"] or [], options)
    options.refuse_unused()
    listed = list(config.RecordsConfig.parse(values).build().values())
    from stylobate.records.intensities import component_rows, notes_on

    rows = {record.name: component_rows(record) for record in listed}
    horizontal = {one.record: one._asdict() for one in _horizontal(listed, period, damping)}
    if figure is not None:
        _draw(listed, damping, figure)
    notes = [note for record in listed for note in notes_on(record)]
    if output is not None:
        _save(output, rows, horizontal.values(), period)
    if options["as_json"]:
        summaries = [
            {**_summary(record, rows[record.name]), "horizontal": horizontal.get(record.name)} for record in listed
        ]
        print_json({"records": summaries, "period": period, "notes": notes})
        return
    cells = [[_written(value) for value in _row(row, _SHOWN)] for group in rows.values() for row in group]
    print_table(plural(len(listed), "record"), cells, [_COLUMNS[name] for name in _SHOWN])
    if horizontal:
        lines = [[_written(value) for value in _in_g(one)] for one in horizontal.values()]
        print_table("horizontal motion", lines, _horizontal_header(period))
    for name, group in rows.items():
        say(f"{name}: {'; '.join(f'{row.axis} {row.origin}' for row in group)}")
    for note in notes:
        say(note)


def _values(sources: Sequence[str], options: Options) -> dict[str, Any]:
    """Return the plain values of a description of records; options override the values of a study."""
    values = _described(sources, options)
    if options["sample_records"]:
        values["samples"] = tuple(options["sample_records"])
    # Samples state these numbers.
    of_files = ("units", "step", "one_component", "response") if values.get("source") or values.get("event") else ()
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
    if output.suffix not in _TABLES:
        raise ParameterError(f"--output must end with .csv or .xlsx, got {str(output)!r}")
    check_place(output)


@shows_progress("horizontal measures")
def _horizontal(
    listed: Iterable["Record"], period: float, damping: float, progress: Progress = None
) -> list["HorizontalRow"]:
    """Return the measures of the records that move horizontally."""
    from stylobate.records.intensity_table import horizontal_row

    moving = [record for record in listed if set(record.axes) & {"x", "y"}]
    rows, report = [], report_of(progress)
    for done, record in enumerate(moving, start=1):
        rows.append(horizontal_row(record, period, damping))
        report(done, len(moving))
    return rows


def _horizontal_header(period: float) -> list[str]:
    return [name.format(period=period) for name in _HORIZONTAL.values()]


def _in_g(row: Mapping[str, Any]) -> list[Any]:
    return [row[name] / STANDARD_GRAVITY if name in _IN_G else row[name] for name in _HORIZONTAL]


def _save(
    output: Path,
    rows: Mapping[str, Sequence["ComponentRow"]],
    horizontal: Iterable[Mapping[str, Any]],
    period: float,
) -> None:
    """Write the tables: two sheets of a workbook, or two CSV files, the second with -horizontal in its name."""
    components = [_row(row, tuple(_COLUMNS)) for group in rows.values() for row in group]
    tables = {
        "components": [list(_COLUMNS.values()), *components],
        "horizontal": [_horizontal_header(period), *map(_in_g, horizontal)],
    }
    if output.suffix == ".xlsx":
        write_workbook(output, tables)
        return
    for name, (header, *body) in tables.items():
        path = output if name == "components" else output.with_stem(f"{output.stem}-{name}")
        write_whole(path, csv_text(header, body))


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
