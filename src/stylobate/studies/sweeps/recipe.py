"""Recipe of the runs of a sweep: the shared arguments, combined with the values that vary."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.combined import members_of
from stylobate.base_motions.declared import stated_numbers, with_numbers
from stylobate.models import Model
from stylobate.results.known_orbits import as_orbits
from stylobate.run_arguments import RunOptions
from stylobate.studies.known_rolling import known_rolling
from stylobate.studies.sweeps.quantities import OF_A_RUN, Floats


@dataclass(frozen=True, slots=True)
class Recipe:
    """Model, motion and options of every run, and either its `duration` [s] or its number of `periods`, or neither."""

    model: Model
    motion: BaseMotion
    duration: float | None
    periods: float | None
    options: RunOptions

    def arguments(self, values: Mapping[str, Floats]) -> dict[str, Any]:
        """Return the keyword arguments of `simulate_ensemble` for runs at these `values`, arrays of one length."""
        count = next(iter(values.values())).size
        chosen: dict[str, Any] = {**self.options}
        for name in ("tilt", "tilt_rate"):
            x, y = chosen[name]
            parts = (values.get(f"{name}_x", np.full(count, x)), values.get(f"{name}_y", np.full(count, y)))
            chosen[name] = np.stack(parts, axis=-1)
        chosen["spin"] = values.get("spin", chosen["spin"])
        own = {name: array for name, array in values.items() if name not in OF_A_RUN}
        if chosen.pop("end_converged") and count > 0:
            rolling = known_rolling(self.model, self.motion, own, count)
            chosen["known_orbits"] = (*as_orbits(chosen["known_orbits"]), rolling)
        return {**chosen, "duration": self._durations(values), "parameters": own}

    def _durations(self, values: Mapping[str, Floats]) -> Floats | float:
        if self.periods is None:
            return values["duration"] if self.duration is None else self.duration
        if "angular_frequency" in values:
            return np.asarray(self.periods * 2.0 * math.pi / values["angular_frequency"])
        if "motion" in values:
            periods = np.array([member.period or math.nan for member in members_of(self.motion)])
            return np.asarray(self.periods * periods[values["motion"].astype(np.intp)])
        assert self.motion.period is not None  # a sweep refuses periods of a motion without one
        stated = [name for name in values if name in stated_numbers(self.motion)]
        if stated:  # such as a frequency [Hz]
            rows, which = np.unique(np.stack([values[name] for name in stated], axis=1), axis=0, return_inverse=True)
            changed = (with_numbers(self.motion, dict(zip(stated, row, strict=True))) for row in rows.tolist())
            return self.periods * np.array([motion.period for motion in changed], dtype=float)[which.ravel()]
        return self.periods * self.motion.period
