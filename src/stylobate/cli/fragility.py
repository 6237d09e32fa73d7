"""`stylobate fragility`: probability of overturning versus intensity, and its annual rate."""

import json
import logging
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate.base_motions import BASE_AT_REST
from stylobate.cli.command import command
from stylobate.cli.options import Options, overlay, read_source, with_axes
from stylobate.cli.output import check_place, check_writable, open_kind, print_json, save_plot
from stylobate.cli.study import check_outputs, computed, end, is_to_compute, save, show
from stylobate.config.options import (
    COLUMN,
    COMPUTING,
    MODEL,
    ONE_COMPONENT,
    OUTPUT_OR_STORE,
    SAMPLE,
    SCALES,
    STEP,
    UNITS,
    Group,
    Option,
    run_numbers,
)
from stylobate.errors import FileError, ParameterError, require_name
from stylobate.run_arguments import SharedByRuns

if TYPE_CHECKING:
    import xarray as xr


_FRAGILITY = Group.of(
    "Fragility",
    Option("records", "folder of records, pattern such as 'quakes/*.AT2', or file; repeat it", list[str]),
    Option("sample_records", SAMPLE, list[str]),
    UNITS,
    STEP,
    ONE_COMPONENT,
    Option(
        "intensity",
        "PGA (by default), PGV, 'SA(0.5 s)', 'PGA/(g tan α)' or 'p PGV/(g tan α)'",
        str,
    ),
    Option(
        "component",
        "definition of the horizontal component of the intensity: RotD50 (by default), RotD100 (the vector), "
        "'geometric mean' or 'larger component'",
        str,
    ),
    Option("vertical", "whether vertical components act: on (by default), off or both", str),
    Option("free_tail", "free vibration time after a record; 20/p by default", unit="s"),
    Option(
        "spread", "uncertain property and its lognormal dispersion; repeat it", list[str], metavar="NAME=DISPERSION"
    ),
    Option(
        "limit_state",
        "limit of the displacement [m]: slip, residual, neighbours (at a height [m]) or edge; repeat it",
        list[str],
        metavar="RESPONSE=LIMIT[@HEIGHT]",
    ),
    Option("property_samples", "number of samples of the uncertain properties", int),
    Option("seed", "seed of samples and resamples; 0 by default", int),
    Option(
        "counting",
        "'as computed' (by default), or 'first': all scales above the first that reaches a limit state count",
        str,
    ),
    Option("confidence", "confidence level of intervals; 0.95 by default"),
    Option("resamples", "number of bootstrap resamples of the records; 1000 by default", int),
    Option(
        "hazard",
        "hazard curve of OpenQuake, or file of two columns: intensity, annual rate or probability of exceedance; "
        "first line: PGA RotD50 [g], annual rate [1/a], or … probability in 50 years",
        Path,
    ),
    Option("hazard_units", "unit of the hazard's intensities, if its file states none: g, m/s2", str),
    Option(
        "hazard_component", "horizontal component of the hazard, if its file states none: RotD50, 'geometric mean'", str
    ),
    Option(
        "hazard_site",
        "site in a table of OpenQuake: its number, from 0, or its position",
        str,
        metavar="NUMBER|LON,LAT",
    ),
    Option("years", "period of the stated probability; 50 by default", unit="a"),
    Option("target_rate", "annual rate that is accepted: the result states whether the rates are below it"),
)
_RUNS_FIGURE = Group.of(
    "Output",
    Option("runs_figure", "draw the runs into this file", Path),
    Option(
        "export",
        "write the curves for another program: OpenQuake (.xml), pelicun (.csv), IN-CORE (.json), or a table (.xlsx)",
        Path,
    ),
    Option("object", "name of the object in these files; column by default", str),
)


