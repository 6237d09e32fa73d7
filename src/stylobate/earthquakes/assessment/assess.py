"""Assessment of columns under records: outcomes, margins, and shares of small variations that overturn them."""

import datetime as dt
import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import Record
from stylobate.compiler.machine import arithmetic
from stylobate.config.levels import Dissipation
from stylobate.earthquakes.assessment.inputs import CENTRAL, OTHER_LAW, Inputs, Parts
from stylobate.earthquakes.assessment.margins import (
    governing_record,
    histories_of,
    margin_runs,
    margins_of,
    of_one_width,
    states_at_scales,
)
from stylobate.earthquakes.assessment.records import (
    column_properties,
    ground_motions,
    practice_of,
    record_properties,
    spectra_of,
)
from stylobate.earthquakes.assessment.sliding import (
    sliding_of,
    sliding_runs,
    slip_margin_runs,
    slip_margins_of,
    slip_paths_of,
    states_with_slip,
)
from stylobate.earthquakes.assessment.verdicts import (
    planar_of,
    planar_runs,
    share_runs,
    shares_of,
    verdict_runs,
    verdicts_on,
)
from stylobate.earthquakes.fragility import HazardCurve, annual_rate, empirical_rate, fit_fragility
from stylobate.earthquakes.fragility.displacement_limits import LimitStates
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.intensities import Intensity, IntensityMeasure
from stylobate.earthquakes.study_inputs import Records, remark_on
from stylobate.errors import LARGEST_SEED, require_not_negative, require_positive, require_printable, require_whole
from stylobate.models import Model
from stylobate.progress import Progress, in_parts, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.quantities import exact_repr
from stylobate.records.intensities import HorizontalComponent
from stylobate.results.assessment import Assessment
from stylobate.results.report_details import ReportDetails
from stylobate.results.verdict import FEW_RECORDS, require_variations
from stylobate.run_arguments import FREE_TAIL, RunOptions
from stylobate.studies.checks import require_no_limits
from stylobate.studies.sweeps import Executor

# Packages whose versions can change the last digits of the results.
_PACKAGES = ("stylobate", "numpy", "scipy", "llvmlite", "xarray")


