"""A fragility study from its description: runs, fits, dispersion, and annual rates by the hazard curve of a site."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self, Unpack

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.earthquakes.config.fragility import FragilitySetup
from stylobate.earthquakes.config.hazard import HazardPoints
from stylobate.earthquakes.fragility import Counting, HazardCurve, annual_rate, dispersion_parts
from stylobate.earthquakes.fragility.annual_rate import require_same_component
from stylobate.earthquakes.fragility.fit import fragility_of_runs
from stylobate.earthquakes.incremental import incremental_dynamic_analysis
from stylobate.earthquakes.intensities import Intensity, IntensityMeasure, SpectralAcceleration
from stylobate.earthquakes.property_spreads import Spread, property_samples
from stylobate.earthquakes.study_inputs import remark_on
from stylobate.errors import ParameterError
from stylobate.models import Model
from stylobate.progress import shows_progress
from stylobate.records.intensities import HorizontalComponent
from stylobate.results.verdict import damping_yardstick
from stylobate.run_arguments import RunOptions, takes
from stylobate.studies.study import Computing

_OVERTURNING = "overturning"
_LEAST = 2
# Streams of random numbers from one seed.
_OF_SAMPLES, _OF_RESAMPLES, _OF_PARTS = range(3)


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
        Distributions of properties, and the number of samples drawn; none without spreads.
    seed
        Seed of all random numbers.
    counting, confidence, resamples
        As for `fit_fragility`.
    hazard
        Hazard curve, in `intensity` and `component`.
    years
        Time for which probabilities are stated.
    options
        Options of all runs.
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
    options: RunOptions

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
            options=RunOptions(**setup.options),  # type: ignore[typeddict-item]
        )

    @shows_progress("incremental dynamic analysis")
    @takes(Computing)
    def runs(self, **run: Unpack[Computing]) -> xr.Dataset:
        """Run the incremental dynamic analysis, with the samples of the properties; arguments as in `run_sweep`."""
        remark_on({"column": self.model.column}, self.records)
        samples = None
        if self.spreads:
            rng = self._stream(_OF_SAMPLES)
            samples = property_samples(self.model, self.spreads, count=self.samples, rng=rng)
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
            **run,
            **self.options,
        )
        return found.assign_attrs(self._yardstick())

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
        return found.assign_attrs(self._yardstick())

    def parts(self, runs: xr.Dataset, limit_state: str = _OVERTURNING) -> xr.Dataset | None:
        """Split the dispersion into records and properties; None if the data do not suffice.

        The runs must have one rotation, one choice of the vertical component, and at least two records, two samples
        and two scales.
        """
        sizes = [runs.sizes.get(name, 1) for name in ("record", "property_sample", "scale")]
        if min(sizes) < _LEAST or any(name in runs.dims for name in ("rotation", "vertical")):
            return None
        reached = runs["reached"].sel(limit_state=limit_state)
        plain = reached.drop_vars([name for name in reached.coords if name not in reached.dims])
        level = runs["intensity"].drop_vars([name for name in runs["intensity"].coords if name not in reached.dims])
        rng = self._stream(_OF_PARTS)
        return dispersion_parts(level, plain, confidence=self.confidence, rng=rng).assign_attrs(limit_state=limit_state)

    def rates(self, fits: xr.Dataset) -> xr.Dataset | None:
        """Compute annual rates of the limit states; None without a hazard."""
        return None if self.hazard is None else annual_rate(fits, self.hazard, years=self.years)

    def _yardstick(self) -> dict[str, list[float]]:
        """Return Housner's damping of the column at each peak tilt, in tipping angles."""
        found = damping_yardstick(self.model.column)
        return {"housner_damping": list(found.values()), "housner_amplitudes": list(found)}

    def _stream(self, place: int) -> np.random.Generator:
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(place,)))


_UNITS = {"m s-2": "m/s²", "m s-1": "m/s", "1": "1"}
_FIRST_LINE = "“PGA RotD50 [g], annual rate [1/a]”"
_DAMPING = ", 5 % damping"  # hazard curves with another damping are refused


def site_hazard(points: HazardPoints, intensity: IntensityMeasure) -> HazardCurve:
    """Build the hazard curve through `points`.

    Raises
    ------
    ParameterError
        If the points have another intensity, horizontal component or unit than `intensity`, lack one of these, or are
        no hazard curve.
    """
    quantity = intensity.quantity
    _require_unit(points, intensity)
    if not points.measure and quantity.units != "1":
        named = (
            f"Name it in the first line of {points.source}, such as {_FIRST_LINE}, or give" if points.source else "Give"
        )
        raise ParameterError(
            f'fragility.hazard: intensity measure not stated. {named} measure, such as "PGA" or "SA(0.5 s)".'
        )
    measure = points.measure + (_DAMPING if points.measure.startswith("spectral") else "")
    if measure and measure != quantity.value:
        raise ParameterError(
            f"fragility.hazard uses {measure!r}, but the fragility uses {quantity.value!r}. Provide both for "
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
        raise ParameterError(
            f"fragility.{error}" if str(error).startswith("hazard:") else f"fragility.hazard: {error}"
        ) from None


def _require_unit(points: HazardPoints, intensity: IntensityMeasure) -> None:
    units, name = intensity.quantity.units, intensity.quantity.value
    if points.units == units or (points.units is None and units == "1"):
        return
    if points.units is None:
        where = f"name it in the first line of {points.source}, such as" if points.source else "give units, such as"
        example = f"{_FIRST_LINE}, or give units" if points.source else 'units = "g"'
        raise ParameterError(f"fragility.hazard does not state the unit of its intensity; {where} {example}")
    raise ParameterError(
        f"fragility.hazard uses an intensity in {_UNITS[points.units]}, but the fragility uses {name!r} in "
        f"{_UNITS[units]}. Provide both for the same intensity measure."
    )
