"""Properties of columns and records of an assessment, response spectra, ground motions and rules of practice."""

import math

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.base_motions.record import AXES
from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs, Parts, identities
from stylobate.earthquakes.intensities import has_two_components, horizontal_peak, peak_horizontal_velocity
from stylobate.earthquakes.practice_study import answers_of
from stylobate.practice.shaking import Shaking
from stylobate.progress import Report
from stylobate.records import response_spectra
from stylobate.records.intensities import HorizontalComponent, drifts
from stylobate.results.verdict import AMPLITUDES, damping_yardstick, side_of_yardstick
from stylobate.studies.sweeps.designs import Floats

ROTD50, ONE_COMPONENT = HorizontalComponent.ROTD50.value, "one component"
"""Definitions of a horizontal intensity: the median over all directions; the only component of a record."""

# Number of samples of a motion that is no record; maximum number of points of a drawn record.
_SAMPLES, _DRAWN = 4001, 2000
_PERIODS = np.concatenate(
    [
        [0.05, 0.075, 0.1, 0.12, 0.15, 0.17, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8],
        [0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 2.0, 2.2, 2.5, 2.8, 3.0, 3.5, 4.0, 4.5, 5.0],
    ]
)
_DAMPING = 0.05


def as_record(motion: BaseMotion) -> Record:
    """Return the motion as a record: itself, or sampled at 4001 times up to its end."""
    if isinstance(motion, Record):
        return motion
    step = motion.duration / (_SAMPLES - 1)
    return Record(samples=motion.acceleration(step * np.arange(_SAMPLES)), step=step)


def horizontal_peaks(motion: BaseMotion) -> tuple[str, float, float]:
    """Return the definition, PGA [m/s²] and PGV [m/s] of the horizontal motion.

    A motion along one straight line has the peaks of its only component.
    """
    definition = ROTD50 if has_two_components(motion) else ONE_COMPONENT
    acceleration, velocity = (
        horizontal_peak(motion, order, HorizontalComponent.ROTD50) for order in (ACCELERATION, VELOCITY)
    )
    return definition, acceleration, velocity


def spectra_of(inputs: Inputs, parts: Parts, period: float) -> xr.Dataset:
    """Compute the 5 % damped response spectra of the records.

    Parameters
    ----------
    inputs
        Arguments of the assessment.
    parts
        Store of the spectra.
    period
        Additional natural period [s].

    Returns
    -------
    xarray.Dataset
        Over `record` and `period`: `spectral_acceleration` [m/s²], RotD50 of the pseudo-acceleration, or the
        pseudo-acceleration of the only horizontal component.
    """
    periods = np.unique(np.append(_PERIODS, period))

    def compute(progress: Report) -> xr.Dataset:
        found = []
        for place, motion in enumerate(inputs.records.values()):
            progress(place, len(inputs.records))
            found.append(_spectrum(motion, periods))
        about = {"units": "m s-2", "long_name": "spectral pseudo-acceleration, 5 % damping"}
        return xr.Dataset(
            {"spectral_acceleration": (("record", "period"), np.array(found), about)},
            coords={"record": list(inputs.records), "period": ("period", periods, {"units": "s"})},
        )

    identity = {"records": identities(inputs.records), "periods": periods.tolist(), "damping": _DAMPING}
    return parts.get("records: response spectra", len(inputs.records), identity, compute)


def practice_of(inputs: Inputs) -> list[xr.Dataset]:
    """Return the answers of rules of practice for each column, over `record`, `scale` and `rule`."""
    shaking = [Shaking.of(motion) for motion in inputs.records.values()]
    along = {"record": list(inputs.records), "scale": inputs.scales}
    bodies = [levels[CENTRAL].column for levels in inputs.columns.values()]
    return [answers_of(body, shaking, inputs.scales).assign_coords(along) for body in bodies]


def _spectrum(motion: BaseMotion, periods: Floats) -> Floats:
    record = as_record(motion)
    spectra = response_spectra(record, periods, damping=_DAMPING)
    if has_two_components(motion):
        return np.asarray(spectra["rotd50"].to_numpy())
    # An oscillator under motion along a line moves along it: its peaks along x and y are components of one peak.
    squares = [spectra["psa"].sel(axis=axis).to_numpy() ** 2 for axis in record.axes if axis != "z"]
    return np.sqrt(np.sum(squares, axis=0)) if squares else np.zeros(periods.size)


def ground_motions(inputs: Inputs) -> xr.Dataset:
    """Return the accelerations of the records for a figure.

    Returns
    -------
    xarray.Dataset
        Over `record`, `instant` and `axis`: `acceleration` [m/s²]; over `record` and `instant` `time` [s]; NaN beyond
        the end of a record. A record of more than 2000 samples is reduced to minimum and maximum of each interval.
    """
    drawn = [_envelope(as_record(motion)) for motion in inputs.records.values()]
    longest = max(len(times) for times, _ in drawn)
    times = np.full((len(drawn), longest), np.nan)
    values = np.full((len(drawn), longest, len(AXES)), np.nan)
    for place, (at, acceleration) in enumerate(drawn):
        times[place, : len(at)], values[place, : len(at)] = at, acceleration
    return xr.Dataset(
        {
            "time": (("record", "instant"), times, {"units": "s", "long_name": "time"}),
            "acceleration": (
                ("record", "instant", "axis"),
                values,
                {"units": "m s-2", "long_name": "ground acceleration"},
            ),
        },
        coords={"record": list(inputs.records), "axis": list(AXES)},
    )


