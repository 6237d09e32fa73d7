"""
At which tilt does a column roll steadily, and is that stable?
==============================================================

On a base that moves in a circle a column can roll round its rim once in each period.
The response curve shows the tilt of this steady rolling against the frequency, and
where it is stable.
"""

import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)  # g, ω₀

curves = sb.studies.response_curves(
    model, circle, angular_frequency=np.linspace(0.5, 5.0, 300)
)
critical = float(curves["critical_frequency"][0])
print(f"steady rolling is stable above {critical:.4f} ω₀")

sb.plot(curves)

# %%
# Steady rolling has two branches. The lower one is unstable at all frequencies; the
# upper one is stable above the critical frequency. Nothing is integrated here: both
# branches are closed forms. :func:`stylobate.studies.steady_start` starts a run on one.
# See :doc:`/explanation/equations`.
