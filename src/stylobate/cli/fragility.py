"""`stylobate fragility`: with what probability records of an intensity overturn the column, and how often in a year."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stylobate import config, earthquakes, plots
from stylobate.cli import options as opt
from stylobate.cli.fragility_table import print_fits, summary
from stylobate.cli.given import Given
from stylobate.cli.many_runs import check_outputs, computed, end, is_to_compute
from stylobate.cli.output import STORE, check_writable, print_json, save_figure
from stylobate.cli.saved import open_saved
from stylobate.cli.source import read_source
from stylobate.errors import FileError, ParameterError

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.earthquakes import FragilityStudy

Source = Annotated[
    Path | None,
    typer.Argument(help="TOML description, or saved runs (.nc) to fit anew or repeat", show_default=False),
]


def _option(text: str, metavar: str | None = None) -> Any:
    return typer.Option(help=text, rich_help_panel="Fragility", show_default=False, metavar=metavar)


Records = Annotated[
    list[str] | None, _option("a folder of records, a pattern such as 'quakes/*.AT2', or a file; may be repeated")
]
SampleRecords = Annotated[
    list[str] | None, _option('a record that comes with the package: "el centro 1940", or "… corrected"')
]
ScaleRange = Annotated[
    tuple[float, float, int] | None, _option("factors of the records: from, to, how many", "FROM TO NUMBER")
]
ScalesSpacing = Annotated[str | None, _option("log (by default) or linear")]
Intensity = Annotated[
    str | None,
    _option("'peak ground acceleration' (by default), 'peak ground velocity', 'PGA/(g tan α)' or 'p PGV/(g tan α)'"),
]
Component = Annotated[
    str | None,
    _option(
        "definition of the horizontal component of the intensity: RotD50 (by default), RotD100 (the vector), "
        "'geometric mean' or 'larger component'"
    ),
]
Vertical = Annotated[str | None, _option("whether vertical components act: on (by default), off or both")]
FreeTail = Annotated[float | None, _option("how long columns are followed after a record [s]; by default 20/p")]
Spread = Annotated[
    list[str] | None, _option("an uncertain property: its lognormal dispersion; may be repeated", "NAME=DISPERSION")
]
PropertySamples = Annotated[int | None, _option("how many samples of uncertain properties are drawn")]
Seed = Annotated[int | None, _option("of samples and resamples [default: 0]")]
CountingRule = Annotated[
    str | None, _option("of records safe again higher up: 'as computed' (by default), or 'first': all above the first")
]
Confidence = Annotated[float | None, _option("of intervals [default: 0.95]")]
Resamples = Annotated[int | None, _option("how often records are drawn anew for intervals [default: 1000]")]
HazardFile = Annotated[
    Path | None,
    _option(
        "a hazard curve of OpenQuake, or a file of two columns: intensity, annual rate or probability of exceedance; "
        "first line: PGA RotD50 [g], annual rate [1/a], or … probability in 50 years"
    ),
]
HazardUnits = Annotated[str | None, _option("of the intensities of the hazard, where its file states none: g, m/s2 …")]
HazardComponent = Annotated[
    str | None, _option("horizontal component of the hazard, where its file states none: RotD50, 'geometric mean' …")
]
HazardSite = Annotated[
    str | None, _option("which site of a table of OpenQuake: its number, from 0, or LON,LAT", "NUMBER|LON,LAT")
]
Years = Annotated[float | None, _option("for which the probability is told [default: 50]")]
RunsFigure = Annotated[
    Path | None,
    typer.Option(help="draw the runs into this file", rich_help_panel="Output", show_default=False),
]


def fragility(
    context: typer.Context,
    source: Source = None,
    records: Records = None,
    sample_records: SampleRecords = None,
    units: opt.Units = None,
    step: opt.TimeStep = None,
    single: opt.Single = None,
    scales: ScaleRange = None,
    scales_spacing: ScalesSpacing = None,
    intensity: Intensity = None,
    component: Component = None,
    vertical: Vertical = None,
    free_tail: FreeTail = None,
    spread: Spread = None,
    property_samples: PropertySamples = None,
    seed: Seed = None,
    counting: CountingRule = None,
    confidence: Confidence = None,
    resamples: Resamples = None,
    hazard: HazardFile = None,
    hazard_units: HazardUnits = None,
    hazard_component: HazardComponent = None,
    hazard_site: HazardSite = None,
    years: Years = None,
    tilt: opt.Tilt = None,
    tilt_rate: opt.TiltRate = None,
    spin: opt.Spin = None,
    method: opt.Method = None,
    rtol: opt.Rtol = None,
    rest_energy: opt.RestEnergy = None,
    max_steps: opt.MaxSteps = None,
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
    friction_coefficient: opt.FrictionCoefficient = None,
    static_friction_coefficient: opt.StaticFriction = None,
    patch: opt.Patch = None,
    incline: opt.Incline = None,
    incline_direction: opt.InclineDirection = None,
    resume: opt.Resume = False,
    executor: opt.Executor = None,
    threads: opt.ThreadCount = None,
    figure: opt.Figure = None,
    runs_figure: RunsFigure = None,
    output: opt.OutputOrStore = None,
    as_json: opt.Json = False,
) -> None:
    """Tell with what probability records of an intensity bring a column to each limit state.

    Every record is run at every scale, with every sample of uncertain properties. Saved runs are fitted anew; options
    that change the runs compute them anew. With --hazard, annual rates and probabilities. Examples:

    stylobate fragility --radius 0.5 --height 5 --density 2000 --damping 0.05 --records quakes --units g
    --scales 0.5 8 12 --figure fragility.png --output runs.nc

    stylobate fragility runs.nc --counting first --hazard site.csv
    """
    given, complete = Given.of(context), True
    check_outputs(given)
    check_writable(given["runs_figure"])
    saved = _saved(source)
    values = _overlay(_described(source) if saved is None else _description(saved, source), given)
    description = earthquakes.config.FragilityConfig.parse(values)
    if not is_to_compute(saved, given, shown_with=_OF_FITS):
        assert saved is not None
        found, study = saved, earthquakes.FragilityStudy.of(description.build(read=False))
    else:
        study = earthquakes.FragilityStudy.of(description.build())
        found, complete = _computed(study, given)
        found = found.assign_attrs(description=json.dumps(description.values()))
    fits = study.fits(found)
    parts, rates = study.parts(found), study.rates(fits)
    _write(found, fits, given)
    if as_json:
        print_json(summary(found, fits, parts, rates))
    else:
        print_fits(found, fits, parts, rates)
    end(found, given, complete=complete)


_OF_HAZARD = ("hazard", "hazard_units", "hazard_component", "hazard_site")
# What changes the fits and not the runs.
_OF_FITS = ("counting", "confidence", "resamples", *_OF_HAZARD, "years", "runs_figure")


def _saved(source: Path | None) -> "xr.Dataset | None":
    if source is not None and source.suffix == STORE:
        message = (
            f"{source} is a store of runs: it goes on with the description that began it, --output {source} and "
            "--resume; runs to be shown are saved as .nc"
        )
        raise FileError(message)
    saved = open_saved(source)
    if saved is not None and saved.attrs["kind"] != "incremental dynamic analysis":
        message = f"{source} holds a {saved.attrs['kind']}, and no runs under records at several scales"
        raise FileError(message)
    return saved


def _description(saved: "xr.Dataset", source: Path | None) -> dict[str, Any]:
    if "description" not in saved.attrs:
        message = f"{source} was saved from Python; fit it there: sb.earthquakes.fragility_of_runs(runs)"
        raise FileError(message)
    found: dict[str, Any] = json.loads(saved.attrs["description"])
    return found


def _described(source: Path | None) -> dict[str, Any]:
    """Return the values of a TOML file, the file of its hazard told from its folder on."""
    values = read_source(source)
    table = values.get("fragility")
    hazard = table.get("hazard") if isinstance(table, Mapping) else None
    if source is None or not isinstance(hazard, Mapping) or "file" not in hazard:
        return values
    anchored = {**hazard, "file": str((source.parent / str(hazard["file"])).absolute())}
    return {**values, "fragility": {**dict(table or {}), "hazard": anchored}}


def _overlay(described: Mapping[str, Any], given: Given) -> dict[str, Any]:
    """Return the values `described` with the options laid over them."""
    from stylobate.earthquakes.config import FragilityConfig  # noqa: PLC0415

    own = given.without("records", "units", "step", "single")
    values = opt.overlay(described, own, FragilityConfig.model_fields)
    if not values.get("motion"):
        values.pop("motion", None)
    return {**values, "records": _records(values.get("records"), given), "fragility": _table(values, given)}


def _records(described: Any, given: Mapping[str, Any]) -> Any:
    table = dict(described) if isinstance(described, Mapping) else {"source": described} if described else {}
    if given["records"] or given["sample_records"]:
        table = {name: value for name, value in table.items() if name not in ("source", "event", "samples", "only")}
    if given["records"]:
        table["source"] = given["records"][0] if len(given["records"]) == 1 else tuple(given["records"])
    if given["sample_records"]:
        table["samples"] = tuple(given["sample_records"])
    source = table.get("source")
    if source is not None:  # samples know their units
        table |= {name: given[name] for name in ("units", "step", "single") if given[name] is not None}
    if isinstance(source, str):
        table["source"] = str(Path(source).absolute())
    elif isinstance(source, (list, tuple)):
        table["source"] = tuple(str(Path(one).absolute()) for one in source)
    return table


_VERTICAL = {"on": (True,), "off": (False,), "both": (True, False)}


def _table(values: Mapping[str, Any], given: Mapping[str, Any]) -> Any:
    described = values.get("fragility", {})
    if not isinstance(described, Mapping):
        return described
    table = dict(described)
    if given["scales"] is not None:
        first, last, number = given["scales"]
        table["scales"] = {"from": first, "to": last, "number": number}
    table |= opt.overlay_spacing(table, "scales", given)
    if given["vertical"] is not None:
        if given["vertical"] not in _VERTICAL:
            message = f"--vertical must be on, off or both, got {given['vertical']!r}"
            raise ParameterError(message)
        table["vertical"] = _VERTICAL[given["vertical"]]
    if given["spread"]:
        table["spreads"] = dict(_spread(text) for text in given["spread"])
    table |= _hazard(table.get("hazard"), given)
    names = {"free_tail": "tail", "property_samples": "samples"}
    rates = ("years",) if table.get("hazard") is not None else ()
    for name in ("intensity", "component", "seed", "counting", "confidence", "resamples", *rates, *names):
        if given[name] is not None:
            table[names.get(name, name)] = given[name]
    return table


def _hazard(described: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the hazard, if the options say something of it."""
    own: dict[str, Any] = {} if given["hazard"] is None else {"file": str(given["hazard"].absolute())}
    own |= {name: given[f"hazard_{name}"] for name in ("units", "component") if given[f"hazard_{name}"] is not None}
    if given["hazard_site"] is not None:
        own["site"] = _site(given["hazard_site"])
    # Another file is another curve: nothing of what is described is of it.
    kept = dict(described) if isinstance(described, Mapping) and given["hazard"] is None else {}
    return {"hazard": {**kept, **own}} if own else {}


