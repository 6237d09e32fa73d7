"""Selection of records by their spectra: each is scaled to a target, and those that fit best are chosen.

With the periods T_i, spaced evenly on a logarithmic axis, the factor of a record is the one with the least squares of
the logarithms, within bounds; its misfit is their root mean square::

    ln f = mean_i ln(S_target(T_i)/S(T_i)),    misfit² = mean_i ln²(f S(T_i)/S_target(T_i))               (1)

This is the mean squared error by which the PEER Ground Motion Database scales and ranks records.
"""

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr

from stylobate.base_motions import Record
from stylobate.errors import ParameterError, require_positive, require_whole
from stylobate.quantities import cf_attributes
from stylobate.records.intensities import HorizontalComponent
from stylobate.records.intensity_table import horizontal_spectrum
from stylobate.results.report_details import DesignSpectrum
from stylobate.text import did_you_mean

_PERIODS = 60
_PAIR = 2


def select_records(
    records: Iterable[Record],
    target: DesignSpectrum,
    *,
    number: int,
    periods: Sequence[float] = (0.2, 2.0),
    scales: Sequence[float] = (0.25, 4.0),
    without: Sequence[str] = (),
    component: str | HorizontalComponent = HorizontalComponent.ROTD50,
) -> xr.Dataset:
    """Scale records to a target spectrum, and choose those with the least misfit, (1).

    Parameters
    ----------
    records
        Candidates; their names must differ.
    target
        Target spectrum. Between its points it is linear, as design spectra are drawn.
    number
        Number of records to choose.
    periods
        Shortest and longest period of the fit [s].
    scales
        Least and largest factor of a record.
    without
        Names of candidates that are not to be chosen.
    component
        Horizontal component of the spectra: "RotD50", "RotD100", "geometric mean" or "larger component".

    Returns
    -------
    xarray.Dataset
        Of kind "record selection". Over `record`, in the order of the misfit: `scale`; `misfit`; `chosen`; `at_bound`,
        whether the factor is at a bound. Over `period`: `target`, and the arithmetic `mean` of the chosen spectra
        [m/s²]. Over both: `spectral_acceleration` of the scaled records [m/s²]. Attributes: `mean_misfit`, and
        `least_ratio` and `largest_ratio` of mean over target.

    Raises
    ------
    ParameterError
        If there are fewer candidates than `number`, names repeat or are unknown, a range does not rise, or the target
        does not cover the periods.

    Examples
    --------
    >>> from stylobate.records import sample_record
    >>> quake = sample_record()
    >>> target = DesignSpectrum(period=(0.1, 1.0, 3.0), acceleration=(8.0, 5.0, 1.5))
    >>> found = select_records([quake], target, number=1)
    >>> print(f"{found['scale'].item():.3f} {found['misfit'].item():.3f}")
    1.304 0.264
    """
    candidates, definition = list(records), HorizontalComponent.named(component)
    names = [one.name for one in candidates]
    _require_names(names, without)
    taken = [one for one in candidates if one.name not in without]
    count = require_whole("number", number, least=1)
    if count > len(taken):
        raise ParameterError(f"number must be at most {len(taken)}, the number of candidates, got {count}")
    first, last = _range("periods", periods, "s")
    least, largest = _range("scales", scales)
    if not target.period[0] <= first < last <= target.period[-1]:
        raise ParameterError(
            f"periods must lie within those of the target, {target.period[0]:g} s to {target.period[-1]:g} s, got "
            f"{first:g} s to {last:g} s"
        )
    natural = np.geomspace(first, last, _PERIODS)
    wanted = np.interp(natural, target.period, target.acceleration)
    if np.any(wanted <= 0.0):
        raise ParameterError(f"target must be positive between {first:g} s and {last:g} s")
    spectra = np.array([horizontal_spectrum(one, natural, target.damping, definition) for one in taken])
    factors = np.clip(np.exp(np.log(wanted / spectra).mean(axis=1)), least, largest)
    scaled = factors[:, np.newaxis] * spectra
    misfit = np.sqrt((np.log(scaled / wanted) ** 2).mean(axis=1))
    order = np.argsort(misfit, kind="stable")
    chosen = np.arange(len(order)) < count
    mean = scaled[order][chosen].mean(axis=0)
    ratio = mean / wanted
    of_spectrum = cf_attributes("m s-2", f"spectral acceleration, {definition.value}")
    return xr.Dataset(
        {
            "scale": ("record", factors[order], cf_attributes("1", "factor of the record")),
            "misfit": ("record", misfit[order], cf_attributes("1", "misfit, root mean square of logarithms")),
            "chosen": ("record", chosen, {"long_name": "chosen"}),
            "at_bound": ("record", np.isin(factors[order], (least, largest)), {"long_name": "factor at a bound"}),
            "target": ("period", wanted, cf_attributes("m s-2", target.name)),
            "mean": ("period", mean, cf_attributes("m s-2", "mean of the chosen records")),
            "spectral_acceleration": (("record", "period"), scaled[order], of_spectrum),
        },
        coords={
            "record": [taken[place].name for place in order],
            "period": ("period", natural, cf_attributes("s", "natural period")),
        },
        attrs={
            "kind": "record selection",
            "component": definition.value,
            "damping": target.damping,
            "mean_misfit": float(np.sqrt((np.log(ratio) ** 2).mean())),
            "least_ratio": float(ratio.min()),
            "largest_ratio": float(ratio.max()),
        },
    )


def _require_names(names: Sequence[str], without: Sequence[str]) -> None:
    if not names:
        raise ParameterError("records: none were given. Read files by read_records")
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ParameterError(f"records: two of them are called {twice[0]!r}. Rename one")
    for name in without:
        if name not in names:
            question = did_you_mean(name, names)
            raise ParameterError(f"without: no record has this name (got {name!r}). {question or 'Remove it'}")


def _range(name: str, values: Sequence[float], unit: str = "") -> tuple[float, float]:
    if len(values) != _PAIR:
        raise ParameterError(f"{name} must be two numbers, the least and the largest, got {values!r}")
    low, high = (require_positive(name, value, unit) for value in values)
    if low >= high:
        raise ParameterError(f"{name} must rise, got {low:g} to {high:g}")
    return low, high
