"""`stylobate fragility`: probability of overturning versus intensity, and its annual rate."""

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate.cli.command import command
from stylobate.cli.options import Options, overlay, read_source, with_axes
from stylobate.cli.output import (
    check_writable,
    open_study,
    print_json,
    print_table,
    provenance_of,
    save_plot,
)
from stylobate.cli.study import check_outputs, computed, end, is_to_compute, save
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
from stylobate.errors import FileError, ParameterError
from stylobate.results.tables import model_named, number_of_runs
from stylobate.results.verdict import few_records, yardstick_text
from stylobate.run_arguments import SharedByRuns
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.earthquakes.fragility_study import FragilityStudy

_FRAGILITY = Group.of(
    "Fragility",
    Option("records", "folder of records, pattern such as 'quakes/*.AT2', or file; repeat it", list[str]),
    Option("sample_records", SAMPLE, list[str]),
    UNITS,
    STEP,
    ONE_COMPONENT,
    Option(
        "intensity",
        "'peak ground acceleration' (by default), 'peak ground velocity', 'PGA/(g tan α)' or 'p PGV/(g tan α)'",
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
)
_RUNS_FIGURE = Group.of("Output", Option("runs_figure", "draw the runs into this file", Path))


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
    from stylobate.earthquakes.config.fragility import FragilityConfig
    from stylobate.earthquakes.fragility_study import FragilityStudy

    complete = True
    check_outputs(options)
    check_writable(options["runs_figure"])
    saved = _saved(options["source"])
    values = _overlay(_described(options) if saved is None else _description(saved, options["source"]), options)
    description = FragilityConfig.parse(values)
    read = is_to_compute(saved, options, shown_with=_OF_FITS)
    study = FragilityStudy.of(description.build(read=read))
    if read:
        runs, complete = _computed(study, options)
        runs = runs.assign_attrs(description=json.dumps(description.values()))
    else:
        assert saved is not None
        runs = saved
    fits = study.fits(runs)
    parts, rates = study.parts(runs), study.rates(fits)
    _write(runs, fits, options)
    if options["as_json"]:
        print_json(_summary(runs, fits, parts, rates))
    else:
        _print_fits(runs, fits, parts, rates)
    end(runs, options, complete=complete)


_OF_HAZARD = ("hazard", "hazard_units", "hazard_component", "hazard_site")
# Options that change the fits and not the runs.
_OF_FITS = ("counting", "confidence", "resamples", *_OF_HAZARD, "years", "runs_figure")


def _saved(source: Path | None) -> "xr.Dataset | None":
    store = (
        "a store of runs, which cannot be shown. Continue it with its description, "
        f"--output {source} and --resume, or save runs as .nc."
    )
    kinds = ("incremental dynamic analysis",)
    return open_study(source, kinds, lacks="runs under records at several scales", store=store)


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
    table |= _hazard(table.get("hazard"), options)
    rates = ("years",) if table.get("hazard") is not None else ()
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


def _computed(study: "FragilityStudy", options: Options) -> "tuple[xr.Dataset, bool]":
    from stylobate.base_motions import BASE_AT_REST
    from stylobate.config.simulation import Setup

    def run(_model: Any, _motion: Any, **computing: Any) -> "xr.Dataset":
        return study.runs(**computing)

    return computed(run, Setup(study.model, BASE_AT_REST, {}), options)


def _write(runs: "xr.Dataset", fits: "xr.Dataset", options: Options) -> None:
    if options["output"] is not None:
        save(runs, options["output"])
    for result, path in ((fits, options["figure"]), (runs, options["runs_figure"])):
        if path is not None:
            save_plot(result, path)


def _summary(
    runs: "xr.Dataset", fits: "xr.Dataset", parts: "xr.Dataset | None", rates: "xr.Dataset | None"
) -> dict[str, Any]:
    """Convert runs, fits, parts of the dispersion and annual rates to plain values for JSON."""
    return {
        "kind": "fragility",
        "intensity": {
            "name": runs.attrs["intensity"],
            "component": fits["median"].attrs.get("component"),
            "units": fits["median"].attrs.get("units", "1"),
        },
        "records": [str(name) for name in runs["record"].to_numpy().ravel()],
        "scales": runs["scale"].to_numpy().tolist(),
        "limit_states": [_row(fits, rates, place) for place in range(fits.sizes["limit_state"])],
        "housner_damping": [
            {"amplitude": amplitude, "damping": damping}
            for amplitude, damping in zip(fits.attrs["housner_amplitudes"], fits.attrs["housner_damping"], strict=True)
        ],
        "dispersion_parts": None if parts is None else {name: float(parts[name]) for name in _PARTS},
        "intervals": fits.attrs["intervals"],
        "confidence": fits.attrs["confidence"],
        "counting": fits.attrs["counting"],
        "computed": int(runs["computed"]),
        "runs": runs["outcome"].size,
        "provenance": provenance_of(runs),
    }


_ENDS = ("", "_low", "_high")
_PARTS = [
    f"{name}_dispersion{end}" for name in ("total", "record", "property", "joint") for end in _ENDS
]  # as from dispersion_parts


_OF_RATES = ("annual_rate", "rate_low", "rate_high", "probability", "share_beyond")


def _row(fits: "xr.Dataset", rates: "xr.Dataset | None", place: int) -> dict[str, Any]:
    """Return the numbers of one limit state."""
    one = fits.isel(limit_state=place)
    row: dict[str, Any] = {"name": str(one["limit_state"].item())}
    row |= {f"{name}{end}": float(one[f"{name}{end}"]) for name in ("median", "dispersion") for end in _ENDS}
    meanings = str(fits["status"].attrs["flag_meanings"]).split()
    row["status"] = meanings[int(one["status"])].lower().replace("_", " ")
    row |= {name: int(one[name]) for name in ("runs", "runs_reached", "runs_not_known", "non_monotone_records")}
    if rates is not None:
        rate = rates.isel(limit_state=place)
        row |= {name: float(rate[name]) for name in _OF_RATES}
        row["rate_withheld"] = str(rate["withheld_reason"].item())
        if row["rate_withheld"]:
            row |= dict.fromkeys(("annual_rate", "probability"), math.nan)
    return row


def _print_fits(runs: "xr.Dataset", fits: "xr.Dataset", parts: "xr.Dataset | None", rates: "xr.Dataset | None") -> None:
    """Print a row for each limit state, and remarks on the table."""
    unit = _UNITS.get(str(fits["median"].attrs.get("units")), "")
    header = ["limit state", f"median{unit}", "dispersion", "reached", "not monotonic"]
    if rates is not None:
        header += ["per year", f"in {rates.attrs['years']:g} years"]
    rows = [_row(fits, rates, place) for place in range(fits.sizes["limit_state"])]
    over = " × ".join(plural(runs.sizes[dim], str(dim).replace("_", " ")) for dim in runs["outcome"].dims)
    title = f"{number_of_runs(runs, f': {over}')}; {model_named(runs)}; over the {runs.attrs['intensity']}"
    print_table(title, [_cells(row) for row in rows], header)
    percent = f"{100.0 * float(fits.attrs['confidence']):g} %"
    print(f"{percent} intervals: {fits.attrs['intervals']}; runs counted {fits.attrs['counting']}")
    print(f"damping: Housner's impacts lose as {yardstick_text(fits.attrs['housner_damping'])}")
    worst, records = int(fits["non_monotone_records"].max()), runs["record"].size
    if few := few_records(records):
        print(few)
    if worst > 0:
        print(f"not monotonic: {worst} of {records} records survive at a scale above one that reached a limit state")
    if parts is not None:
        print(describe_parts(parts))
    if rates is not None:
        for line in (*_of_hazard(rates), *_remarks_on_rates(rows)):
            print(line)


_UNITS = {"m s-2": " [m/s²]", "m s-1": " [m/s]"}


def _cells(row: Mapping[str, Any]) -> list[str]:
    fitted = row["status"] == "fitted"
    median, dispersion = (
        f"{_short(row[f'{name}_low'])} to {_short(row[f'{name}_high'])}" for name in ("median", "dispersion")
    )
    unknown = f", {row['runs_not_known']} not known" if row["runs_not_known"] else ""
    cells = [
        row["name"],
        f"{_short(row['median'])}, {median}" if fitted else f"{row['status']}: {median}",
        f"{_short(row['dispersion'])}, {dispersion}" if fitted else "",
        f"{row['runs_reached']} of {row['runs']}{unknown}",
        f"{row['non_monotone_records']}" if row["non_monotone_records"] > 0 else "",
    ]
    if "annual_rate" in row:
        cells += _rate_cells(row)
    return cells


def _rate_cells(row: Mapping[str, Any]) -> list[str]:
    """Write the annual rate and the probability; a rate may be withheld."""
    if row["rate_withheld"]:
        return ["withheld", "withheld"]
    if not math.isfinite(row["annual_rate"]):
        return ["", ""]
    return [f"{row['annual_rate']:.2e}", _percent(row["probability"])]


def _percent(probability: float) -> str:
    """Return a probability in percent with two digits, and "> 99.9 %" near certainty.

    >>> _percent(0.036), _percent(0.5), _percent(0.9999), _percent(1.0)
    ('3.6 %', '50 %', '> 99.9 %', '> 99.9 %')
    """
    if probability > _NEARLY_CERTAIN:
        return "> 99.9 %"
    return f"{100.0 * probability:.2g} %" if probability < _MANY else f"{100.0 * probability:.1f} %"


_MANY, _NEARLY_CERTAIN = 0.95, 0.999


def _of_hazard(rates: "xr.Dataset") -> list[str]:
    """Describe the intensity of the hazard curve, and the origin of its rates."""
    origin = str(rates.attrs["hazard_origin"])
    return [f"hazard: {rates['hazard_intensity'].attrs['long_name']}" + (f"; rates from {origin}" if origin else "")]


def _remarks_on_rates(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Describe the fraction of the annual rates beyond the hazard curve, and the reasons for withheld rates."""
    shares = [row["share_beyond"] for row in rows if math.isfinite(row["annual_rate"])]
    lines = [f"annual rates: up to {100.0 * max(shares):.0f} % from beyond the hazard curve"] if shares else []
    for row in rows:
        if why := row["rate_withheld"]:
            bounds = f"it is between {row['rate_low']:.1e} and {row['rate_high']:.1e} per year"
            lines.append(f"annual rate of {row['name']!r}: withheld: {why}; {bounds}")
    return lines


def _short(value: float) -> str:
    return f"{value:.3g}"


def describe_parts(parts: "xr.Dataset") -> str:
    """Describe in a line the parts of the dispersion due to records and to properties."""
    what = "dispersion of the minimum scales that overturn"
    if not math.isfinite(float(parts["total_dispersion"])):
        reasons = {
            "reached_at_once": "overturn at the first scale",
            "never_reached": "at none",
            "not_known": "undecided",
        }
        counts = [f"{parts.attrs[name]} {reason}" for name, reason in reasons.items() if parts.attrs[name]]
        return f"{what}: unknown: of {parts['log_capacity'].size} series {', '.join(counts)}"
    hidden = float(parts.attrs["resolution"])  # by the steps between scales
    names = {
        "record": "from record to record",
        "property": "from properties",
        "joint": "from a property in one record only",
    }
    described = []
    for name, words in names.items():
        value, low, high = (float(parts[f"{name}_dispersion{end}"]) for end in _ENDS)
        seen, high = (_short(value), high) if value > 0.0 else ("none seen", max(high, hidden))
        described.append(f"{seen} {words} ({_short(low)} to {_short(high)})")
    return f"{what}: {', '.join(described)}"
