"""Intensity measures of records: peaks, energy, duration, and measures for rocking."""

import math

import numpy as np
import xarray as xr

from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.base_motions.records.horizontal_components import HorizontalComponent
from stylobate.base_motions.records.knots import energy
from stylobate.base_motions.records.peaks import horizontal_peak, peak_acceleration, peak_displacement, peak_velocity
from stylobate.base_motions.records.record import AXES, Floats, Record
from stylobate.column import STANDARD_GRAVITY, Column

_ONSET, _MIDDLE_END, _END = 0.05, 0.75, 0.95


def intensity_measures(record: Record) -> xr.Dataset:
    """Compute the intensity measures of each component and of the horizontal motion.

    Returns
    -------
    xarray.Dataset
        Along `axis`, the axes x, y and z with acceleration: `pga` [m/s²], `pgv` [m/s], `pgd` [m], the peak absolute
        values; `pgv_over_pga` [s]; `residual_velocity` [m/s] at the last sample, and `residual_velocity_ratio`, the
        absolute residual velocity over `pgv`; `arias` [m/s]; `cav` [m/s]; `duration_5_75`, `duration_5_95` [s]. Along
        `component`, the definitions of `HorizontalComponent`: `horizontal_pga` [m/s²], `horizontal_pgv` [m/s].

    Notes
    -----
    Exact for accelerations linear between samples, from the first sample to the last. Arias intensity is
    I = π/(2g) ∫ a² dt (Arias 1970), g standard gravity; cumulative absolute velocity ∫ |a| dt (EPRI 1988, without
    threshold); significant duration is the time from 5 % to 75 % or 95 % of I (Trifunac and Brady 1975). A
    `residual_velocity_ratio` above about 0.05 indicates drift: filter the record before you use its PGV or PGD.

    Examples
    --------
    >>> from stylobate.base_motions.records import sample_record
    >>> measures = intensity_measures(sample_record())
    >>> measures.pga.round(3).values, measures.pgv.round(3).values
    (array([3.42, 2.1 , 2.06]), array([0.385, 0.488, 0.138]))
    >>> measures.horizontal_pga.sel(component="RotD50").round(2).item()
    2.51
    """
    chosen = [AXES.index(axis) for axis in record.axes]
    pga, pgv = peak_acceleration(record), peak_velocity(record)
    left = record.residual_velocity
    with np.errstate(invalid="ignore"):
        ratio, left_over = pgv / pga, np.abs(left) / pgv
    measures = {
        "pga": (pga, "m s-2", "peak ground acceleration"),
        "pgv": (pgv, "m s-1", "peak ground velocity"),
        "pgd": (peak_displacement(record), "m", "peak ground displacement"),
        "pgv_over_pga": (ratio, "s", "peak velocity over peak acceleration"),
        "residual_velocity": (left, "m s-1", "velocity at the last sample"),
        "residual_velocity_ratio": (left_over, "1", "velocity at the last sample over peak ground velocity"),
        "arias": (arias_intensity(record), "m s-1", "Arias intensity"),
        "cav": (cumulative_absolute_velocity(record), "m s-1", "cumulative absolute velocity"),
        "duration_5_75": (significant_duration(record, _ONSET, _MIDDLE_END), "s", "significant duration 5-75 %"),
        "duration_5_95": (significant_duration(record, _ONSET, _END), "s", "significant duration 5-95 %"),
    }
    horizontal = {"pga": ACCELERATION, "pgv": VELOCITY}
    return xr.Dataset(
        {
            **{
                name: ("axis", values[chosen], {"units": units, "long_name": long_name})
                for name, (values, units, long_name) in measures.items()
            },
            **{
                f"horizontal_{name}": (
                    "component",
                    [horizontal_peak(record, order, one) for one in HorizontalComponent],
                    {"units": measures[name][1], "long_name": f"horizontal {measures[name][2]}"},
                )
                for name, order in horizontal.items()
            },
        },
        coords={"axis": list(record.axes), "component": [one.value for one in HorizontalComponent]},
        attrs={"record": record.name, "digest": record.digest},
    )


