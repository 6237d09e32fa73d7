"""A fragility study from its description: runs, fits, dispersion, annual rates by the hazard of a site, and table."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self, Unpack

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.earthquakes.config.fragility import FragilitySetup
from stylobate.earthquakes.config.hazard import HazardPoints
from stylobate.earthquakes.fragility import Counting, HazardCurve, annual_rate, dispersion_parts, empirical_rate
from stylobate.earthquakes.fragility.annual_rate import require_same_component
from stylobate.earthquakes.fragility.displacement_limits import LimitState
from stylobate.earthquakes.fragility.empirical_rate import compared_with_target
from stylobate.earthquakes.fragility.fit import fragility_of_runs
from stylobate.earthquakes.incremental import incremental_dynamic_analysis
from stylobate.earthquakes.intensities import Intensity, IntensityMeasure, SpectralAcceleration
from stylobate.earthquakes.property_spreads import Spread, inertia_spreads, property_samples
from stylobate.earthquakes.slip_study import KIND as SLIP_ANALYSIS
from stylobate.earthquakes.slip_study import slip_analysis
from stylobate.earthquakes.study_inputs import remark_on
from stylobate.errors import ParameterError
from stylobate.models import Model, Sliding
from stylobate.progress import shows_progress
from stylobate.records.intensities import HorizontalComponent
from stylobate.results.tables import ResultTable, model_named, number_of_runs
from stylobate.results.verdict import damping_yardstick, few_records, yardstick_text
from stylobate.run_arguments import RunOptions, takes
from stylobate.studies.study import Computing
from stylobate.text import plural

_OVERTURNING = "overturning"
_LEAST = 2
# Streams of random numbers from one seed.
_OF_SAMPLES, _OF_RESAMPLES, _OF_PARTS, _OF_RATE = range(4)


@dataclass(frozen=True, slots=True, kw_only=True)
class FragilityStudy:
    """A fragility study: records, scales and uncertain properties, and the fits to the runs.

    Parameters
    ----------
    model, records
        Model of the column, and base motions by name.
    scales, rotations, vertical, tail, intensity, component
        As for `incremental_dynamic_analysis`.
    spreads, samples
        Distributions of properties, and the number of samples drawn; estimated moments of inertia have theirs.
    seed
        Seed of all random numbers.
    counting, confidence, resamples
        As for `fit_fragility`.
    hazard
        Hazard curve, in `intensity` and `component`.
    years
        Time for which probabilities are stated.
    target_rate
        Annual rate that is accepted [1/a], or None.
    options
        Options of all runs.
    limit_states
        Limits of the displacement. With the model `Sliding` they are those of `slip_analysis`.
    """

    model: Model
    records: Mapping[str, BaseMotion]
    scales: tuple[float, ...]
    rotations: tuple[float, ...] = (0.0,)
    vertical: tuple[bool, ...] = (True,)
    tail: float | None = None
    intensity: Intensity | SpectralAcceleration = Intensity.PEAK_ACCELERATION
    component: HorizontalComponent = HorizontalComponent.ROTD50
    spreads: Mapping[str, Spread]
    samples: int = 0
    seed: int = 0
    counting: Counting = Counting.AS_COMPUTED
    confidence: float = 0.95
    resamples: int = 1000
    hazard: HazardCurve | None = None
    years: float = 50.0
    target_rate: float | None = None
    options: RunOptions
    limit_states: tuple[LimitState, ...] = ()

    @classmethod
    def of(cls, setup: FragilitySetup) -> Self:
        """Build the study of a description.

        Raises
        ------
        ParameterError
            If the intensity is unknown, the hazard is invalid or uses another intensity, or a spread is invalid.
        """
        table = setup.table
        spectral = None if isinstance(table.intensity, str) else table.intensity
        measure = table.intensity if spectral is None else SpectralAcceleration(spectral.period, spectral.damping)
        intensity = IntensityMeasure.named(measure, table.component)  # type: ignore[arg-type]
        return cls(
            model=setup.model,
            records=setup.records,
            scales=setup.scales,
            rotations=table.rotations,
            vertical=table.vertical,
            tail=table.tail,
            intensity=intensity.quantity,
            component=intensity.component,
            spreads={name: spread.build() for name, spread in table.spreads.items()},
            samples=table.samples,
            seed=table.seed,
            counting=Counting(table.counting),
            confidence=table.confidence,
            resamples=table.resamples,
            hazard=None if setup.hazard is None else site_hazard(setup.hazard, intensity),
            years=table.years,
            target_rate=table.target_rate,
            options=RunOptions(**setup.options),  # type: ignore[typeddict-item]
            limit_states=setup.limit_states,
        )

    @shows_progress("incremental dynamic analysis")
    @takes(Computing)
    def runs(self, **run: Unpack[Computing]) -> xr.Dataset:
        """Run the incremental dynamic analysis, with the samples of the properties; arguments as in `run_sweep`."""
        remark_on({"column": self.model.column}, self.records)
        samples, own = None, inertia_spreads(self.model.column)
        if self.samples:
            rng = self._stream(_OF_SAMPLES)
            spreads = {**self.spreads, **{name: one for name, one in own.items() if name not in self.spreads}}
            samples = property_samples(self.model, spreads, count=self.samples, rng=rng)
        if self.limit_states and isinstance(self.model, Sliding):
            return self._slips(self.model, samples, run)
        found = incremental_dynamic_analysis(
            self.model,
            self.records,
            scales=self.scales,
            rotations=self.rotations,
            vertical=self.vertical,
            parameters=samples,
            tail=self.tail,
            intensity=self.intensity,
            component=self.component,
            limit_states=self.limit_states,
            **run,
            **self.options,
        )
        return found.assign_attrs(self._yardstick())

    def _slips(self, model: Sliding, samples: Mapping[str, Any] | None, run: Computing) -> xr.Dataset:
        """Compute the slip of a column that slides before it rocks; a rotation of the records changes no limit state.

        Raises
        ------
        ParameterError
            If a store is given: the analysis keeps none.
        """
        if run.get("store") is not None:
            raise ParameterError(
                f"store: slip analyses keep none (got {str(run['store'])!r}). Write the result to a file that ends "
                "with .nc."
            )
        return slip_analysis(
            model,
            self.records,
            scales=self.scales,
            limit_states=self.limit_states,
            vertical=self.vertical,
            parameters=samples,
            intensity=self.intensity,
            component=self.component,
            progress=run.get("progress"),
        )

    def fits(self, runs: xr.Dataset) -> xr.Dataset:
        """Fit the fragility of each limit state; with two records or more, intervals are a bootstrap over records."""
        several = runs.sizes.get("record", 1) >= _LEAST
        found = fragility_of_runs(
            runs,
            counting=self.counting,
            confidence=self.confidence,
            resamples=self.resamples if several else 0,
            rng=self._stream(_OF_RESAMPLES),
        )
        return found if runs.attrs["kind"] == SLIP_ANALYSIS else found.assign_attrs(self._yardstick())

    def parts(self, runs: xr.Dataset, limit_state: str | None = None) -> xr.Dataset | None:
        """Split the dispersion into records and properties; None if the data do not suffice.

        The runs must have one rotation, one choice of the vertical component, and at least two records, two samples
        and two scales. The limit state is overturning by default, and the first one of slip.
        """
        slips = runs.attrs["kind"] == SLIP_ANALYSIS
        limit_state = limit_state or (str(runs["limit_state"].to_numpy()[0]) if slips else _OVERTURNING)
        sizes = [runs.sizes.get(name, 1) for name in ("record", "property_sample", "scale")]
        if min(sizes) < _LEAST or any(name in runs.dims for name in ("rotation", "vertical")):
            return None
        reached = runs["reached"].sel(limit_state=limit_state)
        plain = reached.drop_vars([name for name in reached.coords if name not in reached.dims])
        level = runs["intensity"].drop_vars([name for name in runs["intensity"].coords if name not in reached.dims])
        rng = self._stream(_OF_PARTS)
        return dispersion_parts(level, plain, confidence=self.confidence, rng=rng).assign_attrs(limit_state=limit_state)

    def rates(self, runs: xr.Dataset, fits: xr.Dataset) -> xr.Dataset | None:
        """Compute annual rates of the limit states, by the fitted curves and counted; None without a hazard."""
        if self.hazard is None:
            return None
        counted = empirical_rate(
            runs["intensity"],
            runs["reached"],
            self.hazard,
            record=runs["record"],
            property_sample=runs["property_sample"] if "property_sample" in runs.dims else None,
            years=self.years,
            confidence=self.confidence,
            resamples=self.resamples,
            rng=self._stream(_OF_RATE),
        )
        fitted = annual_rate(fits, self.hazard, years=self.years)
        names = {
            name: f"counted_{name}" for name in ("annual_rate", "rate_low", "rate_high", "rate_least", "rate_most")
        }
        own = {"target_rate": self.target_rate} if self.target_rate is not None else {}
        return fitted.merge(counted[[*names]].rename(names)).assign_attrs(own)

    def _yardstick(self) -> dict[str, list[float]]:
        """Return Housner's damping of the column at each peak tilt, in tipping angles."""
        found = damping_yardstick(self.model.column)
        return {"housner_damping": list(found.values()), "housner_amplitudes": list(found)}

    def _stream(self, place: int) -> np.random.Generator:
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(place,)))