def _site(text: str) -> int | list[float]:
    """Return the number of a site, or its longitude and latitude."""
    try:
        return [float(part) for part in text.split(",")] if "," in text else int(text)
    except ValueError:
        message = f"--hazard-site: no number and no LON,LAT (got {text!r}). Give one of them, such as 0 or 22.35,37.95."
        raise ParameterError(message) from None


def _spread(text: str) -> tuple[str, dict[str, Any]]:
    name, _, dispersion = text.partition("=")
    try:
        return name.strip().replace("-", "_"), {"kind": "lognormal", "dispersion": float(dispersion)}
    except ValueError:
        message = f"--spread must be a name and a dispersion, such as damping=0.4, got {text!r}"
        raise ParameterError(message) from None


def _computed(study: "FragilityStudy", given: Given) -> "tuple[xr.Dataset, bool]":
    from stylobate.base_motions import BASE_AT_REST  # noqa: PLC0415

    def run(_model: Any, _motion: Any, **computing: Any) -> "xr.Dataset":
        return study.runs(**computing)

    return computed(run, config.Setup(study.model, BASE_AT_REST, {}), given, "fragility")


def _write(found: "xr.Dataset", fits: "xr.Dataset", given: Mapping[str, Any]) -> None:
    output: Path | None = given["output"]
    if output is not None and output.suffix != STORE:
        from stylobate.results import write_netcdf  # noqa: PLC0415

        write_netcdf(found, output)
    for result, path in ((fits, given["figure"]), (found, given["runs_figure"])):
        if path is not None:
            save_figure(plots.plot(result), path)
