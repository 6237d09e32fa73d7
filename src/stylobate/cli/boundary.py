"""`stylobate boundary`: stability boundary of steady rolling over the frequency and a second parameter."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from stylobate import config, studies
from stylobate.cli.command import command
from stylobate.cli.options import Options, overlay, read_source
from stylobate.cli.output import check_writable, deliver, print_table
from stylobate.cli.response import FREQUENCY_RANGE, plain_curves, save_curves
from stylobate.config.options import COLUMN, HORIZONTAL_MOTION, MODEL_OF_STEADY_ROLLING, OUTPUT, Option
from stylobate.errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr

_ROWS = 9


@command(
    Option(
        "bounds", "lowest and highest value of the second parameter; required", tuple[str, str], metavar="NUMBER NUMBER"
    ),
    Option(
        "parameter",
        "second parameter: acceleration (by default), amplitude-y, damping, slenderness",
        str,
        default="acceleration",
    ),
    Option(
        "at",
        "value of the second parameter at which the search begins; repeat it; five across the bounds by default",
        list[float],
    ),
    FREQUENCY_RANGE,
    argument="TOML description",
    groups=(COLUMN, MODEL_OF_STEADY_ROLLING, HORIZONTAL_MOTION, OUTPUT),
)
def boundary(options: Options) -> None:
    """Compute the stability boundary of steady rolling over two parameters.

    The parameters are the frequency of the base and a second one. The result holds curves of pitchforks, Neimark–Sacker
    points and folds, and the critical frequency of theory. Example:

    stylobate boundary --slenderness 0.1 --damping 0.1 --motion straight --acceleration 0.1
    --angular-frequency-range 0.5 6 --bounds 0.02 0.4 --figure boundary.png
    """
    from stylobate.parameter_quantities import quantity_of

    check_writable(options["figure"], options["output"])
    if options["bounds"] is None:
        name = options["parameter"]
        raise ParameterError(f"--bounds: missing. Give the lowest and the highest {name}: --bounds LOW HIGH.")
    values = overlay(read_source(options), options, config.ResponseConfig.model_fields)
    setup = config.ResponseConfig.parse(values).build()
    parameter = options["parameter"].replace("-", "_")
    # The unit of the bounds is that of the parameter.
    bounds = replace(options.declared["bounds"], type=tuple[float, float], unit=quantity_of(parameter).unit)
    arguments = {
        "parameter": parameter,
        "bounds": bounds.read(options["bounds"]),
        "angular_frequency": setup.options["range"],
        "values": options["at"] or None,
    }
    options.refuse_unused()
    result = studies.stability_boundary(setup.model, setup.motion, **arguments)
    deliver(result, options, save_curves, plain_curves, _print)


def _without_curves(result: "xr.Dataset") -> str:
    (low, high), (least, most) = result.attrs["angular_frequency_range"], result.attrs["bounds"]
    name = str(result.attrs["parameter"]).replace("_", " ")
    how = result.attrs["rolling"]
    return (
        f"no loss of stability was found: rolling is {how} wherever it was found from {low:.6g} to {high:.6g} rad/s "
        f"and {name} {least:.6g} to {most:.6g}"
    )


def _print(result: "xr.Dataset") -> None:
    parameter = str(result.attrs["parameter"])
    unit = str(result[parameter].attrs.get("units", "")).replace(" s-2", "/s²").replace(" s-1", "/s")
    labels = {1: "supercritical", 0: "subcritical", -1: ""}
    rows = []
    for index, kind in enumerate(result["curve_kind"].to_numpy()):
        part = result.isel(point=np.nonzero(result["curve"].to_numpy() == index)[0])
        shown = np.unique(np.linspace(0, part.sizes["point"] - 1, _ROWS).round().astype(int))
        rows += [
            [
                str(kind),
                f"{float(part['angular_frequency'][k]):.8g} rad/s",
                f"{float(part[parameter][k]):.6g} {unit}".strip(),
                labels[int(part["supercritical"][k])],
            ]
            for k in shown
        ]
    count = result.sizes["curve_index"]
    if not count:
        print(_without_curves(result))
        return
    title = f"{count} curve{'s' if count != 1 else ''}, a few points of each"
    print_table(title, rows, ("bifurcation", "Ω", parameter.replace("_", " "), "loss of stability"))