_UNITS = {"m s-2": "m/s²", "m s-1": "m/s", "1": "1"}
_FIRST_LINE = "“PGA RotD50 [g], annual rate [1/a]”"


def site_hazard(points: HazardPoints, intensity: IntensityMeasure, where: str = "fragility.hazard") -> HazardCurve:
    """Build the hazard curve through `points`; `where` is its place in a description, for messages.

    Raises
    ------
    ParameterError
        If the points have another intensity, horizontal component or unit than `intensity`, lack one of these, or are
        no hazard curve.
    """
    quantity = intensity.quantity
    _require_unit(points, intensity, where)
    if not points.measure and quantity.units != "1":
        named = (
            f"Name it in the first line of {points.source}, such as {_FIRST_LINE}, or give" if points.source else "Give"
        )
        raise ParameterError(f'{where}: intensity measure not stated. {named} measure, such as "PGA" or "SA(0.5 s)".')
    if points.measure and points.measure != quantity.value:
        raise ParameterError(
            f"{where} uses {points.measure!r}, but the fragility uses {quantity.value!r}. Provide both for "
            "the same intensity measure."
        )
    common: dict[str, Any] = {"units": quantity.units, "quantity": quantity.value, "component": points.component}
    try:
        require_same_component(intensity.component.value, points.component)
        if points.investigation_time is None:
            return HazardCurve(intensity=points.intensity, rate=points.exceedance, **common)
        time = points.investigation_time
        return HazardCurve.of_probabilities(points.intensity, points.exceedance, investigation_time=time, **common)
    except ParameterError as error:
        raise ParameterError(f"{where}: {str(error).removeprefix('hazard: ')}") from None


