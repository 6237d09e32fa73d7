"""
How do I write a model of my own?
=================================

A model is a class with the rates of its states and the numbers that they need. Here a
slender column moves in a medium whose drag grows with the square of the tilt rate.
"""

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

import stylobate as sb


@dataclass(frozen=True, slots=True)
class Dragged(sb.Model):
    """A slender column with quadratic drag k."""

    column: sb.Column
    drag: Annotated[float, sb.Quantity(symbol="k", text="quadratic drag", ge=0.0)] = 0.0

    name: ClassVar[str] = "dragged"
    state_names: ClassVar[tuple[str, ...]] = ("x", "y", "rate_x", "rate_y")

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, k):  # accelerations in g, time in 1/ω₀
        lean = (1.0 + az) * (1.0 - c / math.hypot(x, y))
        drag = k * math.hypot(vx, vy)
        return vx, vy, lean * x - drag * vx - ax, lean * y - drag * vy - ay

    @property
    def parameters(self):  # the last arguments of the static functions
        return self.column.slenderness, self.drag

    def start(self, tilt, tilt_rate):
        scale = self.time_scale
        return tilt[0], tilt[1], tilt_rate[0] * scale, tilt_rate[1] * scale

    @staticmethod
    def tilt_of(x, y, vx, vy, *parameters):
        return x, y, vx, vy


column = sb.Column.dimensionless(slenderness=0.1)
start = {"tilt": (0.06, 0.0), "tilt_rate": (0.0, 0.05), "duration": 60.0}
runs = [sb.simulate(Dragged(column, drag=k), **start) for k in (0.0, 2.0)]
sb.plot(runs, labels=["no drag", "drag k = 2"])

# %%
# Without drag the column rolls on for ever; with it the tilt falls, fast at first and
# ever more slowly. :doc:`/explanation/models` lists what a model can add.
