"""`stylobate select`: records that fit a target spectrum, with their factors."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config
from stylobate.cli.command import Positional, command
from stylobate.cli.options import Options
from stylobate.cli.output import check_place, check_writable, print_json, print_table, save_plot
from stylobate.cli.terminal import say
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.config.options import FIGURE, JSON, ONE_COMPONENT, RESPONSE, SAMPLE, STEP, UNITS, Group, Option
from stylobate.config.snippets import as_toml
from stylobate.errors import ParameterError
from stylobate.files import csv_text, write_whole, write_workbook
from stylobate.text import plural

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import xarray as xr

    from stylobate.base_motions import Record

_COLUMNS = ("record", "factor", "misfit", "chosen")
_OUTPUTS = (".toml", ".csv", ".xlsx")


@command(
    argument=Positional(
        name="sources",
        several=True,
        text="folders, archives, patterns such as 'quakes/*.AT2', files",
        metavar="SOURCE…",
    ),
    groups=(
        Group.of(
            "Target",
            Option("target", "file of the target spectrum: period [s], Sa [g]", Path),
            Option("target_units", "unit of its accelerations, if the file states none: g, m/s2", str),
            Option("target_damping", "damping ratio of the target; 0.05 by default", default=0.05),
        ),
        Group.of(
            "Selection",
            Option("number", "number of records to choose; 11 by default", int, default=11),
            Option("periods", "shortest and longest period of the fit; 0.2 to 2 s by default", tuple[float, float]),
            Option("factors", "least and largest factor of a record; 0.25 to 4 by default", tuple[float, float]),
            Option("without", "name of a record that is not to be chosen; repeat it", list[str]),
            Option("component", "horizontal component of the spectra; RotD50 by default", str, default="RotD50"),
        ),
        Group.of("Records", Option("sample_records", SAMPLE, list[str]), UNITS, STEP, ONE_COMPONENT, RESPONSE),
        Group.of(
            "Output",
            FIGURE,
            Option("output", "save as the records of a study (.toml), or as a table (.csv, .xlsx)", Path),
            JSON,
        ),
    ),
)
def select(options: Options) -> None:
    """Choose records whose spectra fit a target, and scale them.

    Each record has the factor with the least squares of the logarithms between its spectrum and the target, within
    bounds; those with the least misfit are chosen. For example:

    stylobate select PEER.zip --target design.csv --number 7 --periods 0.2 2 --figure match.png --output study.toml
    """
    figure, output = options["figure"], options["output"]
    check_writable(figure)
    if output is not None:
        if output.suffix not in _OUTPUTS:
            raise ParameterError(f"--output must end with .toml, .csv or .xlsx, got {str(output)!r}")
        check_place(output)
    if options["target"] is None:
        raise ParameterError("--target: missing. Name a file of two columns: period [s], Sa [g]")
    from stylobate.earthquakes.config.assess import DesignSpectrumConfig
    from stylobate.earthquakes.record_selection import select_records

    own = {} if options["target_units"] is None else {"units": options["target_units"]}
    described = DesignSpectrumConfig.parse(
        {"file": str(options["target"]), "damping": options["target_damping"], "name": "target", **own}
    )
    ranges = {
        name: options[flag]
        for name, flag in (("periods", "periods"), ("scales", "factors"))
        if options[flag] is not None
    }
    values: dict[str, Any] = {"source": tuple(options["sources"] or ())}
    if options["sample_records"]:
        values["samples"] = tuple(options["sample_records"])
    of_files = options.pick("units", "step", "one_component", "response") if options["sources"] else {}
    number, without, component = options["number"], options["without"] or (), options["component"]
    options.refuse_unused()
    records = config.RecordsConfig.parse(values | of_files).build()
    found = select_records(
        records.values(),
        described.build(),
        number=number,
        without=without,
        component=component,
        **ranges,
    )
    if output is not None:
        _save(output, found, records, of_files)
    if figure is not None:
        save_plot(found, figure)
    if options["as_json"]:
        print_json({**found.attrs, "records": [dict(zip(_COLUMNS, row, strict=True)) for row in _rows(found)]})
        return
    cells = [
        [name, f"{factor:.4g}", f"{misfit:.3g}", "yes" if is_in else ""] for name, factor, misfit, is_in in _rows(found)
    ]
    print_table(f"{plural(number, 'record')} of {len(cells)} chosen", cells, list(_COLUMNS))
    least, largest = found.attrs["least_ratio"], found.attrs["largest_ratio"]
    say(f"mean of the chosen spectra over the target: {least:.3g} to {largest:.3g}, {found.attrs['component']}")


def _rows(found: "xr.Dataset") -> "Iterable[tuple[str, float, float, bool]]":
    names = ("record", "scale", "misfit", "chosen")
    return zip(*(found[name].to_numpy().tolist() for name in names), strict=True)


def _save(output: Path, found: "xr.Dataset", records: "Mapping[str, Record]", reading: "Mapping[str, Any]") -> None:
    """Write the chosen records as the table [records] of a study, or the table of all."""
    header = [*_COLUMNS, *(f"Sa({period:.3g} s) [g]" for period in found["period"].to_numpy())]
    spectra = found["spectral_acceleration"].to_numpy() / STANDARD_GRAVITY
    body = [[*row, *spectrum] for row, spectrum in zip(_rows(found), spectra.tolist(), strict=True)]
    if output.suffix == ".csv":
        write_whole(output, csv_text(header, body))
    elif output.suffix == ".xlsx":
        write_workbook(output, {"selection": [header, *body]})
    else:
        folder = output.absolute().parent
        events = [_event(records[name], factor, folder) for name, factor, _, chosen in _rows(found) if chosen]
        write_whole(output, as_toml({"records": {**reading, "event": events}}))


def _event(record: "Record", factor: float, folder: Path) -> dict[str, Any]:
    """Return the description of a chosen record: its files, relative to the folder of the study, and its factor."""
    assert record.origin is not None
    reading = record.origin.reading
    if "path" not in reading:
        raise ParameterError(
            f"--output: {record.name!r} comes with the package and has no files. Write a table (.csv, .xlsx) instead"
        )
    paths = [Path(one) for one in ([reading["path"]] if isinstance(reading["path"], str) else reading["path"])]
    files = [(one.relative_to(folder) if folder in one.parents else one).as_posix() for one in paths]
    own = {"directions": reading["directions"]} if reading.get("directions") else {}
    return {"files": files, "name": record.name, "scale": factor, **own}
