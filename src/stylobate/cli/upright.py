"""`stylobate upright`: whether a part on a vibrating base stays upright, rocks or falls."""

from typing import TYPE_CHECKING, Any

from stylobate import config, conveying
from stylobate.cli.command import command
from stylobate.cli.declarations import COMPUTING, OUTPUT_OR_STORE, Option, run_numbers
from stylobate.cli.many_runs import finish, run_study, study_values
from stylobate.cli.options import Options
from stylobate.cli.output import DEGREES, print_table
from stylobate.cli.overlay import merge
from stylobate.cli.parts import COLUMN, MOTION_WITHOUT_RECORDS, SLIDING
from stylobate.cli.saved import open_study, study_summary
from stylobate.results import percent
from stylobate.run_arguments import SharedByRuns

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

KIND = "upright"
STARTS = (
    Option("tilts", "initial tilt angle; repeat it. 0, 1e-5, 1e-3 and 1e-2 by default", list[float], unit="rad"),
    Option("phases", "number of phases at which the vibration starts; 64 by default", int),
    Option("friction", "friction coefficient; repeat it for several, each as probable", list[float]),
    Option("azimuth", "azimuth of the initial tilt; spread over all directions by default", unit="rad"),
    Option("confidence", "confidence level of intervals; 0.9 by default"),
)
"""Options of the table `upright`."""


@command(
    *STARTS,
    argument="TOML description, or a saved result (.nc) to show or repeat",
    groups=(
        run_numbers(SharedByRuns).without("duration", "tilt"),
        COLUMN,
        SLIDING,
        MOTION_WITHOUT_RECORDS,
        COMPUTING,
        OUTPUT_OR_STORE,
    ),
)
def upright(options: Options) -> None:
    """Decide whether a part on a vibrating base stays upright, rocks or falls.

    The runs differ in initial tilt, in the direction of this tilt and in the phase of the vibration. The shares leave
    out parts that start exactly flat and hop: they always land flat. Examples:

    stylobate upright --radius 6mm --height 40mm --density 7850 --friction-coefficient 0.2 --motion stroke
    --stroke 1mm --frequency 50Hz --angle 25deg --figure upright.png

    stylobate upright upright.toml --tilts 0.05deg --tilts 0.5deg --friction 0.2 --friction 0.3 --output upright.nc
    """
    source = options["source"]
    stores = f"the store of a posture. Pass its description with --output {source} --resume to show it."
    result, complete = run_study(
        options,
        open_study(source, (KIND,), lacks="posture", store=stores),
        lambda saved: saved,
        lambda saved: _prepared(saved, options),
    )
    finish(result, options, _summary, _print, complete=complete)


def _prepared(saved: "xr.Dataset | None", options: Options) -> "tuple[Callable[..., xr.Dataset], config.Setup]":
    kind = conveying.config.UprightConfig
    values = study_values(saved, options, kind, {"model": {"kind": "sliding"}})
    merge(values, KIND, options.pick(*(one.name for one in STARTS)))
    return conveying.upright, kind.parse(values).build()


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    ends = ("share", "share_low", "share_high")
    shares = {
        str(name): {end: float(result[end].sel(posture_name=name)) for end in ends}
        for name in result["posture_name"].to_numpy()
    }
    rows = [
        {"friction_coefficient": mu, "tilt": tilt, **shares_of_tilt} for mu, tilt, shares_of_tilt in _by_tilt(result)
    ]
    verdict = {name: result.attrs[name] for name in ("verdict", "throw_number", "confidence")}
    return study_summary(result, **verdict, shares=shares, counted=int(result["counted"]), by_tilt=rows)


def _by_tilt(result: "xr.Dataset") -> list[tuple[float, float, dict[str, float]]]:
    """Return the shares of each friction coefficient and initial tilt."""
    names = [str(name) for name in result["posture_name"].to_numpy()]
    return [
        (float(mu), float(tilt), dict(zip(names, map(float, shares), strict=True)))
        for mu, by_tilt in zip(result["friction"].to_numpy(), result["share_of_tilt"].to_numpy(), strict=True)
        for tilt, shares in zip(result["tilt"].to_numpy(), by_tilt, strict=True)
    ]


def _print(result: "xr.Dataset") -> None:
    rows = [
        [f"{mu:.4g}", f"{DEGREES.factor * tilt:.4g}°", *(percent(share) for share in shares.values())]
        for mu, tilt, shares in _by_tilt(result)
    ]
    header = ("friction coefficient", "initial tilt", *map(str, result["posture_name"].to_numpy()))
    print_table(str(result.attrs["verdict"]), rows, header)