def _require_unit(points: HazardPoints, intensity: IntensityMeasure, place: str) -> None:
    units, name = intensity.quantity.units, intensity.quantity.value
    if points.units == units or (points.units is None and units == "1"):
        return
    if points.units is None:
        where = f"name it in the first line of {points.source}, such as" if points.source else "give units, such as"
        example = f"{_FIRST_LINE}, or give units" if points.source else 'units = "g"'
        raise ParameterError(f"{place} does not state the unit of its intensity; {where} {example}")
    raise ParameterError(
        f"{place} uses an intensity in {_UNITS[points.units]}, but the fragility uses {name!r} in "
        f"{_UNITS[units]}. Provide both for the same intensity measure."
    )


def plain_fits(
    runs: xr.Dataset, fits: xr.Dataset, parts: xr.Dataset | None, rates: xr.Dataset | None
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
            for amplitude, damping in zip(
                fits.attrs.get("housner_amplitudes", ()), fits.attrs.get("housner_damping", ()), strict=True
            )
        ],
        "dispersion_parts": None if parts is None else {name: float(parts[name]) for name in _PARTS},
        "intervals": fits.attrs["intervals"],
        "confidence": fits.attrs["confidence"],
        "counting": fits.attrs["counting"],
        "computed": int(runs["computed"]),
        "runs": runs["outcome"].size,
        "provenance": json.loads(runs.attrs["provenance"]),
    }


_ENDS = ("", "_low", "_high")
_PARTS = [
    f"{name}_dispersion{end}" for name in ("total", "record", "property", "joint") for end in _ENDS
]  # as from dispersion_parts


_OF_COUNTED = tuple(f"counted_{name}" for name in ("annual_rate", "rate_low", "rate_high", "rate_least", "rate_most"))
_OF_RATES = ("annual_rate", "rate_low", "rate_high", "probability", "share_beyond", *_OF_COUNTED)


def _row(fits: xr.Dataset, rates: xr.Dataset | None, place: int) -> dict[str, Any]:
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