def arias_intensity(record: Record) -> Floats:
    """Compute the Arias intensity I = π/(2g) ∫ a² dt along x, y and z, shape (3,) [m/s]."""
    return np.asarray(math.pi / (2.0 * STANDARD_GRAVITY) * energy(record.samples, record.step)[-1])


def cumulative_absolute_velocity(record: Record) -> Floats:
    """Compute the cumulative absolute velocity ∫ |a| dt along x, y and z, shape (3,) [m/s]."""
    left, right = np.abs(record.samples[:-1]), np.abs(record.samples[1:])
    size = left + right
    crosses = record.samples[:-1] * record.samples[1:] < 0.0
    # two triangles if a changes its sign, otherwise a trapezium
    twice = np.where(crosses, (left**2 + right**2) / np.where(size > 0.0, size, 1.0), size)
    return np.asarray(0.5 * record.step * twice.sum(axis=0))


def significant_duration(record: Record, begin: float = _ONSET, end: float = _END) -> Floats:
    """Compute the time in which ∫ a² dt grows from the fraction `begin` to `end` of its total, shape (3,) [s].

    Zero without acceleration.
    """
    grown = energy(record.samples, record.step)
    return np.array(
        [
            _reached(record, grown[:, axis], axis, end) - _reached(record, grown[:, axis], axis, begin)
            if grown[-1, axis] > 0.0
            else 0.0
            for axis in range(3)
        ]
    )


def _reached(record: Record, grown: Floats, axis: int, part: float) -> float:
    """Return the time at which ∫ a² dt along an axis reaches a fraction of its total: root of a cubic in a step [s]."""
    target = part * grown[-1]
    knot = min(max(int(np.searchsorted(grown, target)) - 1, 0), len(grown) - 2)
    a, b = (float(record.samples[at, axis]) for at in (knot, knot + 1))
    wanted = (target - grown[knot]) / record.step
    # ∫ (a + (b − a) s)² ds = a² s + a (b − a) s² + (b − a)² s³/3
    roots = np.polynomial.Polynomial([-wanted, a * a, a * (b - a), (b - a) ** 2 / 3.0]).roots()
    real = roots[np.abs(roots.imag) <= np.abs(roots.imag).min()].real
    inside = real[np.argmin(np.abs(real - np.clip(real, 0.0, 1.0)))]
    return float(record.step * (knot + np.clip(inside, 0.0, 1.0)))


def rocking_measures(record: Record, column: Column) -> xr.Dataset:
    """Compute the dimensionless intensity measures of the horizontal motion for the rocking of `column`.

    Returns
    -------
    xarray.Dataset
        `acceleration_ratio` = PGA/(g tan α): above 1 the motion can cause uplift; `velocity_ratio` = p PGV/(g tan α);
        `duration_ratio` = p D5-95. Along `axis`, the horizontal components.

    Notes
    -----
    tan α = r/h is `column.slenderness`, p = √(m g R/K) is `column.frequency_parameter`, g the column's gravity. After
    Dimitrakopoulos and Paraskeva, "Dimensionless fragility curves for rocking response to near-fault excitations",
    Earthquake Engng Struct. Dyn. 44, 2015.
    """
    measures = intensity_measures(record)
    measures = measures.sel(axis=[axis for axis in record.axes if axis != "z"])
    strength = column.gravity * column.slenderness
    p = column.frequency_parameter
    named = {
        "acceleration_ratio": (measures.pga / strength, "PGA/(g tan α)"),
        "velocity_ratio": (p * measures.pgv / strength, "p PGV/(g tan α)"),
        "duration_ratio": (p * measures.duration_5_95, "p D5-95"),
    }
    return xr.Dataset(
        {
            name: ("axis", np.asarray(values), {"units": "1", "long_name": long_name})
            for name, (values, long_name) in named.items()
        },
        coords={"axis": measures.axis.values},
        attrs=measures.attrs,
    )
