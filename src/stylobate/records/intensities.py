"""Intensity measures of records: horizontal components, peaks, energy, duration, and measures for rocking."""

import math
import re
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stylobate.base_motions.base import ACCELERATION, DISPLACEMENT, VELOCITY
from stylobate.base_motions.record import AXES, Record
from stylobate.base_motions.signal_processing import Floats, energy
from stylobate.column import Column
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr

_DEGREES = np.arange(180)


class HorizontalComponent(Enum):
    """Definition of one peak for the two horizontal components of a motion.

    D. M. Boore, "Orientation-independent, nongeometric-mean measures of seismic intensity from two horizontal
    components of motion", BSSA 100 (2010).
    """

    ROTD50 = "RotD50"
    """The median over all horizontal directions, 1° apart, of the peak along each."""
    ROTD100 = "RotD100"
    """The maximum over all directions: the peak of the horizontal vector."""
    GEOMETRIC_MEAN = "geometric mean"
    """√(peak along x · peak along y), of the components as recorded."""
    LARGER = "larger component"
    """The larger of the peaks along x and y, as recorded."""

    @classmethod
    def named(cls, name: "str | HorizontalComponent", argument: str = "component") -> "HorizontalComponent":
        """Find the definition with this name; letter case and spaces do not matter.

        Raises
        ------
        ParameterError
            If the name is not known; the message names the `argument`.

        Examples
        --------
        >>> HorizontalComponent.named("rotd50"), HorizontalComponent.named("vector")
        (<HorizontalComponent.ROTD50: 'RotD50'>, <HorizontalComponent.ROTD100: 'RotD100'>)
        """
        if isinstance(name, HorizontalComponent):
            return name
        plain = "".join(str(name).lower().split())
        found = next((one for one in cls if "".join(one.value.lower().split()) == plain), _ALIASES.get(plain))
        if found is None:
            known = ", ".join(repr(one.value) for one in cls)
            raise ParameterError(
                f"{argument}: unknown definition of the horizontal component (got {name!r}). Use one of {known}."
            )
        return found

    def peak(self, x: Floats, y: Floats) -> float:
        """Compute the peak of horizontal values (x, y), two arrays of one length, in this definition.

        Examples
        --------
        >>> angle = np.linspace(0.0, 2.0 * np.pi, 2001)
        >>> straight = np.cos(angle), np.zeros(2001)
        >>> [round(one.peak(*straight), 4) for one in HorizontalComponent]  # cos 45° of the peak, …
        [0.7071, 1.0, 0.0, 1.0]
        """
        match self:
            case HorizontalComponent.ROTD50:
                return float(over_directions(x, y, (50.0,))[0])
            case HorizontalComponent.ROTD100:
                return float(np.hypot(x, y).max())
            case HorizontalComponent.GEOMETRIC_MEAN:
                return math.sqrt(float(np.abs(x).max() * np.abs(y).max()))
            case HorizontalComponent.LARGER:
                return float(max(np.abs(x).max(), np.abs(y).max()))


_ALIASES = {
    "vector": HorizontalComponent.ROTD100,
    "vectormaximum": HorizontalComponent.ROTD100,
    "geomean": HorizontalComponent.GEOMETRIC_MEAN,
    "gm": HorizontalComponent.GEOMETRIC_MEAN,
    "larger": HorizontalComponent.LARGER,
}


def over_directions(x: Floats, y: Floats, percentiles: tuple[float, ...]) -> Floats:
    """Return `percentiles` over the directions, 1° apart, of the peak projection of (x, y)."""
    from scipy.spatial import ConvexHull, QhullError

    points = np.stack([x, y], axis=-1)
    try:  # only corners of the hull can be farthest
        corners = points[ConvexHull(points).vertices]
    except QhullError:  # all on one line: its ends
        corners = points[[x.argmin(), x.argmax(), y.argmin(), y.argmax()]]
    angles = np.radians(_DEGREES)
    largest = np.abs(corners @ np.stack([np.cos(angles), np.sin(angles)])).max(axis=0)
    return np.asarray(np.percentile(largest, percentiles))


