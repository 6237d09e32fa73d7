"""`stylobate response` and `stylobate boundary`: steady rolling against frequency, and where it loses its stability."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate import config, studies
from stylobate.cli.command import command
from stylobate.cli.options import Options, overlay, read_source
from stylobate.cli.output import check_writable, deliver, print_table
from stylobate.config.options import COLUMN, HORIZONTAL_MOTION, MODEL_OF_STEADY_ROLLING, OUTPUT, Option
from stylobate.errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr

_ROWS = 17

FREQUENCY_RANGE = Option(
    "angular_frequency_range", "lowest and highest angular frequency", tuple[float, float], unit="rad/s"
)


@command(
    FREQUENCY_RANGE,
    Option("points", "number of frequencies; 400 by default", int),
    Option("exact", "exact periodic orbits and bifurcations, no theory", bool, default=False),
    argument="TOML description",
    groups=(COLUMN, MODEL_OF_STEADY_ROLLING, HORIZONTAL_MOTION, OUTPUT),
)
def response(options: Options) -> None:
    """Compute amplitude and phase of steady rolling against frequency.

    Theory is exact for circular motion and averaged for straight and elliptic motion. With --exact, periodic orbits
    and their bifurcations are computed instead. Examples:

    stylobate response --slenderness 0.1 --damping 0.1 --motion circular --acceleration 0.065
    --angular-frequency-range 0.2 4 --figure response.png

    stylobate response --exact --slenderness 0.1 --damping 0.1 --motion straight --acceleration 0.13
    --angular-frequency-range 0.8 8 --figure exact.png
    """
    check_writable(options["figure"], options["output"])
    exact = options["exact"]
    if exact and options["points"] is not None:
        raise ParameterError(
            f"--points: --exact chooses its own frequencies (got {options['points']}). Remove one of them."
        )
    values = overlay(read_source(options), options, config.ResponseConfig.model_fields)
    setup = config.ResponseConfig.parse(values).build()
    options.refuse_unused()
    low, high = setup.options["range"]
    if exact:
        curves = studies.exact_response(setup.model, setup.motion, angular_frequency=(low, high))
    else:
        frequencies = np.linspace(low, high, setup.options["points"])
        curves = studies.response_curves(setup.model, setup.motion, angular_frequency=frequencies)
    deliver(curves, options, save_curves, plain_curves, _print_exact if exact else _print)


def _print_exact(curves: "xr.Dataset") -> None:
    from stylobate.plots.orbits import stability_of

    names = curves["branch_name"].to_numpy()
    rows = [
        [str(kind), f"{float(at):.9g} rad/s", str(names[branch]), f"{float(tilt):.6g} rad", _LABELS[int(supercritical)]]
        for kind, at, branch, tilt, supercritical in zip(
            *(
                curves[f"bifurcation_{name}"].to_numpy()
                for name in ("kind", "angular_frequency", "branch", "mean_tilt", "supercritical")
            ),
            strict=True,
        )
    ]
    print_table(
        f"{curves.sizes['point']} exact orbits on {len(names)} branches; their bifurcations",
        rows,
        ("bifurcation", "Ω", "branch", "mean tilt", "loss of stability"),
    )
    print_table(f"where orbits are {stability_of(curves)}", _stable_ranges(curves), ("branch", "Ω", "mean tilt"))


_LABELS = {1: "supercritical", 0: "subcritical", -1: ""}


def _stable_ranges(curves: "xr.Dataset") -> list[list[str]]:
    """Return the intervals of each branch with stable orbits, from one bounding point to the other."""
    rows = []
    for index, name in enumerate(curves["branch_name"].to_numpy()):
        part = curves.isel(point=np.nonzero(curves["branch"].to_numpy() == index)[0])
        stable = part["stable"].to_numpy()
        edges = np.flatnonzero(np.diff(np.concatenate([[False], stable, [False]]).astype(int)))
        for first, last in zip(edges[::2], edges[1::2] - 1, strict=True):
            # The points next to an interval are the bifurcations that bound it.
            low, high = max(first - 1, 0), min(last + 1, stable.size - 1)
            ends = sorted(float(part["angular_frequency"][k]) for k in (low, high))
            tilts = sorted(float(part["mean_tilt"][k]) for k in (low, high))
            rows.append([str(name), f"{ends[0]:.6g} to {ends[1]:.6g} rad/s", f"{tilts[0]:.5g} to {tilts[1]:.5g} rad"])
    return rows


def save_curves(curves: "xr.Dataset", path: Path) -> None:
    """Write curves to a netCDF file; truth values become integers."""
    from stylobate.results import write_netcdf

    flags = {name: data.astype("int8") for name, data in curves.data_vars.items() if data.dtype == bool}
    write_netcdf(curves.assign(flags), path)


def plain_curves(curves: "xr.Dataset") -> dict[str, Any]:
    """Return curves as plain values."""
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


_ROWS_OF_A_CURVE = 9


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
    deliver(result, options, save_curves, plain_curves, _print_boundary)


def _without_curves(result: "xr.Dataset") -> str:
    (low, high), (least, most) = result.attrs["angular_frequency_range"], result.attrs["bounds"]
    name = str(result.attrs["parameter"]).replace("_", " ")
    how = result.attrs["rolling"]
    return (
        f"no loss of stability was found: rolling is {how} wherever it was found from {low:.6g} to {high:.6g} rad/s "
        f"and {name} {least:.6g} to {most:.6g}"
    )


def _print_boundary(result: "xr.Dataset") -> None:
    parameter = str(result.attrs["parameter"])
    unit = str(result[parameter].attrs.get("units", "")).replace(" s-2", "/s²").replace(" s-1", "/s")
    labels = {1: "supercritical", 0: "subcritical", -1: ""}
    rows = []
    for index, kind in enumerate(result["curve_kind"].to_numpy()):
        part = result.isel(point=np.nonzero(result["curve"].to_numpy() == index)[0])
        shown = np.unique(np.linspace(0, part.sizes["point"] - 1, _ROWS_OF_A_CURVE).round().astype(int))
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
