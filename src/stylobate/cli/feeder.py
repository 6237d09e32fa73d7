"""`stylobate feeder`: the sheet of a feeder, the numbers of one part on one vibration."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, conveying
from stylobate.cli.command import command
from stylobate.cli.options import Options
from stylobate.cli.output import NETCDF, check_place, print_json, print_table
from stylobate.cli.study import executor_of, study_values, with_own_options
from stylobate.config.options import (
    COLUMN,
    COMPUTING,
    JSON,
    MOTION_WITHOUT_RECORDS,
    SLIDING,
    Group,
    Option,
    run_numbers,
)
from stylobate.config.study import own_options, study_of
from stylobate.errors import FileError, ParameterError
from stylobate.files import csv_text, write_whole
from stylobate.run_arguments import SharedByRuns

if TYPE_CHECKING:
    import xarray as xr

_KIND, _CSV = "feeder sheet", ".csv"


@command(
    *own_options(conveying.upright).values(),
    argument="TOML description, as of `stylobate upright`, or a saved sheet (.nc) to show",
    groups=(
        run_numbers(SharedByRuns).without("duration", "tilt"),
        COLUMN,
        SLIDING,
        MOTION_WITHOUT_RECORDS,
        COMPUTING.without("resume"),
        Group.of("Output", Option("output", "save the sheet (.nc), or its table (.csv)", Path), JSON),
    ),
)
def feeder(options: Options) -> None:
    """Compute the sheet of a feeder: hops, speed, steepest track and posture of a part.

    The sheet has the machine number K, the throw number, the longest hop, the speed with its interval from a flat start
    and from tilted ones, the critical friction coefficient, the shares of parts that stay upright, rock and fall, and
    the steepest track that conveys a part upwards that stays upright, with its posture there. Examples:

    stylobate feeder --radius 30mm --height 200mm --density 884 --friction-coefficient 0.2 --motion stroke
    --stroke 1.2mm --frequency 50Hz --angle 25deg --output sheet.csv

    stylobate feeder feeder.toml --friction 0.2 --friction 0.3 --json
    """
    source, output = options["source"], options["output"]
    if output is not None:
        if output.suffix not in (NETCDF, _CSV):
            raise ParameterError(f"--output must end with {NETCDF} or {_CSV}, got {str(output)!r}")
        check_place(output)
    result = _shown(source, options) if source is not None and source.suffix == NETCDF else _computed(options)
    if output is not None:
        _save(result, output)
    if options["as_json"]:
        print_json(_summary(result))
    else:
        rows = conveying.sheet_rows(result)
        print_table("feeder", [[label, *values] for label, values in rows])


def _shown(source: Path, options: Options) -> "xr.Dataset":
    from stylobate.results.storage import read_dataset

    options.refuse_unused(f"to show {source}, for which it computes nothing")
    saved = read_dataset(source)
    if saved.attrs.get("kind") != _KIND:
        raise FileError(f"{source}: no feeder sheet (got a {saved.attrs.get('kind')}).")
    return saved


def _computed(options: Options) -> "xr.Dataset":
    kind = config.study_config(conveying.upright)
    values = study_values(None, options, kind, study_of(conveying.upright).usual)
    with_own_options(values, conveying.upright, options)
    setup = kind.parse(values).build()
    executor = executor_of(options)
    options.refuse_unused()
    return conveying.sheet(setup.model, setup.motion, **setup.options, executor=executor)


def _save(result: "xr.Dataset", output: Path) -> None:
    if output.suffix == _CSV:
        write_whole(output, csv_text((), ([label, *values] for label, values in conveying.sheet_rows(result))))
        return
    from stylobate.results.storage import write_netcdf

    write_netcdf(result, output)


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    return {
        "kind": _KIND,
        **{str(name): one.to_numpy().tolist() for name, one in result.data_vars.items()},
        "friction": result["friction"].to_numpy().tolist(),
        "posture_name": result["posture_name"].to_numpy().tolist(),
        "confidence": result.attrs["confidence"],
    }
