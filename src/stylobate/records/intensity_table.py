"""Intensity measures of several records in one table, in one definition of the horizontal component."""

import math
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.base_motions.record import Record
from stylobate.base_motions.signal_processing import Floats, filtered, integrals
from stylobate.errors import ParameterError, as_numbers, require_positive
from stylobate.records.intensities import (
    HorizontalComponent,
    arias_intensity,
    cumulative_absolute_velocity,
    horizontal_peak,
    significant_duration,
)
from stylobate.records.spectra import response_spectra

_DIRECTIONS = np.radians(np.arange(0.0, 180.0, 5.0))
# FIV3: window over the period, corner of the filter [Hz] and its order, how many extremes are added, and how far one
# stands out at least.
_WINDOW, _CORNER, _ORDER, _EXTREMES, _RIPPLE = 0.7, 1.0, 2, 3, 1e-6
# Average spectral acceleration: first and last period over the period, and number of periods.
_FIRST, _LAST, _PERIODS = 0.2, 3.0, 10

_QUANTITIES = {
    "pga": ("m s-2", 1, "peak ground acceleration"),
    "pgv": ("m s-1", 1, "peak ground velocity"),
    "pgv_over_pga": ("s", 0, "peak ground velocity over peak ground acceleration"),
    "sa": ("m s-2", 1, "spectral pseudo-acceleration"),
    "sa_avg": ("m s-2", 1, "average spectral pseudo-acceleration"),
    "fiv3": ("m s-1", 1, "filtered incremental velocity"),
    "cav": ("m s-1", 1, "cumulative absolute velocity"),
    "arias": ("m s-1", 2, "Arias intensity"),
    "duration_5_95": ("s", 0, "significant duration 5-95 %"),
}
"""Unit of each measure, the power of the scale factor with which it grows, and its name."""


