"""What tests of ensembles share: runs that can be followed together and each alone, and random ones of all kinds."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest

import stylobate as sb

C = 0.1


@dataclass(frozen=True)
class Runs:
    """Runs with a row each in `tilt`, `tilt_rate` (n, 2), `duration` and `parameters` (n,)."""

    model: Any
    motion: Any
    tilt: np.ndarray
    tilt_rate: np.ndarray
    duration: np.ndarray
    parameters: Mapping[str, np.ndarray] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, model, motion, count, *, tilt, tilt_rate=(0.0, 0.0), duration, parameters=None, **options):
        def rows(value, *shape):
            return np.broadcast_to(np.asarray(value, dtype=float), (count, *shape)).copy()

        values = {name: rows(value) for name, value in (parameters or {}).items()}
        return cls(model, motion, rows(tilt, 2), rows(tilt_rate, 2), rows(duration), values, options)

    def __len__(self):
        return len(self.tilt)

    def part(self, chosen):
        values = {name: value[chosen] for name, value in self.parameters.items()}
        return replace(
            self,
            tilt=self.tilt[chosen],
            tilt_rate=self.tilt_rate[chosen],
            duration=self.duration[chosen],
            parameters=values,
        )

    def together(self, **options):
        return sb.simulate_ensemble(
            self.model,
            self.motion,
            tilt=self.tilt,
            tilt_rate=self.tilt_rate,
            duration=self.duration,
            parameters=self.parameters,
            **{**self.options, **options},
        )

    def alone(self, index, *, off=0.0, **options):
        """Follow one run by `simulate`, its starting tilt larger by the part `off`."""
        values = {name: float(value[index]) for name, value in self.parameters.items()}
        model, motion = sb.with_parameters(self.model, self.motion or sb.base_motions.BASE_AT_REST, **values)
        start = {"tilt": tuple(self.tilt[index] * (1.0 + off)), "tilt_rate": tuple(self.tilt_rate[index])}
        options = {"samples": 2, "recheck": False, **self.options, **options}
        return sb.simulate(model, motion, **start, duration=float(self.duration[index]), **options)


def _outcome(data, index=0):
    return sb.Outcome(data["outcome"].to_numpy()[index])


def _end_of(response):
    """Return tilt and rate at the end of a single run, as one vector."""
    last = response.data.isel(time=-1)
    return np.concatenate([last["tilt"].to_numpy(), last["tilt_rate"].to_numpy()])


def _ends_of(data):
    """Return the same of each run of an ensemble, shape (n, 4)."""
    return np.concatenate([data["end_tilt"].to_numpy(), data["end_tilt_rate"].to_numpy()], axis=-1)


def _mixed_runs(motion, count, seed, **options):
    """Return runs with random starts within c, frequencies, accelerations, phases, directions and damping."""
    rng = np.random.default_rng(seed)

    def disc(radius):
        size, angle = radius * np.sqrt(rng.uniform(0.0, 1.0, count)), rng.uniform(-math.pi, math.pi, count)
        return size[:, np.newaxis] * np.stack([np.cos(angle), np.sin(angle)], axis=1)

    tilt, rate = disc(C), disc(0.8 * C)
    at_rest = rng.uniform(size=count) < 0.1
    tilt[at_rest] = rate[at_rest] = 0.0
    parameters = {
        "angular_frequency": rng.uniform(0.6, 5.0, count),
        "acceleration": rng.uniform(0.0, 0.2, count),
        "start_phase": rng.uniform(-math.pi, math.pi, count),
        "rotation": rng.uniform(-math.pi, math.pi, count),
        "damping": np.where(rng.uniform(size=count) < 0.1, 0.0, rng.uniform(0.0, 0.3, count)),
    }
    model = sb.Slender(sb.Column.dimensionless(C))
    duration = np.full(count, 60.0)
    return Runs(model, motion, tilt, rate, duration, parameters, options)


@pytest.fixture(scope="session")
def runs_of():
    return Runs.of


@pytest.fixture(scope="session")
def mixed_runs():
    return _mixed_runs


@pytest.fixture(scope="session")
def outcome_in():
    return _outcome


@pytest.fixture(scope="session")
def end_of():
    return _end_of


@pytest.fixture(scope="session")
def ends_of():
    return _ends_of
