"""
Does the column overturn, and how surely? A verdict
===================================================

A single rocking run is barely repeatable. A verdict runs 1000 small variations of the
case and states the share that overturns the column.
"""

import stylobate as sb

column = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)  # m, m, kg/m³
model = sb.Wobbling(column, damping=column.housner_damping())
quake = sb.sample_record("el centro 1940")
verdict = sb.verdict(model, quake, runs=1000)
print(verdict)
sb.plot(verdict)

# %%
# Left: peak tilts of the variations by contact law. Right: the share of overturning
# from low to high values of each variation, and how much of the outcome it explains
# alone. See :doc:`/how-to/did-it-survive`.