def intensity_table(
    records: Record | Iterable[Record],
    *,
    period: float = 1.0,
    damping: float = 0.05,
    component: str | HorizontalComponent = HorizontalComponent.ROTD50,
    scales: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Compute intensity measures of records, one number for the horizontal motion of each.

    Parameters
    ----------
    records
        One record or several.
    period
        Natural period T of the oscillator [s].
    damping
        Its damping ratio.
    component
        Definition of the horizontal component: "RotD50", "RotD100", "geometric mean" or "larger component". The
        measure of a record along one straight line is that along the line.
    scales
        Scale factors; with them each measure is that of the scaled records. Shape (m,).

    Returns
    -------
    xarray.Dataset
        Along `record` (and `scale`): `pga` [m/s²], `pgv` [m/s], `pgv_over_pga` [s]; `sa` at T and `sa_avg`, the
        geometric mean at ten periods from 0.2 T to 3 T [m/s²]; `fiv3` of T [m/s], `cav` [m/s], `arias` [m/s],
        `duration_5_95` [s]. The attribute `power` is the power of the scale factor with which a measure grows.

    Raises
    ------
    ParameterError
        If there is no record, a number is not positive, or half the sampling rate of a record is below 1 Hz.

    Notes
    -----
    FIV3, filtered incremental velocity (H. Dávalos and E. Miranda, Earthquake Engng Struct. Dyn. 48, 2019): the
    acceleration passes a causal Butterworth filter of second order with the corner 1 Hz, fixed as by H. Dávalos, P.
    Heresi and E. Miranda (Soil Dyn. Earthquake Eng. 139, 2020); its integral over 0.7 T from each time on has maxima
    and minima; FIV3 is the larger of the sums of the three highest maxima and of the three lowest minima. RotD50 and
    RotD100 of `fiv3`, `cav`, `arias` and the duration are over directions 5° apart, of the other measures 1°.

    Examples
    --------
    >>> from stylobate.records import sample_record
    >>> found = intensity_table(sample_record(), component="RotD100")
    >>> [round(float(found[name][0]), 2) for name in ("pga", "pgv", "fiv3")]
    [3.47, 0.61, 1.1]
    """
    each = [records] if isinstance(records, Record) else list(records)
    if not each or not all(isinstance(one, Record) for one in each):
        raise ParameterError(f"records: must be a Record or several (got {records!r}). Read files by read_records.")
    definition, period = HorizontalComponent.named(component), require_positive("period", period, "s")
    rows = [_measures(one, period, damping, definition) for one in each]
    factors = None if scales is None else np.ravel(as_numbers("scales", scales))
    data: dict[str, Any] = {}
    for name, (units, power, long_name) in _QUANTITIES.items():
        values = np.array([row[name] for row in rows])
        attributes = {"units": units, "long_name": long_name, "power": power}
        if factors is None:
            data[name] = (("record",), values, attributes)
        else:
            data[name] = (("record", "scale"), values[:, np.newaxis] * factors**power, attributes)
    coords = {"record": [one.name for one in each]} | ({} if factors is None else {"scale": factors})
    return xr.Dataset(data, coords=coords, attrs={"component": definition.value, "period": period, "damping": damping})


def _measures(record: Record, period: float, damping: float, component: HorizontalComponent) -> dict[str, float]:
    along = _Horizontal(record, component)
    pga, pgv = (along.peak(order) for order in (ACCELERATION, VELOCITY))
    psa = along.spectral(period * np.array([1.0, *np.geomspace(_FIRST, _LAST, _PERIODS)]), damping)
    return {
        "pga": pga,
        "pgv": pgv,
        "pgv_over_pga": pgv / pga,
        "sa": float(psa[0]),
        "sa_avg": float(np.exp(np.mean(np.log(psa[1:])))),
        "fiv3": along.measure(lambda one: filtered_incremental_velocity(one.samples[:, 0], one.step, period)),
        "cav": along.measure(_cav),
        "arias": along.measure(_arias),
        "duration_5_95": along.measure(_duration),
    }


class HorizontalRow(NamedTuple):
    """Measures of the horizontal motion of a record: medians over the directions, and some maxima.

    Parameters
    ----------
    record
        Name of the record.
    pga_rotd50, pga_rotd100, sa_rotd50, sa_rotd100
        Peak ground acceleration, and spectral pseudo-acceleration at the period [m/s²].
    pgv_rotd50, pgv_rotd100, cav, arias, fiv3
        Peak ground velocity, cumulative absolute velocity, Arias intensity, filtered incremental velocity [m/s].
    duration_5_95
        Significant duration [s].
    """

    record: str
    pga_rotd50: float
    pga_rotd100: float
    pgv_rotd50: float
    pgv_rotd100: float
    sa_rotd50: float
    sa_rotd100: float
    cav: float
    arias: float
    duration_5_95: float
    fiv3: float


def horizontal_row(record: Record, period: float, damping: float = 0.05) -> HorizontalRow:
    """Compute the measures of the horizontal motion of a record; see `intensity_table`.

    Parameters
    ----------
    record
        The record.
    period
        Natural period of the oscillator [s].
    damping
        Its damping ratio.

    Raises
    ------
    ParameterError
        If the record does not move horizontally, or half its sampling rate is below 1 Hz.
    """
    median, largest = (_Horizontal(record, one) for one in (HorizontalComponent.ROTD50, HorizontalComponent.ROTD100))
    at = np.array([period])
    pga, pgv = ([one.peak(order) for one in (median, largest)] for order in (ACCELERATION, VELOCITY))
    return HorizontalRow(
        record=record.name,
        pga_rotd50=pga[0],
        pga_rotd100=pga[1],
        pgv_rotd50=pgv[0],
        pgv_rotd100=pgv[1],
        sa_rotd50=float(median.spectral(at, damping)[0]),
        sa_rotd100=float(largest.spectral(at, damping)[0]),
        cav=median.measure(_cav),
        arias=median.measure(_arias),
        duration_5_95=median.measure(_duration),
        fiv3=median.measure(lambda one: filtered_incremental_velocity(one.samples[:, 0], one.step, period)),
    )


def horizontal_spectrum(record: Record, periods: Floats, damping: float, component: HorizontalComponent) -> Floats:
    """Compute the spectrum of the horizontal motion of a record, one number for each period [m/s²].

    Raises
    ------
    ParameterError
        If the record does not move horizontally.
    """
    return _Horizontal(record, component).spectral(periods, damping)


def _cav(one: Record) -> float:
    return float(cumulative_absolute_velocity(one)[0])


def _arias(one: Record) -> float:
    return float(arias_intensity(one)[0])


def _duration(one: Record) -> float:
    return float(significant_duration(one)[0])


class _Horizontal:
    """The horizontal motion of a record: measures of one component, combined to one number by a definition."""

    def __init__(self, record: Record, component: HorizontalComponent) -> None:
        self._record, self._component = record, component
        directions = record.directions()
        if not directions:
            raise ParameterError(f"records: must move horizontally (got {record!r}). Leave it out.")
        self._line = math.atan2(directions[0][1], directions[0][0]) if len(directions) == 1 else None

    def peak(self, order: int) -> float:
        """Return the peak of the acceleration or the velocity."""
        return horizontal_peak(self._record, order, self._component)

    def measure(self, of_one: Callable[[Record], float]) -> float:
        """Combine a measure of one component, called with a record whose component is x."""
        if self._line is not None:
            return of_one(self._along(self._line))
        match self._component:
            case HorizontalComponent.GEOMETRIC_MEAN:
                return math.sqrt(of_one(self._along(0.0)) * of_one(self._along(0.5 * math.pi)))
            case HorizontalComponent.LARGER:
                return max(of_one(self._along(0.0)), of_one(self._along(0.5 * math.pi)))
        each = [of_one(self._along(float(angle))) for angle in _DIRECTIONS]
        return float(np.median(each) if self._component is HorizontalComponent.ROTD50 else max(each))

    def spectral(self, periods: Floats, damping: float) -> Floats:
        """Combine pseudo-accelerations, shape of `periods` [m/s²]."""
        if self._line is not None:
            return response_spectra(self._along(self._line), periods, damping=damping)["psa"].to_numpy()[:, 0]
        spectra = response_spectra(self._record, periods, damping=damping)
        match self._component:
            case HorizontalComponent.LARGER:
                return spectra["psa"].sel(axis=["x", "y"]).max("axis").to_numpy()
            case HorizontalComponent.GEOMETRIC_MEAN:
                return spectra["geometric_mean"].to_numpy()
            case HorizontalComponent.ROTD50:
                return spectra["rotd50"].to_numpy()
        return spectra["rotd100"].to_numpy()

    def _along(self, angle: float) -> Record:
        samples = np.zeros_like(self._record.samples)
        samples[:, 0] = self._record.samples[:, :2] @ [math.cos(angle), math.sin(angle)]
        return Record(samples=samples, step=self._record.step)


def filtered_incremental_velocity(acceleration: Floats, step: float, period: float) -> float:
    """Compute FIV3 of one component with samples of shape (n,) [m/s²]; zeros before and after it belong to it [m/s]."""
    from scipy.signal import find_peaks

    if step >= 0.5 / _CORNER:
        raise ParameterError(f"records: must have steps below {0.5 / _CORNER:g} s for FIV3 (got {step!r} s).")
    window = _WINDOW * period
    rest = np.zeros(math.ceil((window + 1.0 / _CORNER) / step) + 1)
    extended = np.concatenate([rest, acceleration, rest])[:, np.newaxis]
    passed, _ = filtered(extended, step, lowpass=_CORNER, order=_ORDER, causal=True)
    velocity = integrals(passed, step)[0][:, 0]
    times = step * np.arange(len(velocity))
    gained = np.interp(times + window, times, velocity) - velocity
    # on a plateau, which a window longer than a pulse has, ripples by rounding are no maxima
    least = _RIPPLE * float(np.abs(gained).max())
    sums = []
    for side in (gained, -gained):
        maxima = np.sort(side[find_peaks(side, prominence=least)[0]])[-_EXTREMES:]
        sums.append(float(np.maximum(maxima, 0.0).sum()))
    return max(sums)
