"""`stylobate inventory`: many objects of one table, ranked by how probably they overturn."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stylobate import config, earthquakes, studies
from stylobate.cli.command import Positional, command
from stylobate.cli.object_tables import OBJECT_TABLE, with_object_table
from stylobate.cli.options import Options
from stylobate.cli.output import NETCDF, check_place, check_writable, print_json, save_plot
from stylobate.cli.record_sources import RECORD_SOURCES, with_record_sources
from stylobate.cli.study import executor_of, show
from stylobate.cli.terminal import INTERRUPTED, log_lines, remark, say
from stylobate.config.options import COMPUTING, FIGURE, JSON, Group, Option
from stylobate.errors import FileError, Interrupted, ParameterError, UnsupportedError
from stylobate.files import file_of

if TYPE_CHECKING:
    import xarray as xr

_TOML = ".toml"


@command(
    argument=Positional(
        text="table of objects (.csv, .xlsx, .gpkg); a study, a TOML file; or a saved inventory (.nc) to show again",
        required=True,
    ),
    groups=(
        Group.of(
            "Inventory",
            *RECORD_SOURCES,
            *OBJECT_TABLE,
            Option(
                "property_samples", "number of samples of the uncertain numbers for each record; 20 by default", int
            ),
            Option("limit_state", "limit state of the ranking: overturning (by default), 'tilt 0.5 α'", str),
            Option("seed", "seed of samples and resamples; 0 by default", int),
            Option("confidence", "confidence level of intervals; 0.95 by default"),
        ),
        COMPUTING.reduced_to("executor", "threads"),
        Group.of(
            "Output",
            Option(
                "folder", "folder of ranking, figure and numbers; NAME-inventory beside the source by default", Path
            ),
            Option("store", "store of the runs that are computed; FOLDER/store by default", Path),
            Option("output", "write the ranking into this file too (.csv, .xlsx, .gpkg)", Path),
            FIGURE,
            JSON,
        ),
    ),
)
def inventory(options: Options) -> None:
    """Rank the objects of a table by how probably they overturn.

    Each row of the table is an object: a name, the numbers of a column, their uncertainty, damping and friction
    coefficient. Other columns are carried through. A study, a TOML file, names the table, and records and hazard curve
    by site. The command writes ranking.csv, ranking.xlsx, inventory.nc and a figure, and ranking.gpkg if the objects
    have a geometry. It stores the runs of each object: after Ctrl-C the same command continues. Examples:

    stylobate inventory objects.csv --records quakes

    stylobate inventory study.toml --output ranking.xlsx
    """
    from stylobate.earthquakes.inventories.export import plain_ranking, table_of_ranking

    source, output, figure = options["source"], options["output"], options["figure"]
    file = file_of(source)
    if not file.is_file():
        raise FileError(f"cannot read {source}: No such file or directory")
    check_writable(figure)
    _check_output(output)
    if source.suffix == NETCDF:
        folder = options["folder"]
        options.refuse_unused(f"to show {source}, for which it computes nothing")
        found = _loaded(source)
    else:
        folder = options["folder"] or file.with_name(f"{file.stem}-inventory")
        found = _computed(source, folder, options)
    if folder is not None:
        _write_folder(found, folder)
    if output is not None:
        earthquakes.export_inventory(found, output)
    if figure is not None:
        save_plot(found, figure)
    if options["as_json"]:
        print_json(plain_ranking(found))
        return
    show(table_of_ranking(found))
    if folder is not None:
        say(f"ranking: {folder / 'ranking.csv'}")


def _check_output(output: Path | None) -> None:
    from stylobate.earthquakes.inventories.export import ENDINGS

    if output is None:
        return
    if output.suffix not in ENDINGS:
        raise ParameterError(f"--output: must end with {', '.join(ENDINGS)} (got {str(output)!r}). Rename it.")
    check_place(output)


def _loaded(source: Path) -> "xr.Dataset":
    found: Any = studies.load(source)
    if getattr(found, "attrs", {}).get("kind") != "inventory":
        raise FileError(f"{source}: no saved inventory. Name a file such as NAME-inventory/inventory.nc.")
    return found  # type: ignore[no-any-return]  # an inventory is a Dataset


def _computed(source: Path, folder: Path, options: Options) -> "xr.Dataset":
    store, executor = options["store"] or folder / "store", executor_of(options)
    description = earthquakes.InventoryConfig.parse(_values(source, options))
    options.refuse_unused()
    setup = description.build()
    check_place(folder / "ranking.csv" if folder.exists() else folder)
    remark(f"writing into {folder}")
    try:
        with log_lines(quiet=0.0):
            return earthquakes.inventory(setup.objects, setup.sites, **setup.options, store=store, executor=executor)
    except (Interrupted, KeyboardInterrupt):
        remark(f"computed objects are kept in {store}; the same command continues")
        raise click.exceptions.Exit(INTERRUPTED) from None


_RENAMED = {"property_samples": "samples"}


def _values(source: Path, options: Options) -> dict[str, Any]:
    """Return the values of a study, or of a table; options override them."""
    values = config.read_config(source) if source.suffix == _TOML else {"objects": str(source)}
    stated = options.pick("property_samples", "limit_state", "seed", "confidence")
    values |= {_RENAMED.get(name, name): value for name, value in stated.items()}
    return with_object_table(with_record_sources(values, options), options)


def _write_folder(found: "xr.Dataset", folder: Path) -> None:
    """Write ranking, numbers and figure; without a package for workbooks or GeoPackages, those are left out."""
    from stylobate.results.storage import write_netcdf

    folder.mkdir(parents=True, exist_ok=True)
    write_netcdf(found, folder / "inventory.nc")
    for ending in (".csv", ".xlsx", *((".gpkg",) if "geometry" in found else ())):
        try:
            earthquakes.export_inventory(found, folder / f"ranking{ending}")
        except UnsupportedError as error:
            remark(str(error))
    save_plot(found, folder / "ranking.png")