def _envelope(record: Record) -> tuple[Floats, Floats]:
    """Return times and accelerations of a record, reduced to a number that a figure can show, with all peaks."""
    size = math.ceil(2 * len(record.samples) / _DRAWN)
    if size <= 2:  # noqa: PLR2004  two samples represent an interval
        return record.times, record.samples
    padding = -len(record.samples) % size
    stretches = np.pad(record.samples, ((0, padding), (0, 0)), mode="edge").reshape(-1, size, len(AXES))
    ends = np.stack([stretches.min(axis=1), stretches.max(axis=1)], axis=1)
    begins = record.start + record.step * size * np.arange(len(stretches))
    times = begins[:, np.newaxis] + record.step * np.array([0.25, 0.75]) * size
    return times.ravel(), ends.reshape(-1, len(AXES))


# Number of samples for the peaks of a motion that is no record.
_TIMES = 20_001


def column_properties(inputs: Inputs) -> xr.Dataset:
    """Return the properties of each column, over `column`."""
    bodies = [levels[CENTRAL].column for levels in inputs.columns.values()]
    numbers = {
        "radius": ([body.radius for body in bodies], "m", "base radius r"),
        "height": ([np.nan if body.height is None else body.height for body in bodies], "m", "height"),
        "mass_height": ([body.mass_height for body in bodies], "m", "height of the centre of mass h"),
        "mass": ([body.mass for body in bodies], "kg", "mass"),
        "slenderness": ([body.slenderness for body in bodies], "1", "slenderness c = r/h"),
        "tipping_angle": ([body.tipping_angle for body in bodies], "rad", "tipping angle α_c"),
        "rim_distance": ([body.rim_distance for body in bodies], "m", "size R"),
        "frequency_parameter": ([body.frequency_parameter for body in bodies], "rad s-1", "frequency parameter p"),
        "uplift_acceleration": (
            [body.gravity * body.slenderness for body in bodies],
            "m s-2",
            "horizontal acceleration above which it rocks",
        ),
        "friction_coefficient": (list(inputs.friction.values()), "1", "stated friction coefficient"),
    }
    yardsticks = np.array([list(damping_yardstick(body).values()) for body in bodies])
    sides = [
        side_of_yardstick(body, levels.values())
        for body, levels in zip(bodies, inputs.dissipation.values(), strict=True)
    ]
    about = {"units": "1", "long_name": "damping that loses as much as Housner's impacts"}
    return xr.Dataset(
        {
            **{
                name: ("column", np.array(values, dtype=float), {"units": units, "long_name": long_name})
                for name, (values, units, long_name) in numbers.items()
            },
            "housner_damping": (("column", "amplitude"), yardsticks, about),
            "damping_side": ("column", [str(side) for side in sides]),
        },
        coords={"column": list(inputs.columns), "amplitude": list(AMPLITUDES)},
    )


def record_properties(inputs: Inputs) -> xr.Dataset:
    """Return the properties of each record, over `record`; `definition` is that of the horizontal intensities.

    `drifts` is 1 if the velocity at the end exceeds 5 % of the PGV along some axis.
    """
    motions = list(inputs.records.values())
    definitions, accelerations, velocities = zip(*map(horizontal_peaks, motions), strict=True)
    axes = np.array([_peaks(motion) for motion in motions])
    numbers = {
        "peak_acceleration": (
            [motion.peak_horizontal(0.0) for motion in motions],
            "m s-2",
            "PGA, horizontal vector",
        ),
        **{
            f"peak_acceleration_{axis}": (axes[:, place], "m s-2", f"peak acceleration along {axis}")
            for place, axis in enumerate("xyz")
        },
        "peak_velocity": ([peak_horizontal_velocity(motion) for motion in motions], "m s-1", "PGV, horizontal vector"),
        "median_peak_acceleration": (accelerations, "m s-2", "PGA, RotD50 or of the one component"),
        "median_peak_velocity": (velocities, "m s-1", "PGV, RotD50 or of the one component"),
        "length": ([motion.duration for motion in motions], "s", "length"),
        "step": ([motion.step if isinstance(motion, Record) else np.nan for motion in motions], "s", "time step"),
        "residual_velocity": (
            [float(np.linalg.norm(motion.velocity(motion.duration))) for motion in motions],
            "m s-1",
            "velocity at the end",
        ),
    }
    return xr.Dataset(
        {
            name: ("record", np.array(values, dtype=float), {"units": units, "long_name": long_name})
            for name, (values, units, long_name) in numbers.items()
        }
        | {
            "definition": ("record", np.array(definitions)),
            "drifts": ("record", np.array([bool(drifts(as_record(motion))) for motion in motions], np.int8)),
        },
        coords={"record": list(inputs.records)},
    )


def _peaks(motion: BaseMotion) -> tuple[float, ...]:
    if isinstance(motion, Record):
        return tuple(np.abs(motion.samples).max(axis=0).tolist())
    times = np.linspace(0.0, motion.duration, _TIMES)
    return tuple(float(np.abs(values).max()) for values in motion.derivative(times, ACCELERATION))
