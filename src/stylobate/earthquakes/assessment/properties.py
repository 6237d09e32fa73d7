"""Properties of the columns and records of an assessment."""

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.base import ACCELERATION
from stylobate.earthquakes.assessment.ground_motions import as_record, horizontal_peaks
from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs
from stylobate.earthquakes.intensities import peak_horizontal_velocity
from stylobate.records.intensities import drifts
from stylobate.results.damping_yardstick import AMPLITUDES, damping_yardstick, side_of_yardstick

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
