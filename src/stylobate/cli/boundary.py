"""`stylobate boundary`: where rolling loses its stability, over the frequency and a second parameter."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from stylobate import config, plots, studies
from stylobate.cli import options as opt
from stylobate.cli.given import Given
from stylobate.cli.output import check_writable, print_json, print_table, save_figure
from stylobate.cli.response import plain_curves, save_curves
from stylobate.cli.source import read_source
from stylobate.errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr

_ROWS = 9

Source = Annotated[Path | None, typer.Argument(help="TOML description", show_default=False)]
Frequencies = Annotated[tuple[float, float] | None, typer.Option(help="lowest and highest angular frequency [rad/s]")]
Parameter = Annotated[str, typer.Option(help="second parameter: acceleration, amplitude-y, damping, slenderness …")]
Bounds = Annotated[
    tuple[float, float] | None, typer.Option(help="its lowest and highest value, SI; needed", show_default=False)
]
Exactly = Annotated[
    list[float] | None,
    typer.Option("--at", help="value of it at which rolling is looked at first; repeat it, five across by default"),
]


def boundary(
    context: typer.Context,
    source: Source = None,
    bounds: Bounds = None,
    parameter: Parameter = "acceleration",
    at: Exactly = None,
    angular_frequency_range: Frequencies = None,
    shape: opt.Shape = None,
    radius: opt.Radius = None,
    height: opt.Height = None,
    density: opt.Density = None,
    inner_radius: opt.InnerRadius = None,
    top_radius: opt.TopRadius = None,
    slenderness: opt.Slenderness = None,
    gravity: opt.Gravity = None,
    model: opt.Model = None,
    damping: opt.Damping = None,
    spin_damping: opt.SpinDamping = None,
    rolling_resistance: opt.RollingResistance = None,
    restitution: opt.Restitution = None,
    constraint: opt.Constraint = None,
    passage_tilt: opt.PassageTilt = None,
    motion: opt.HarmonicMotion = None,
    acceleration: opt.Acceleration = None,
    amplitude: opt.Amplitude = None,
    phase: opt.Phase = None,
    direction: opt.Direction = None,
    sense: opt.Sense = None,
    figure: opt.Figure = None,
    output: opt.Output = None,
    as_json: opt.Json = False,
) -> None:
    """Show where exact rolling loses its stability, over the frequency of the base and a second parameter.

    Curves of pitchforks, Neimark–Sacker points and folds, beside the critical frequency of theory. Example:

    stylobate boundary --slenderness 0.1 --damping 0.1 --motion straight --acceleration 0.1
    --angular-frequency-range 0.5 6 --bounds 0.02 0.4 --figure boundary.png
    """
    given = Given.of(context)
    check_writable(given["figure"], given["output"])
    if bounds is None:
        message = f"--bounds: missing. Give the lowest and the highest {parameter}: --bounds LOW HIGH."
        raise ParameterError(message)
    values = opt.overlay(read_source(source), given, config.ResponseConfig.model_fields)
    setup = config.ResponseConfig.parse(values).build()
    options = {
        "parameter": given["parameter"].replace("-", "_"),
        "bounds": given["bounds"],
        "angular_frequency": setup.options["range"],
        "values": given["at"] or None,
    }
    given.refuse_unused()
    found = studies.stability_boundary(setup.model, setup.motion, **options)
    if output is not None:
        save_curves(found, output)
    if figure is not None:
        save_figure(plots.plot(found), figure)
    if as_json:
        print_json(plain_curves(found))
    else:
        _print(found)


def _without_curves(found: "xr.Dataset") -> str:
    (low, high), (least, most) = found.attrs["angular_frequency_range"], found.attrs["bounds"]
    name = str(found.attrs["parameter"]).replace("_", " ")
    how = found.attrs["rolling"]
    return (
        f"no loss of stability was found: rolling is {how} wherever it was found from {low:.6g} to {high:.6g} rad/s "
        f"and {name} {least:.6g} to {most:.6g}"
    )


def _print(found: "xr.Dataset") -> None:
    parameter = str(found.attrs["parameter"])
    unit = str(found[parameter].attrs.get("units", "")).replace(" s-2", "/s²").replace(" s-1", "/s")
    softness = {1: "soft", 0: "hard", -1: ""}
    rows = []
    for index, kind in enumerate(found["curve_kind"].to_numpy()):
        part = found.isel(point=np.nonzero(found["curve"].to_numpy() == index)[0])
        shown = np.unique(np.linspace(0, part.sizes["point"] - 1, _ROWS).round().astype(int))
        rows += [
            [
                str(kind),
                f"{float(part['angular_frequency'][k]):.8g} rad/s",
                f"{float(part[parameter][k]):.6g} {unit}".strip(),
                softness[int(part["soft"][k])],
            ]
            for k in shown
        ]
    count = found.sizes["curve_index"]
    if not count:
        print(_without_curves(found))
        return
    title = f"{count} curve{'s' if count != 1 else ''}, a few points of each"
    print_table(title, rows, ("bifurcation", "Ω", parameter.replace("_", " "), "loss of stability"))
