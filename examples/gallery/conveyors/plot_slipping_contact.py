"""
What happens to a rolling column on a slippery floor?
=====================================================

Let a column go on a floor with little friction. Its rim rolls, slips and rolls again
until the column stands. The kinds of contact appear below the tilt.
"""

import stylobate as sb

column = sb.Column.dimensionless(slenderness=0.1)
model = sb.Sliding(column, friction_coefficient=0.06, damping=0.05)
run = sb.simulate(model, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.05), duration=30.0)

print(run)
for name in ("time_rolling", "time_slipping", "slip_distance"):
    print(f"{name}: {run.measures[name]:.3f}")
sb.plot(run)

# %%
# Time is in units of 1/ω₀, the slip distance in units of the column's own length scale.
# :doc:`/explanation/sliding` explains the kinds of contact and the impacts.
