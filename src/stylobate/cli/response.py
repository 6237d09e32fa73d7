"""`stylobate response`: amplitude and phase of steady rolling against frequency, from theory."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from stylobate.cli import options as opt
from stylobate.cli.output import check_writable, print_json, print_table, save_figure
from stylobate.cli.source import read_source
from stylobate.errors import FileError

if TYPE_CHECKING:
    import xarray as xr

_RANGE_NAMES = ("angular_frequency_range", "points")
_ROWS = 17

Source = Annotated[Path | None, typer.Argument(help="TOML description", show_default=False)]
Range = Annotated[tuple[float, float] | None, typer.Option(help="lowest and highest angular frequency [rad/s]")]
Points = Annotated[int | None, typer.Option(help="number of frequencies, 400 by default")]


def response(
    context: typer.Context,
    source: Source = None,
    angular_frequency_range: Range = None,
    points: Points = None,
    shape: opt.Shape = None,
    radius: opt.Radius = None,
    height: opt.Height = None,
    density: opt.Density = None,
    inner_radius: opt.InnerRadius = None,
    top_radius: opt.TopRadius = None,
    slenderness: opt.Slenderness = None,
    gravity: opt.Gravity = None,
    damping: opt.Damping = None,
    motion: opt.Motion = None,
    acceleration: opt.Acceleration = None,
    amplitude: opt.Amplitude = None,
    phase: opt.Phase = None,
    direction: opt.Direction = None,
    sense: opt.Sense = None,
    figure: opt.Figure = None,
    output: opt.Output = None,
    as_json: opt.Json = False,
) -> None:
    """Show amplitude and phase of steady rolling against the frequency of the base, with their stability.

    Exact for circular motion, averaged for straight and elliptic motion. Example:

    stylobate response --slenderness 0.1 --damping 0.1 --motion circular --acceleration 0.065
    --angular-frequency-range 0.2 4 --figure response.png
    """
    from stylobate import plots, spec, studies  # noqa: PLC0415  heavy imports wait until the options are read

    check_writable(figure, output)
    values = opt.overlay(read_source(source), context.params, _RANGE_NAMES)
    setup = spec.ResponseDescription.parse(values).build()
    low, high = setup.options["range"]
    frequencies = np.linspace(low, high, setup.options["points"])
    curves = studies.response_curves(setup.model, setup.motion, angular_frequency=frequencies)
    if output is not None:
        _save(curves, output)
    if figure is not None:
        save_figure(plots.plot(curves), figure)
    if as_json:
        print_json(_plain(curves))
    else:
        _print(curves)


def _save(curves: "xr.Dataset", path: Path) -> None:
    try:
        curves.assign(stable=curves["stable"].astype("int8")).to_netcdf(path, engine="h5netcdf")
    except OSError as error:
        message = f"cannot write {path}: {error.strerror or error}"
        raise FileError(message) from None


def _plain(curves: "xr.Dataset") -> dict[str, Any]:
    values = {name: curves[name].to_numpy().tolist() for name in (*curves.coords, *curves.data_vars)}
    return {"dims": {str(name): [str(dim) for dim in curves[name].dims] for name in curves.data_vars}} | {
        str(name): value for name, value in values.items()
    }


def _print(curves: "xr.Dataset") -> None:
    shown = np.unique(np.linspace(0, curves.sizes["angular_frequency"] - 1, _ROWS).round().astype(int))
    columns = [(sense, branch) for sense in curves["sense"].to_numpy() for branch in curves["branch"].to_numpy()]
    header = ["Ω [rad/s]", *(f"{sense}, {branch}: A [rad], ψ [rad]" for sense, branch in columns)]
    rows = []
    for index in shown:
        at = curves.isel(angular_frequency=int(index))
        cells = [_cell(at.sel(sense=sense, branch=branch)) for sense, branch in columns]
        rows.append([f"{float(at['angular_frequency']):.4f}", *cells])
    critical = ", ".join(f"{float(value):.6f} rad/s ({sense})" for sense, value in _critical(curves))
    exact = "averaged: the full motion may overturn where this is stable" if curves.attrs["averaged"] else "exact"
    print_table(f"stable where marked * ({exact}); critical frequency {critical}", rows, header)


def _critical(curves: "xr.Dataset") -> list[tuple[str, float]]:
    return list(zip(curves["sense"].to_numpy(), curves["critical_frequency"].to_numpy(), strict=True))


def _cell(at: "xr.Dataset") -> str:
    if not np.isfinite(at["amplitude"]):
        return "none"
    return f"{float(at['amplitude']):.5f} {float(at['phase']):+.4f}{' *' if bool(at['stable']) else ''}"