def table_of_fits(
    runs: xr.Dataset, fits: xr.Dataset, parts: xr.Dataset | None, rates: xr.Dataset | None
) -> ResultTable:
    """Make a table of the fits: a row for each limit state, and remarks."""
    units = str(fits["median"].attrs.get("units"))
    in_g = ["median [g]"] if units == "m s-2" else []
    header = ["limit state", f"median{_BRACKETED.get(units, '')}", *in_g, "dispersion", "reached", "not monotonic"]
    if rates is not None:
        header += ["per year, fitted", "per year, counted", f"in {rates.attrs['years']:g} years"]
    rows = [_row(fits, rates, place) for place in range(fits.sizes["limit_state"])]
    over = " × ".join(plural(runs.sizes[dim], str(dim).replace("_", " ")) for dim in runs["outcome"].dims)
    title = f"{number_of_runs(runs, f': {over}')}; {model_named(runs)}; over the {runs.attrs['intensity']}"
    percent = f"{100.0 * float(fits.attrs['confidence']):g} %"
    worst, records = int(fits["non_monotone_records"].max()), runs["record"].size
    few = few_records(records)
    remarks = [
        f"{percent} intervals: {fits.attrs['intervals']}; runs counted {fits.attrs['counting']}",
        *(
            [f"damping of Housner's impacts: {yardstick_text(fits.attrs['housner_damping'])}"]
            if "housner_damping" in fits.attrs
            else ["slip of a column that slides before it rocks; damping has no effect"]
        ),
        *([few] if few else []),
    ]
    if worst > 0:
        remarks.append(
            f"not monotonic: {worst} of {records} records survive at a scale above one that reached a limit state"
        )
    if parts is not None:
        remarks.append(describe_parts(parts))
    if rates is not None:
        remarks += [*_of_hazard(rates), *_remarks_on_rates(rows), *_against_target(rates, rows)]
    return ResultTable(title, header, [_cells(row, in_g=bool(in_g)) for row in rows], remarks)


_BRACKETED = {"m s-2": " [m/s²]", "m s-1": " [m/s]"}


def _between(row: Mapping[str, Any]) -> str:
    """Write the interval of a median without estimate: empty if it has no ends."""
    low, high = row["median_low"], row["median_high"]
    if math.isfinite(low) and math.isfinite(high):
        return f"between {_short(low)} and {_short(high)}"
    return f"{_short(low)} to {_short(high)}"


def _cells(row: Mapping[str, Any], *, in_g: bool) -> list[str]:
    fitted = row["status"] == "fitted"
    median, dispersion = (
        f"{_short(row[f'{name}_low'])} to {_short(row[f'{name}_high'])}" for name in ("median", "dispersion")
    )
    unknown = f", {row['runs_not_known']} not known" if row["runs_not_known"] else ""
    cells = [
        row["name"],
        f"{_short(row['median'])}, {median}"
        if fitted
        else f"{row['status']}{', ' * (row['status'] == 'separated')}{_between(row)}",
        *([_short(row["median"] / STANDARD_GRAVITY) if fitted else ""] if in_g else ()),
        f"{_short(row['dispersion'])}, {dispersion}" if fitted else "",
        f"{row['runs_reached']} of {row['runs']}{unknown}",
        f"{row['non_monotone_records']}" if row["non_monotone_records"] > 0 else "",
    ]
    if "annual_rate" in row:
        cells += _rate_cells(row)
    return cells


def _rate_cells(row: Mapping[str, Any]) -> list[str]:
    """Write the annual rates and the probability; a rate may be withheld."""
    rate, low, high = (row[name] for name in _OF_COUNTED[:3])
    counted = f"{rate:.2e}" + (f", {low:.1e} to {high:.1e}" if math.isfinite(low) else "")
    if row["rate_withheld"]:
        return ["withheld", counted, "withheld"]
    if not math.isfinite(row["annual_rate"]):
        return ["", counted, ""]
    return [f"{row['annual_rate']:.2e}", counted, _percent(row["probability"])]


def _percent(probability: float) -> str:
    """Return a probability in percent with two digits, and "> 99.9 %" near certainty.

    >>> _percent(0.036), _percent(0.5), _percent(0.9999), _percent(1.0)
    ('3.6 %', '50 %', '> 99.9 %', '> 99.9 %')
    """
    if probability > _NEARLY_CERTAIN:
        return "> 99.9 %"
    return f"{100.0 * probability:.2g} %" if probability < _MANY else f"{100.0 * probability:.1f} %"


_MANY, _NEARLY_CERTAIN = 0.95, 0.999


def _of_hazard(rates: xr.Dataset) -> list[str]:
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


def _against_target(rates: xr.Dataset, rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """State for each limit state whether its annual rate is below the target, by the interval of the counted rate."""
    target = rates.attrs.get("target_rate")
    if target is None:
        return []
    counted = [(row["name"], *(float(row[name]) for name in _OF_COUNTED[:3])) for row in rows]
    return [f"{name}: {compared_with_target(rate, low, high, target)}" for name, rate, low, high in counted]


def _short(value: float) -> str:
    return f"{value:.3g}"


def describe_parts(parts: xr.Dataset) -> str:
    """Describe in a line the parts of the dispersion due to records and to properties."""
    state = str(parts.attrs.get("limit_state", _OVERTURNING))
    reach = "overturn" if state == _OVERTURNING else f"reach {state}"
    what = f"dispersion of the minimum scales that {reach}"
    if not math.isfinite(float(parts["total_dispersion"])):
        reasons = {
            "reached_at_once": f"{reach} at the first scale",
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