@command(
    argument="TOML description, or saved runs (.nc) to fit again or repeat",
    groups=(
        SCALES,
        _FRAGILITY,
        run_numbers(SharedByRuns).without("duration", "periods", "tilt_limit"),
        COLUMN,
        MODEL,
        COMPUTING,
        OUTPUT_OR_STORE,
        _RUNS_FIGURE,
    ),
)
def fragility(options: Options) -> None:
    """Fit fragility curves: probability of each limit state versus intensity.

    A run is computed for every record, scale and sample of uncertain properties. Saved runs are fitted again; options
    that change the runs compute them again. With --hazard, the result holds annual rates and probabilities. Examples:

    stylobate fragility --radius 0.5 --height 5 --density 2000 --damping 0.05 --records quakes --units g
    --scales 0.5 8 12 --figure fragility.png --output runs.nc

    stylobate fragility runs.nc --counting first --hazard site.csv
    """
    from stylobate.config.simulation import Setup
    from stylobate.earthquakes.config.fragility import FragilityConfig
    from stylobate.earthquakes.fragility_study import FragilityStudy

    complete = True
    check_outputs(options)
    check_writable(options["runs_figure"])
    if options["export"] is not None:
        _check_export(options["export"])
        require_name("--object", options["object"] or "column")
    saved = open_kind(options["source"], "fragility", ("incremental dynamic analysis", "slip analysis"))
    values = _overlay(_described(options) if saved is None else _description(saved, options["source"]), options)
    description = FragilityConfig.parse(values)
    read = is_to_compute(saved, options, shown_with=_OF_FITS)
    study = FragilityStudy.of(description.build(read=read))
    if read:
        setup = Setup(study.model, BASE_AT_REST, {})
        runs, complete = computed(lambda _model, _motion, **how: study.runs(**how), setup, options)
        runs = runs.assign_attrs(description=json.dumps(description.values()))
    else:
        assert saved is not None
        runs = saved
    fits = study.fits(runs)
    found = runs, fits, study.parts(runs), study.rates(runs, fits)
    if options["runs_figure"] is not None:
        save_plot(runs, options["runs_figure"])
    if options["output"] is not None:
        save(runs, options["output"])
    if options["figure"] is not None:
        save_plot(fits, options["figure"])
    if options["export"] is not None:
        _export(fits, options["export"], options["object"] or "column")
    from stylobate.earthquakes.fragility_study import plain_fits, table_of_fits

    if options["as_json"]:
        print_json(plain_fits(*found))
    else:
        show(table_of_fits(*found))
    end(runs, options, complete=complete)


_EXPORTS = (".xml", ".csv", ".json", ".xlsx")


def _check_export(path: Path) -> None:
    if path.suffix not in _EXPORTS:
        raise ParameterError(f"--export must end with {', '.join(_EXPORTS)}, got {str(path)!r}")
    check_place(path)


def _export(fits: "xr.Dataset", path: Path, name: str) -> None:
    """Write the curves of the limit states that have one; a workbook has all."""
    from stylobate.earthquakes.fragility import FitStatus, export_fragility

    fitted = fits["status"].to_numpy() == FitStatus.FITTED
    if path.suffix != ".xlsx" and fitted.any():
        without = fits["limit_state"].to_numpy()[~fitted].tolist()
        fits = fits.isel(limit_state=fitted)
        if without:
            logging.getLogger("stylobate").warning("%s: without %s, which have no fit", path, ", ".join(without))
    export_fragility(fits, path, name=name)


_OF_HAZARD = ("hazard", "hazard_units", "hazard_component", "hazard_site")
# Options that change the fits and not the runs.
_OF_FITS = (
    "counting",
    "confidence",
    "resamples",
    *_OF_HAZARD,
    "years",
    "target_rate",
    "runs_figure",
    "export",
    "object",
)


def _description(saved: "xr.Dataset", source: Path | None) -> dict[str, Any]:
    if "description" not in saved.attrs:
        raise FileError(
            f"{source}: saved without its description. Fit it in Python: sb.earthquakes.fragility_of_runs(runs)."
        )
    description: dict[str, Any] = json.loads(saved.attrs["description"])
    return description


def _described(options: Options) -> dict[str, Any]:
    """Read the values of a TOML file; the file of its hazard is relative to its folder."""
    source, values = options["source"], read_source(options)
    table = values.get("fragility")
    hazard = table.get("hazard") if isinstance(table, Mapping) else None
    if source is None or not isinstance(hazard, Mapping) or "file" not in hazard:
        return values
    anchored = {**hazard, "file": str((source.parent / str(hazard["file"])).absolute())}
    return {**values, "fragility": {**dict(table or {}), "hazard": anchored}}


