"""
Which pulses overturn a column?
===============================

One sine of acceleration is the simplest near-fault pulse. This example finds all
amplitudes that overturn a column, for every frequency of the pulse.
"""

import numpy as np

import stylobate as sb

column = sb.Column.dimensionless(slenderness=0.1)
pulse = sb.Pulse.one_sine(acceleration=0.1, angular_frequency=1.0)  # g, ω₀

found = sb.earthquakes.overturning_intervals(
    sb.Slender(column, damping=0.1),
    pulse,
    scales=np.geomspace(1.0, 20.0, 25),  # factors of the pulse
    over={"angular_frequency": np.linspace(0.5, 9.0, 30)},
    width=0.01,  # relative error of the edges
)
sb.plot(found)

# %%
# Two regions overturn the column. In the lower one it passes the vertical and falls to
# the other side; in the upper one it falls without passing it. Between them a stronger
# pulse is harmless. See :doc:`/how-to/rocking-spectra`.
