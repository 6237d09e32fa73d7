"""
Does the start phase of a harmonic motion decide the outcome?
=============================================================

A shaking table can start its sine at the peak, at zero, or in between. This example
asks whether the start phase alone can overturn a column that stands at rest.
"""

import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.2, angular_frequency=4.0)

# A small map: 40 phases from 0 to 2π, 32 amplitudes in units of g.
found = sb.studies.overturning_map(
    model,
    line,
    over={
        "start_phase": np.linspace(0.0, 2.0 * np.pi, 40),  # rad
        "acceleration": np.linspace(0.08, 0.32, 32),
    },
    periods=40.0,
)
overturned = (found["outcome"] == sb.Outcome.OVERTURNED).mean("start_phase")
mixed = float(((overturned > 0.0) & (overturned < 1.0)).mean())
print(f"the start phase decides at {100.0 * mixed:.0f} % of the amplitudes")
sb.plot(found)

# %%
# At an amplitude whose row shows both survival and overturning, the start phase
# decides. The map repeats after a phase of π, because the mirrored motion has the
# mirrored response. Up to 0.1 g nothing moves. See :doc:`/how-to/base-motions` for
# start phases and ramps.
