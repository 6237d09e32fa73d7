"""
Which path does the contact point of a rolling column draw?
===========================================================

A stone column stands on a base that moves in a circle. The column rolls round its rim
and turns slowly about its own axis, so its footprint wanders.
"""

import stylobate as sb

column = sb.Column.solid(radius=0.5, height=5.0, density=2700.0)  # m, m, kg/m³
model = sb.Rolling(column, damping=0.1, spin_damping=0.05)
circle = sb.Harmonic.circular(acceleration=1.27, angular_frequency=3.0)  # m/s², rad/s
run = sb.simulate(model, circle, tilt=(0.08, 0.0), tilt_rate=(0.0, 0.25), duration=6.0)
spin = run.data["spin"][-1].item()  # rad/s
print(
    f"turns of the contact point: {run.measures['turns']:.1f}, spin: {spin:.2f} rad/s"
)

sb.plots.plot_column_path(run)

# %%
# The column with the path of its contact point, seen from the moving base. See
# :func:`stylobate.plots.plot_column_path` for the times that are drawn, and
# :doc:`/how-to/animations` for the same as an animation.
