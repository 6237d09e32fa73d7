"""Peak acceleration, velocity and displacement of a record, exact for linear interpolation."""

import math

import numpy as np

from stylobate.base_motions.base import ACCELERATION, DISPLACEMENT, VELOCITY
from stylobate.base_motions.records.horizontal_components import HorizontalComponent
from stylobate.base_motions.records.record import Floats, Record


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