def peak_acceleration(record: Record) -> Floats:
    """Compute sup |a| along x, y and z, shape (3,) [m/s²]."""
    return np.asarray(np.abs(record.samples).max(axis=0))


def peak_velocity(record: Record) -> Floats:
    """Compute sup |v| along x, y and z up to the last sample, shape (3,) [m/s]: at the ends or where a = 0."""
    return np.array([_largest(record, axis, VELOCITY, _rests(record, axis)) for axis in range(3)])


def peak_displacement(record: Record) -> Floats:
    """Compute sup |d| along x, y and z up to the last sample, shape (3,) [m]: at the ends or where v = 0."""
    return np.array([_largest(record, axis, DISPLACEMENT, _turns(record, axis)) for axis in range(3)])


def horizontal_peak(record: Record, order: int, component: HorizontalComponent, *, since: float = -math.inf) -> float:
    """Compute the peak horizontal acceleration [m/s²] or velocity [m/s] of a record up to its last sample.

    Parameters
    ----------
    record
        The record. A record along a straight line has one horizontal component, whose peak counts in every definition.
    order
        ACCELERATION, exact; or VELOCITY, from eight values per step, with an error of at most step·sup |a|/256.
    component
        Definition of the horizontal component.
    since
        Start of the time interval of the peak [s].
    """
    if len(record.directions()) < 2:  # noqa: PLR2004  along one line
        component = HorizontalComponent.ROTD100
    count = len(record.samples) - 1
    times = record.times if order == ACCELERATION else record.start + record.step * np.arange(8 * count + 1) / 8
    x, y, _ = record.derivative(np.maximum(times, since), order)
    return component.peak(x, y)


def _largest(record: Record, axis: int, order: int, inside: Floats) -> float:
    times = np.concatenate([record.times, inside])
    return float(np.abs(record.derivative(times, order)[axis]).max())


def _rests(record: Record, axis: int) -> Floats:
    """Return the times between samples at which the acceleration is zero."""
    a = record.samples[:, axis]
    changes = np.flatnonzero(a[:-1] * a[1:] < 0.0)
    return np.asarray(record.times[changes] + record.step * a[changes] / (a[changes] - a[changes + 1]))


def _turns(record: Record, axis: int) -> Floats:
    """Return the times between samples at which the velocity v + a s + slope s²/2 is zero."""
    a = record.samples[:, axis]
    v = record.derivative(record.times, VELOCITY)[axis][:-1]
    slope = np.diff(a) / record.step
    a = a[:-1]
    inside = a**2 - 2.0 * slope * v
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -(a + np.copysign(np.sqrt(inside), a))  # without cancellation; NaN where v keeps its sign
        roots = np.stack([q / slope, 2.0 * v / q])
    times = record.times[:-1] + roots
    return np.asarray(times[(roots > 0.0) & (roots < record.step)])


_ONSET, _MIDDLE_END, _END = 0.05, 0.75, 0.95