@shows_progress("assessment", in_parts)
def assess(
    columns: Mapping[str, Model],
    records: Records,
    *,
    dissipation: Dissipation | None = None,
    friction_coefficient: float | Mapping[str, float] | None = None,
    scales: npt.ArrayLike = (1.0,),
    margin_scales: npt.ArrayLike | None = None,
    width: float = 5e-3,
    tail: float | None = None,
    contact_laws: bool = True,
    variations: int = 200,
    seed: int = 0,
    sliding: bool = False,
    limit_states: LimitStates = (),
    friction_dispersion: float = 0.1,
    planar: bool = True,
    contact: bool = True,
    least_records: int = FEW_RECORDS,
    hazard: HazardCurve | None = None,
    years: float = 50.0,
    target_rate: float | None = None,
    title: str = "Columns under records",
    notes: Sequence[str] = (),
    details: ReportDetails | None = None,
    store: str | Path | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> Assessment:
    """Assess columns under records: outcomes, margins, and how robust they are.

    Parameters
    ----------
    columns
        Three-dimensional models of columns, by name; the values in `dissipation` replace theirs.
    records
        Base motions that end: a sequence, or a mapping from names. Results list them in the order of their names.
    dissipation
        Dissipation parameters of the model, such as damping, by level: "low", "central", "high" and any others. Each
        level states the same ones. A column whose name is a key has its own levels, those under the name. The damping
        "housner" is `Column.housner_damping` of each column. Required: there is no default.
    friction_coefficient
        Friction coefficient of the contact between column and base, one for all or one by column. The friction demand
        of each run is compared with it. Required.
    scales
        Factors of the records at which verdicts are given; vertical components are scaled with them.
    margin_scales
        Factors of the search for overturning intervals, by default 300 from 0.2 to 5, evenly in their logarithm; 41
        within 10 % of each of the `scales` are added. Below the smallest overturning one, 2000 over the range are run.
    width
        Relative width to which the ends of overturning intervals are located.
    tail
        Free-vibration time after a record [s]; by default 20/p.
    contact_laws
        Whether margins and variations include the other contact law: `Rolling` beside `Wobbling`, `SlenderRolling`
        beside `Slender`.
    variations
        Number of small variations of each verdict, see `stylobate.verdict`: at least 2, or 0 for none. The dissipation
        varies from its smallest to its largest level. Fewer than 52 leave every case undecided.
    seed
        Seed of the variations.
    sliding
        Whether to compute the slip of columns that slide before they rock (friction coefficient below r/h), under each
        record at each of the `scales` and over the scan of the margin. Fragility and rates of these columns are then
        those of `limit_states`.
    limit_states
        Limits of the displacement, one sequence for all columns or a mapping by column. "neighbours" also limits the
        displacement by tilt of columns that rock.
    friction_dispersion
        Standard deviation of the logarithm of the friction coefficient among the small variations of slip.
    planar
        Whether to compare with Housner's planar column.
    contact
        Whether runs compute contact demands.
    least_records
        With fewer records no fragility is fitted, because its intervals would be too narrow.
    hazard
        Hazard curve of the site: with it the annual rate of each limit state follows, counted from the runs, and from a
        fitted curve if there are enough records. Its intensity may be any of `quantity_named`.
    years
        Time for which probabilities are stated.
    target_rate
        Annual rate that is accepted [1/a]; each rate is compared with it.
    title, notes
        Title of the assessment; assumptions of its author, for the report.
    details
        Author, project, date, design spectrum and the period of Sa, for the report.
    store
        A folder that keeps each computed part: with it an interrupted assessment resumes, and logs how much it had.
    executor
        As in `run_sweep`.
    progress
        A function that is called with the name of the part, the runs done and the approximate number of runs; a bar by
        default, False for none.
    **options
        Options of all runs, as in `simulate_ensemble`, such as `rest_energy`, the energy below which a column comes to
        rest.

    Returns
    -------
    Assessment
        Its data: "columns" and "records", their properties; "verdicts" over column, record, dissipation, vertical and
        scale: `overturned` (1, 0, −1 not decided), `outcome`, `tilt_ratio`, contact demand; "margins" over
        column, case, record and interval; "variations" over column, record and scale; "sliding" over
        column, record and scale, "slip_margins" over column, record and scale of the scan, and "slip_paths"; "planar";
        "fragility" over column if there are enough records; "rates" over column with a hazard curve; "histories" over
        column and run, under the governing record of each column; "summary", counts;
        "practice" over column, record, scale and rule, the answers of `stylobate.practice.rules_of_practice`;
        "spectra" over record and period, "ground_motions" over record and instant, for the figures of the report.

    Raises
    ------
    ParameterError
        If an argument is out of range, or dissipation or friction are not stated.
    Interrupted
        On Ctrl-C; the parts that were computed are in the store.

    Warns
    -----
    UnlikelyInputWarning
        For a column of more than 60 m, and for records whose names differ by case only.

    Notes
    -----
    Records are sorted by name, and columns are computed separately: the order of both changes no result.

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> column = sb.Slender(sb.Column.solid(radius=0.4, height=4.0, density=2700.0))
    >>> pulse = sb.Pulse.one_sine(acceleration=2.5, angular_frequency=4.0)
    >>> found = sb.earthquakes.assess(
    ...     {"column": column},
    ...     {"pulse": pulse},
    ...     dissipation={"low": {"damping": 0.01}, "central": {"damping": 0.05}, "high": {"damping": 0.1}},
    ...     friction_coefficient=0.6,
    ...     margin_scales=np.linspace(0.5, 3.0, 11),
    ...     variations=0,
    ...     planar=False,
    ...     contact=False,
    ... )
    >>> found.data["verdicts"]["overturned"].sel(vertical="with", scale=1.0).values
    array([[[1, 1, 1]]], dtype=int8)
    """
    require_no_limits(options)
    details = details or ReportDetails()
    for text in (title, *notes):
        require_printable("title or notes: a text", text)
    inputs = Inputs.of(
        columns,
        records,
        dissipation,
        friction_coefficient,
        scales,
        np.geomspace(0.2, 5.0, 300) if margin_scales is None else margin_scales,
        contact_laws=contact_laws,
        variations=require_variations(variations),
        seed=require_whole("seed", seed, least=0, most=LARGEST_SEED),
        limit_states=limit_states,
        friction_dispersion=require_not_negative("friction_dispersion", friction_dispersion),
        width=require_positive("width", width),
        tail=tail,
        least_records=require_whole("least_records", least_records, least=2),
        options=options,
    )
    remark_on({name: levels[CENTRAL].column for name, levels in inputs.columns.items()}, inputs.records)
    parts = Parts(
        None if store is None else Path(store), _runs(inputs, planar=planar, sliding=sliding), report_of(progress)
    )
    names = list(inputs.columns)
    verdicts = [verdicts_on(inputs, name, parts, contact=contact, executor=executor) for name in names]
    margins = [margins_of(inputs, name, parts, contact=contact, executor=executor) for name in names]
    data = {
        "columns": column_properties(inputs),
        "records": record_properties(inputs),
        "spectra": spectra_of(inputs, parts, details.spectral_period),
        "ground_motions": ground_motions(inputs),
        "verdicts": _over_columns(verdicts, names),
        "margins": _over_columns(of_one_width(margins), names),
        "practice": _over_columns(practice_of(inputs), names),
    }
    if inputs.variations:
        data["variations"] = _over_columns([shares_of(inputs, name, parts, executor=executor) for name in names], names)
    states = [one["reached"] for one in margins]
    if sliding and inputs.sliding_first:
        slips = [slip_margins_of(inputs, name, parts) for name in names]
        data["sliding"] = _over_columns([sliding_of(inputs, name, parts) for name in names], names)
        data["slip_margins"] = _over_columns(slips, names)
        data["slip_paths"] = slip_paths_of(inputs, names)
        states = [states_with_slip(inputs, *one) for one in zip(names, states, slips, strict=True)]
    if planar:
        data["planar"] = _over_columns([planar_of(inputs, name, parts, executor=executor) for name in names], names)
    if len(inputs.records) >= inputs.least_records:
        peaks = data["records"]["median_peak_acceleration"]
        about = IntensityMeasure(Intensity.PEAK_ACCELERATION)
        data["fragility"] = _over_columns(
            [_fragility_of(*_observed(one.isel(margin_scale=inputs.scanned), peaks, about)) for one in states],
            names,
        )
    if hazard is not None:
        data["rates"] = _over_columns(
            [_rates_of(inputs, name, one, hazard, years) for name, one in zip(names, states, strict=True)],
            names,
        )
    governing = [governing_record(one, other, inputs.as_recorded) for one, other in zip(verdicts, margins, strict=True)]
    runs = [
        histories_of(inputs, name, record, own, parts, contact=contact)
        for name, record, own in zip(names, governing, margins, strict=True)
    ]
    data["histories"] = _over_columns(runs, names)
    data["summary"] = summary_of(data, governing)
    parts.report()
    more: dict[str, Any] = {
        "title": title,
        "notes": list(notes),
        "contact": contact,
        "sliding": sliding,
        "resolution": margins[0].attrs["resolution"],
    }
    if hazard is not None:
        more["hazard"] = {"quantity": hazard.quantity, "component": hazard.component, "origin": hazard.origin}
        more |= {"years": require_positive("years", years, "a"), "target_rate": target_rate}
    today = dt.datetime.now().astimezone().date().isoformat()
    more["details"] = {**details.values(), "date": details.date or today}
    return Assessment(data=data, setting={**_setting(inputs), **more})


def _runs(inputs: Inputs, *, planar: bool, sliding: bool) -> int:
    each = verdict_runs(inputs) + margin_runs(inputs) + 3
    each += share_runs(inputs)
    each += planar_runs(inputs) if planar else 0
    slips = sliding_runs(inputs) + slip_margin_runs(inputs) if sliding else 0
    return each * len(inputs.columns) + slips


def _over_columns(found: Sequence[xr.Dataset], names: Sequence[str]) -> xr.Dataset:
    joined: xr.Dataset = xr.concat(
        list(found),
        dim=xr.Variable("column", list(names)),
        data_vars="all",
        join="outer",
        combine_attrs="drop_conflicts",
    )
    return joined


def _setting(inputs: Inputs) -> dict[str, Any]:
    """Return the settings of the assessment as plain values."""
    return {
        "version": version("stylobate"),
        "software": {
            **{name: version(name) for name in _PACKAGES},
            "Python": platform.python_version(),
            "machine": f"{platform.system()} {arithmetic()}",
        },
        "columns": {
            name: {
                part: provenance_of_run(levels[CENTRAL], motion)[part]
                for motion in (next(iter(inputs.records.values())),)
                for part in ("column", "model")
            }
            for name, levels in inputs.columns.items()
        },
        "records": {
            name: {
                "processing": list(motion.provenance) if isinstance(motion, Record) else [exact_repr(motion)],
                "digest": motion.digest if isinstance(motion, Record) else "",
                "motion": provenance_of_run(next(iter(inputs.columns.values()))[CENTRAL], motion)["motion"],
            }
            for name, motion in inputs.records.items()
        },
        "dissipation": {
            name: {level: dict(numbers) for level, numbers in levels.items()}
            for name, levels in inputs.dissipation.items()
        },
        "friction_coefficient": dict(inputs.friction),
        "friction_dispersion": inputs.friction_dispersion,
        "limit_states": {
            name: [
                {"response": one.kind.value, "limit": one.limit, "height": one.height, "name": one.name}
                for one in limits
            ]
            for name, limits in inputs.limits.items()
        },
        "scales": inputs.scales.tolist(),
        "margin_scales": [float(inputs.margin_scales[0]), float(inputs.margin_scales[-1]), inputs.margin_scales.size],
        "width": inputs.width,
        "tail": "20/p" if inputs.tail is None else inputs.tail,
        "tail_over_p": FREE_TAIL,
        "contact_laws": inputs.contact_laws,
        "variations": inputs.variations,
        "seed": inputs.seed,
        "least_records": inputs.least_records,
        "options": {name: repr(value) for name, value in inputs.options.items() if value is not None},
    }


_RESAMPLES, _COUNTED = 200, 2000
_SEED = 0


def _observed(
    reached: xr.DataArray, intensity: xr.DataArray, measure: IntensityMeasure
) -> tuple[xr.DataArray, xr.DataArray, xr.DataArray]:
    """Return intensity, state and record of the runs of one column.

    Parameters
    ----------
    reached
        Over `record`, `limit_state` and `margin_scale`: 1 reached, 0 not reached, −1 undecided.
    intensity
        Intensity of the unscaled records, over `record`.
    measure
        The intensity measure.
    """
    names = reached["record"].to_numpy()
    scales = reached["margin_scale"].to_numpy()
    values = np.multiply.outer(intensity.sel(record=names).to_numpy(), scales)
    states = xr.DataArray(
        reached.transpose(LIMIT_STATE, "record", "margin_scale").to_numpy(),
        dims=(LIMIT_STATE, "record", "scale"),
        coords={LIMIT_STATE: reached[LIMIT_STATE].to_numpy()},
    )
    levels = xr.DataArray(values, dims=("record", "scale"), attrs=measure.attributes)
    return levels, states, xr.DataArray(names, dims="record")


def _fragility_of(intensity: xr.DataArray, states: xr.DataArray, record: xr.DataArray) -> xr.Dataset:
    """Fit the fragility of one column."""
    return fit_fragility(intensity, states, record=record, resamples=_RESAMPLES, rng=np.random.default_rng(_SEED))


def _rates_of(inputs: Inputs, name: str, reached: xr.DataArray, hazard: HazardCurve, years: float) -> xr.Dataset:
    """Compute the annual rates of one column: counted from its runs, and by a fitted curve if records are many."""
    component = hazard.component or HorizontalComponent.ROTD50
    measure = IntensityMeasure.named(hazard.quantity, component)
    column = inputs.columns[name][CENTRAL].column
    each = [measure.of(inputs.records[str(one)], column) for one in reached["record"].to_numpy()]
    intensity = xr.DataArray(each, dims="record", coords={"record": reached["record"]})
    observed = _observed(reached, intensity, measure)
    counted = empirical_rate(
        *observed[:2],
        hazard,
        record=observed[2],
        years=years,
        resamples=_COUNTED,
        rng=np.random.default_rng(_SEED),
    ).drop_vars(["record_rate", "record"])
    if len(inputs.records) < inputs.least_records:
        return counted
    scanned = _observed(reached.isel(margin_scale=inputs.scanned), intensity, measure)
    fitted = annual_rate(_fragility_of(*scanned), hazard, years=years)["annual_rate"]
    return counted.assign(fitted_rate=fitted)


_ACTS = "with"


def summary_of(data: Mapping[str, xr.Dataset], governing: list[str]) -> xr.Dataset:
    """Count the records by their outcomes, and collect the extreme results over them.

    Parameters
    ----------
    data
        The parts of an assessment.
    governing
        Governing record of each column.

    Returns
    -------
    xarray.Dataset
        Over `column` and `scale`, numbers of records: `overturned`, `undecided` and `stood` in the central case
        (central dissipation with the vertical component); `overturned_in_some`, `undecided_in_some` and
        `uncertain_in_some` in at least one case; `on_dissipation` and `on_vertical`, with a verdict that depends on
        dissipation or vertical component; `overturned_other_law`, overturned with the other contact law at some level;
        `in_band`, with an overturning scale within 10 %; `variations_disagree`, overturned by some small variations
        but not by all; `undecided_word`, undecided under small variations; `planar_differs`, with another outcome
        of the planar column. Also `peak_tilt_ratio`; `friction_demand`, the largest of all runs, and over `record` too
        `friction_by_record`.

        Over `column`: `governing`; `least_overturning`, the smallest overturning scale of the central case, NaN if
        none, and its record `least_record`, empty if none; `least_of_all`, the smallest of all cases; of the cases with
        the given contact law: `friction_to_margin`, the largest, `least_slipping`, the smallest, and `slips_first`,
        whether in some case a record needs more than the stated friction below the smallest overturning scale; of the
        cases with the other contact law `least_slipping_other_law`, the smallest, NaN if none; `slides_first`,
        whether the stated friction is below r/h, so that the column slides before it rocks. Numbers of records in the
        central case: `never_overturned`, `stands_again`, and `scan_undecided`, with undecided runs in
        the scan of the margin; `decided_to`, the largest scale up to which all runs of the central case were decided,
        NaN if the first scale was not.
    """
    verdicts, margins = data["verdicts"], data["margins"]
    fallen = verdicts["overturned"]
    central = fallen.sel(dissipation=CENTRAL, vertical=_ACTS, drop=True)
    counts = {
        "stood": (central == 0).sum("record"),
        "overturned": (central == 1).sum("record"),
        "undecided": (central < 0).sum("record"),
        "overturned_in_some": (fallen == 1).any(("dissipation", "vertical")).sum("record"),
        "undecided_in_some": (fallen < 0).any(("dissipation", "vertical")).sum("record"),
        "uncertain_in_some": (verdicts["uncertain"] == 1).any(("dissipation", "vertical")).sum("record"),
        "on_dissipation": _differs(fallen.sel(vertical=_ACTS, drop=True), "dissipation"),
        "on_vertical": _differs(fallen.sel(dissipation=CENTRAL, drop=True), "vertical"),
    }
    others = margins["case"].str.endswith(OTHER_LAW)
    own_law, other_law = margins.isel(case=~others), margins.isel(case=others)
    if bool(others.any()):
        law = states_at_scales(margins, verdicts["scale"]).where(others, drop=True)
        counts["overturned_other_law"] = (law == 1).any("case").sum("record")
    counts["in_band"] = (margins["in_band"] > 0).any("case").sum("record")
    if "variations" in data:
        shares = data["variations"]
        counts["variations_disagree"] = ((shares["overturned"] > 0) & (shares["overturned"] < shares["runs"])).sum(
            "record"
        )
        counts["undecided_word"] = (shares["word"] == "undecided").sum("record")
    if "planar" in data:
        tilts = data["planar"]["planar_tilt_ratio"]
        decided = (central >= 0) & tilts.notnull()
        counts["planar_differs"] = (decided & (np.isinf(tilts) != (central == 1))).sum("record")
    tilt = verdicts["tilt_ratio"].sel(dissipation=CENTRAL, vertical=_ACTS, drop=True)
    least = margins["least_overturning"]
    central_margins = margins.sel(case=CENTRAL, drop=True)
    return xr.Dataset(
        {
            **counts,
            "peak_tilt_ratio": tilt.max("record"),
            "friction_demand": verdicts["friction_demand"].max(("record", "dissipation", "vertical")),
            "friction_by_record": verdicts["friction_demand"].max(("dissipation", "vertical")),
            "governing": ("column", governing),
            "least_overturning": central_margins["least_overturning"].min("record"),
            "least_record": ("column", _least_records(central_margins)),
            "least_of_all": least.min(("record", "case")),
            "friction_to_margin": own_law["friction_to_margin"].max(("record", "case")),
            "least_slipping": own_law["least_slipping"].min(("record", "case")),
            "least_slipping_other_law": other_law["least_slipping"].reduce(_least, ("record", "case")),
            "slips_first": _slips_first(own_law).any(("record", "case")).astype(np.int8),
            "slides_first": margins["standing_slip"].notnull().any(("record", "case")).astype(np.int8),
            "never_overturned": (central_margins["intervals"] == 0).sum("record"),
            "stands_again": (central_margins["stands_again"] > 0).sum("record"),
            "scan_undecided": (central_margins["unknown"] > 0).sum("record"),
            "decided_to": central_margins["decided_to"].min("record", skipna=False),
        }
    ).transpose("column", ...)


def _least_records(margins: xr.Dataset) -> list[str]:
    """Return the record with the smallest overturning scale of each column; the first by name among equals."""
    least = margins["least_overturning"].transpose("column", "record").to_numpy()
    names = margins["record"].to_numpy()
    return [str(names[np.nanargmin(row)]) if np.isfinite(row).any() else "" for row in least]


def _least(values: npt.NDArray[np.float64], axis: tuple[int, ...]) -> Any:
    """Return the minimum of the numbers, also of none; NaN without any."""
    least = np.fmin.reduce(values, axis=axis, initial=np.inf)
    return np.where(np.isinf(least), np.nan, least)


def _slips_first(margins: xr.Dataset) -> xr.DataArray:
    """Return whether a scale below the smallest overturning scale (if any) needs more than the stated friction."""
    slipping, falling = margins["least_slipping"], margins["least_overturning"]
    return slipping.notnull() & ~(slipping >= falling)


def _differs(states: xr.DataArray, dim: str) -> xr.DataArray:
    return ((states == 1).any(dim) & (states == 0).any(dim)).sum("record")
