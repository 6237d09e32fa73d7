"""
Does the response depend on the direction of a sweep? Hysteresis
================================================================

Lower the amplitude of the base step by step and raise it again, as on a shaking table.
The column rolls on the way down and stands on the way up at the same amplitude.
"""

import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.04, angular_frequency=3.0)  # g, ω₀
start = sb.orbits.periodic_orbit(model, line)  # stable rolling at 0.04 g

swept = sb.studies.slow_sweep(
    model,
    line,
    parameter="acceleration",
    values=np.linspace(0.04, 0.002, 20),  # g
    tilt=start.tilt,
    tilt_rate=start.tilt_rate,
    periods_each=60,  # few, to be quick
    back=True,
)
sb.plot(swept)

# %%
# On the way down the column rolls until the rolling motion vanishes, and then comes to
# rest. On the way up it stays at rest: below c g, here 0.1 g, a standing column never
# moves. See :doc:`/results/exact-orbits`.
