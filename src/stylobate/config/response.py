"""Describe response curves: a column, its model, a harmonic motion and a range of frequencies."""

import math
from collections.abc import Mapping
from functools import partial
from typing import Annotated, Any, Self

from stylobate.base_motions.declared import kinds_by_acceleration
from stylobate.config.description import built
from stylobate.config.parts import STEADY_MODEL, ColumnConfig, MotionConfig, SteadyModelConfig, described_model, made_by
from stylobate.config.simulation import OF_OTHER_COMMANDS, OneColumn, Setup, SimulationConfig, built_parts
from stylobate.errors import ConfigError, require_positive, require_whole
from stylobate.quantities import Quantity, states


class SteadyCase(OneColumn):
    """The case of steady rolling, whose closed forms are those of the slender model: `column`, `model`, `motion`."""

    column: ColumnConfig
    model: SteadyModelConfig = described_model(STEADY_MODEL)
    motion: MotionConfig


class ResponseConfig(SteadyCase):
    """Response curves over the frequency of the base.

    Parameters
    ----------
    column, model
        The column and its model.
    motion
        A horizontal harmonic motion; it may omit `angular_frequency`.
    angular_frequency_range
        Lowest and highest angular frequency [rad/s].
    points
        Number of frequencies.
    """

    angular_frequency_range: Annotated[tuple[float, float], Quantity(unit="rad/s", components=2)]
    points: int = 400

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; a missing frequency of the motion follows from the range."""
        motion = values.get("motion")
        kind = motion.get("kind") if isinstance(motion, Mapping) else None
        if isinstance(motion, Mapping) and kind in kinds_by_acceleration():
            # A mistake in the range is reported once: the motion is built with a valid frequency.
            given = {"angular_frequency": _possible(values.get("angular_frequency_range"))}
            values = {**values, "motion": {**given, **motion}}
        make = made_by(kind)
        if make is not None and not states(make, "responds"):
            message = f"motion.kind must be a horizontal harmonic motion for response curves, got {kind!r}"
            raise ConfigError([message])
        # Keys that only descriptions of runs use are ignored.
        of_runs = {*SimulationConfig.model_fields, *OF_OTHER_COMMANDS} - set(cls.model_fields)
        return super().parse({name: value for name, value in values.items() if name not in of_runs})

    def build(self) -> Setup:
        """Build model and motion; the options hold the range and number of frequencies.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        problems: list[str] = []
        low, high = self.angular_frequency_range
        if not 0.0 < low < high:
            problems.append(f"angular_frequency_range must rise from above zero, got {low!r} to {high!r} rad/s")
        for end in (low, high) if 0.0 < low < high else ():
            built("angular_frequency_range", partial(require_positive, "an end", end, "rad/s"), problems)
        built("points", lambda: require_whole("points", self.points, least=2), problems)
        model, motion = built_parts(self.column, self.model, self.motion, problems)
        return Setup(model, motion, {"range": self.angular_frequency_range, "points": self.points})


def _possible(frequencies: Any) -> float:
    """Return the first frequency above zero of the given range; 1 rad/s without one."""
    given = frequencies if isinstance(frequencies, (list, tuple)) else ()
    return next((float(one) for one in given if isinstance(one, (int, float)) and 0.0 < one < math.inf), 1.0)