def intensity_measures(record: Record) -> "xr.Dataset":
    """Compute the intensity measures of each component and of the horizontal motion.

    Returns
    -------
    xarray.Dataset
        Along `axis`, the axes x, y and z with acceleration: `pga` [m/s²], `pgv` [m/s], `pgd` [m], the peak absolute
        values; `pgv_over_pga` [s]; `residual_velocity` [m/s] at the last sample, and `residual_velocity_ratio`, the
        absolute residual velocity over `pgv`; `arias` [m/s]; `cav` [m/s]; `duration_5_75`, `duration_5_95` [s]. Along
        `component` (RotD50, RotD100, geometric mean or larger): `horizontal_pga` [m/s²], `horizontal_pgv` [m/s].

    Notes
    -----
    Exact for accelerations linear between samples, from the first sample to the last. Arias intensity is
    I = π/(2g) ∫ a² dt (Arias 1970), g standard gravity; cumulative absolute velocity ∫ |a| dt (EPRI 1988, without
    threshold); significant duration is the time from 5 % to 75 % or 95 % of I (Trifunac and Brady 1975). A
    `residual_velocity_ratio` above about 0.05 indicates drift: filter the record before you use its PGV or PGD.

    Examples
    --------
    >>> from stylobate.records import sample_record
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
    import xarray as xr

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


def rocking_measures(record: Record, column: Column) -> "xr.Dataset":
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
    import xarray as xr

    return xr.Dataset(
        {
            name: ("axis", np.asarray(values), {"units": "1", "long_name": long_name})
            for name, (values, long_name) in named.items()
        },
        coords={"axis": measures.axis.values},
        attrs=measures.attrs,
    )


_CLAUSE = re.compile(r"(?:^|; |: )([xyz]) (.*?from [^;]*)")
_FILE = re.compile(r"read from (.*?), in ")
_DONE = re.compile(r"trimmed to|padded with zeros to|resampled from")
# Final velocity over peak velocity above which a record has a baseline error or was cut.
_RESIDUAL = 0.05


class ComponentRow(NamedTuple):
    """Values of one component of a record in SI units, except `pga_g` [g]; `origin` is its file and direction."""

    record: str
    axis: str
    origin: str
    samples: int
    step: float
    pga: float
    pga_g: float
    pgv: float
    pgd: float
    arias: float
    duration_5_95: float
    residual_velocity: float


_MEASURES = ("pga", "pgv", "pgd", "arias", "duration_5_95", "residual_velocity")


def component_rows(record: Record) -> list[ComponentRow]:
    """Compute the values of each component of a record with acceleration.

    Examples
    --------
    >>> from stylobate.records import sample_record
    >>> [(row.axis, round(row.pga, 2), round(row.duration_5_95, 2)) for row in component_rows(sample_record())]
    [('x', 3.42, 24.48), ('y', 2.1, 24.56), ('z', 2.06, 20.34)]
    """
    measures = intensity_measures(record)
    origins = origins_of(record)
    rows = []
    for axis in record.axes:
        own = measures.sel(axis=axis)
        one = {name: float(own[name]) for name in _MEASURES}
        rows.append(
            ComponentRow(
                record=record.name,
                axis=axis,
                origin=origins.get(axis, ""),
                samples=len(record.samples),
                step=record.step,
                pga_g=one["pga"] / STANDARD_GRAVITY,
                **one,
            )
        )
    return rows


def origins_of(record: Record) -> dict[str, str]:
    """Return file and direction of each component by axis, from the provenance of a record."""
    found = {axis: clause for line in record.provenance for axis, clause in _CLAUSE.findall(line)}
    files = files_of(record)
    return found or dict.fromkeys(record.axes, f"from {files[0]}" if files else "")


def files_of(record: Record) -> list[str]:
    """Return the names of the files of a record."""
    return [name for line in record.provenance for name in _FILE.findall(line)]


def drifts(record: Record) -> list[tuple[str, float]]:
    """Return the axes whose velocity after the last sample exceeds 5 % of PGV, with this fraction."""
    shares = [(row.axis, abs(row.residual_velocity) / row.pgv) for row in component_rows(record) if row.pgv]
    return [(axis, share) for axis, share in shares if share > _RESIDUAL]


def notes_on(record: Record) -> list[str]:
    """Return one line for each adjustment of components and for each large residual velocity."""
    notes = [f"{record.name}: {line}" for line in record.provenance if _DONE.search(line)]
    notes += [
        f"{record.name}: along {axis} the velocity after the last sample is {100.0 * share:.0f} % of PGV. Correct the "
        "baseline or filter before you use PGD"
        for axis, share in drifts(record)
    ]
    return notes