def _overlay(described: Mapping[str, Any], options: Options) -> dict[str, Any]:
    """Return the values `described`, overridden by the options."""
    from stylobate.earthquakes.config.fragility import FragilityConfig

    values = overlay(described, options, FragilityConfig.model_fields)
    if not values.get("motion"):
        values.pop("motion", None)
    return {**values, "records": _records(values.get("records"), options), "fragility": _table(values, options)}


def _records(described: Any, options: Options) -> Any:
    table = dict(described) if isinstance(described, Mapping) else {"source": described} if described else {}
    if options["records"] or options["sample_records"]:
        table = {name: value for name, value in table.items() if name not in ("source", "event", "samples", "only")}
    if options["records"]:
        table["source"] = options["records"][0] if len(options["records"]) == 1 else tuple(options["records"])
    if options["sample_records"]:
        table["samples"] = tuple(options["sample_records"])
    source = table.get("source")
    if source is not None:  # sample records state their units
        table |= options.pick("units", "step", "one_component")
    if isinstance(source, str):
        table["source"] = str(Path(source).absolute())
    elif isinstance(source, (list, tuple)):
        table["source"] = tuple(str(Path(one).absolute()) for one in source)
    return table


_VERTICAL = {"on": (True,), "off": (False,), "both": (True, False)}


def _table(values: Mapping[str, Any], options: Options) -> Any:
    from stylobate.earthquakes.config.limit_states import limit_state_of_text

    described = with_axes(values, options, "fragility", ("scales",)).get("fragility", {})
    if not isinstance(described, Mapping):
        return described
    table = dict(described)
    if options["vertical"] is not None:
        if options["vertical"] not in _VERTICAL:
            raise ParameterError(f"--vertical must be on, off or both, got {options['vertical']!r}")
        table["vertical"] = _VERTICAL[options["vertical"]]
    if options["spread"]:
        table["spreads"] = dict(_spread(text) for text in options["spread"])
    if options["limit_state"]:
        table["limit_states"] = [limit_state_of_text(text) for text in options["limit_state"]]
    table |= _hazard(table.get("hazard"), options)
    rates = ("years", "target_rate") if table.get("hazard") is not None else ()
    table |= options.pick("intensity", "component", "seed", "counting", "confidence", "resamples", *rates)
    renamed = options.pick("free_tail", "property_samples")
    return table | {{"free_tail": "tail", "property_samples": "samples"}[name]: one for name, one in renamed.items()}


def _hazard(described: Any, options: Options) -> dict[str, Any]:
    """Return the hazard, if options state it."""
    own: dict[str, Any] = {} if options["hazard"] is None else {"file": str(options["hazard"].absolute())}
    own |= {name: options[f"hazard_{name}"] for name in ("units", "component") if options[f"hazard_{name}"] is not None}
    if options["hazard_site"] is not None:
        own["site"] = _site(options["hazard_site"])
    # Another file is another curve: the description of the first curve does not apply.
    kept = dict(described) if isinstance(described, Mapping) and options["hazard"] is None else {}
    return {"hazard": {**kept, **own}} if own else {}


def _site(text: str) -> int | list[float]:
    """Return the number of a site, or its longitude and latitude."""
    try:
        return [float(part) for part in text.split(",")] if "," in text else int(text)
    except ValueError:
        raise ParameterError(
            f"--hazard-site: no number and no LON,LAT (got {text!r}). Give one of them, such as 0 or 22.35,37.95."
        ) from None


def _spread(text: str) -> tuple[str, dict[str, Any]]:
    name, _, dispersion = text.partition("=")
    try:
        return name.strip().replace("-", "_"), {"kind": "lognormal", "dispersion": float(dispersion)}
    except ValueError:
        raise ParameterError(f"--spread must be a name and a dispersion, such as damping=0.4, got {text!r}") from None
