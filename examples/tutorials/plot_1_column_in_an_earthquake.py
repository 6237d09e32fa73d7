"""
A column in an earthquake
=========================

Simulate a stone column under a recorded earthquake and read the verdict.
"""

import stylobate as sb

stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
model = sb.Wobbling(stone, damping=0.03)
quake = sb.sample_record("el centro 1940")
run = sb.simulate(model, quake)
print(run.outcome.name, "-", run.reason)

# %%
# The tilt against time.
figure = sb.plot(run)
