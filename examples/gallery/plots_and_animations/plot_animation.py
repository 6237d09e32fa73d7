"""
How do I animate a column?
==========================

Show a run as it happened: the column on its moving base, its contact point, and the
tilt against time. ``sb.animate`` writes a GIF, a video or a page that you can turn.
"""

import stylobate as sb

column = sb.Column.solid(radius=0.1, height=1.6, density=2700.0)  # m, m, kg/m³
model = sb.Rolling(column, damping=0.1, spin_damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.9, angular_frequency=5.5)  # m/s², rad/s
run = sb.simulate(model, circle, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.25), duration=2.5)

# Small and with few pictures, so that this page loads fast.
sb.animate(run, size=(420, 340), frames_per_second=12)

# %%
# The column rolls round its rim. To save the animation, pass a path that ends with
# ``.gif``, ``.mp4`` or ``.html``. See :doc:`/how-to/animations` and
# :func:`stylobate.animate`.
