"""Random columns that can slip, random starts and base motions, as an ensemble takes them; for tests."""

from dataclasses import dataclass, replace

import numpy as np

import stylobate as sb

COLUMN = sb.Column.solid(radius=1.0, height=20.0, density=1000.0)
RATE = COLUMN.frequency_scale
LASTS = 12.0 / RATE

# Round an ellipse and up and down at once; along a line that rises; up and down for the most part.
MOTIONS = {
    "ellipse": sb.Harmonic(amplitude=(1.0, 0.5, 0.7), phase=(0.0, 1.0, 2.0), angular_frequency=1.0),
    "oblique": sb.Harmonic.oblique(acceleration=1.0, angular_frequency=1.0, angle=0.6),
    "upright": sb.Harmonic(amplitude=(0.2, 0.1, 1.0), phase=(0.5, 0.0, 0.0), angular_frequency=1.0),
}


@dataclass(frozen=True)
class Runs:
    """Starts and parameters of runs, by name, and the base motion that they share."""

    motion: sb.BaseMotion
    starts: dict
    parameters: dict

    def __len__(self):
        return len(self.starts["spin"])

    def with_values(self, **values):
        """Return the same runs with some parameters the same for all."""
        return replace(self, parameters=self.parameters | {name: np.full(len(self), v) for name, v in values.items()})

    def part(self, chosen):
        """Return some of the runs."""
        starts, parameters = (
            {name: value[chosen] for name, value in values.items()} for values in (self.starts, self.parameters)
        )
        return Runs(self.motion, starts, parameters)

    def together(self, **options):
        """Return the result of all of them."""
        options = {"duration": LASTS, "rtol": 1e-7} | options
        model = sb.Sliding(COLUMN)
        return sb.simulate_ensemble(model, self.motion, parameters=self.parameters, **self.starts, **options)

    def alone(self, number, **options):
        """Return one of them, as `simulate` follows it."""
        numbers = {name: float(values[number]) for name, values in self.parameters.items()}
        model, motion = sb.with_parameters(sb.Sliding(COLUMN), self.motion, **numbers)
        start = {name: values[number].tolist() for name, values in self.starts.items()}
        return sb.simulate(model, motion, duration=LASTS, **{"rtol": 1e-7, **start, **options})


def random_runs(count, seed, motion):
    """Return so many runs, half of the columns standing, some of these turning."""
    rng = np.random.default_rng([seed, *map(int, 10.0 * np.array(motion.amplitude))])
    slenderness = 10.0 ** rng.uniform(-1.3, -0.1, count)
    friction = np.geomspace(0.01, 1.5, 1000)[rng.integers(0, 1000, count)]
    leans, turns = rng.random(count) < 0.5, rng.random(count) < 0.3
    tilt = leans * rng.uniform(0.0, 1.2, count) * np.arctan(slenderness)
    azimuth = rng.uniform(-np.pi, np.pi, count)
    push = 0.3 * RATE * (leans * slenderness)[:, np.newaxis]
    return Runs(
        motion,
        {
            "tilt": np.stack([tilt * np.cos(azimuth), tilt * np.sin(azimuth)], axis=-1),
            "tilt_rate": push * rng.normal(size=(count, 2)),
            "spin": turns * RATE * rng.normal(size=count),
        },
        {
            "slenderness": slenderness,
            "friction_coefficient": friction,
            "static_friction_coefficient": friction * rng.choice([1.0, 1.0, 1.2, 2.0], count),
            "patch": rng.choice([0.0, 0.0, 0.0, 1.0], count) * rng.uniform(0.0, 0.5, count),
            "normal_restitution": rng.choice([0.0, 0.0, 0.3, 0.8, 1.0], count),
            "damping": rng.choice([0.0, 0.0, 0.1], count),
            "spin_damping": rng.choice([0.0, 0.1], count),
            "rolling_resistance": rng.choice([0.0, 0.0, 0.02], count),
            "incline": rng.choice([0.0, 0.0, 0.05, 0.3], count),
            "incline_direction": rng.uniform(0.0, 6.0, count),
            "acceleration": COLUMN.gravity * 10.0 ** rng.uniform(-2.0, 0.3, count),
            "angular_frequency": RATE * 10.0 ** rng.uniform(-0.5, 1.0, count),
        },
    )
