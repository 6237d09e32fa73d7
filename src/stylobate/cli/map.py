"""`stylobate map`: overturning map, the outcomes of the column over two parameters."""

from typing import TYPE_CHECKING, Any

from stylobate import config, conveying, studies
from stylobate.cli.command import command
from stylobate.cli.declarations import AXES, COMPUTING, EARLY_END, OUTPUT_OR_STORE, RECORD, run_numbers
from stylobate.cli.many_runs import check_axes, finish, run_study, study_values
from stylobate.cli.options import Options
from stylobate.cli.output import print_table
from stylobate.cli.overlay import with_axes
from stylobate.cli.parts import COLUMN, MODEL, MOTION
from stylobate.cli.saved import number_of_runs, open_saved, study_summary
from stylobate.run_arguments import SharedByRuns

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr


@command(
    argument="TOML description, or a saved map (.nc) or store (.zarr) to show or repeat",
    groups=(AXES, run_numbers(SharedByRuns), EARLY_END, COLUMN, MODEL, MOTION, RECORD, COMPUTING, OUTPUT_OR_STORE),
)
def overturning_map(options: Options) -> None:
    """Compute the overturning map over two parameters.

    Each run stays, rocks, rolls or overturns; with --model sliding it may also slide, slip or fly. A number of column,
    model, base motion or initial state varies along each axis: angular-frequency, acceleration, start-phase, damping,
    size, tilt-x … A saved map is shown; options that change it compute it again. Examples:

    stylobate map --slenderness 0.1 --damping 0.1 --motion circular --x angular-frequency 0.5 6 100
    --y acceleration 0.05 0.6 100 --periods 100 --output map.zarr --figure map.png

    stylobate map map.zarr --resume
    """
    result, complete = run_study(
        options, open_saved(options["source"]), _counted, lambda saved: _prepared(saved, options)
    )
    finish(result, options, _summary, _print, complete=complete)


def _prepared(saved: "xr.Dataset | None", options: Options) -> "tuple[Callable[..., xr.Dataset], config.Setup]":
    values = with_axes(study_values(saved, options, config.MapConfig), options, "map")
    setup = config.MapConfig.parse(values).build()
    check_axes("map", setup)
    return (conveying.contact_map if setup.model.switches else studies.overturning_map), setup


def _counted(saved: "xr.Dataset") -> "xr.Dataset":
    from stylobate.conveying.contact_maps import class_shares  # noqa: PLC0415
    from stylobate.studies.maps.overturning import outcome_shares  # noqa: PLC0415

    return class_shares(saved) if "time_flying" in saved else outcome_shares(saved)


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    outcomes = {name: {"count": count, "share": share} for name, count, share in _shares(result)}
    return study_summary(result, outcomes=outcomes, uncertain=int(result["uncertain"].sum()))


# Dimension of the counts of each kind of map.
_NAMES = {"overturning map": "outcome_name", "contact map": "class_name"}


def _shares(result: "xr.Dataset") -> list[tuple[str, int, float]]:
    table = (result[name].to_numpy() for name in (_NAMES[result.attrs["kind"]], "count", "share"))
    return [(str(name), int(count), float(share)) for name, count, share in zip(*table, strict=True)]


def _print(result: "xr.Dataset") -> None:
    from stylobate.conveying.contact_maps import knife_edge_remarks  # noqa: PLC0415  as in _counted

    rows = [(name, str(count), f"{100.0 * share:.2f} %") for name, count, share in _shares(result) if count]
    title = number_of_runs(result, f" over {' and '.join(map(str, result['outcome'].dims))}")
    uncertain = int(result["uncertain"].sum())
    remarks = [f"{uncertain} numerically uncertain: rounding could alter them"] if uncertain else []
    if result.attrs["kind"] == "contact map":
        remarks = [f"{one}, count outcomes with `upright`" for one in remarks] + knife_edge_remarks(result)
    print_table("; ".join([title, *remarks]), rows, ("outcome", "runs", "share"))
