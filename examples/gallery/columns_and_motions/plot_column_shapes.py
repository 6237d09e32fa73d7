"""
Which shapes of columns can I describe, and when do they begin to rock?
=======================================================================

Cylinders, tubes and frustums of one height and base. Their slenderness and inertia
decide the acceleration at which they begin to rock and how slow their rocking is.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

stone, steel = 2700.0, 7850.0  # kg/m³
columns = {  # all with a base radius of 0.5 m and 5 m high
    "cylinder": sb.Column.solid(radius=0.5, height=5.0, density=stone),
    "tube": sb.Column.hollow(radius=0.5, inner_radius=0.45, height=5.0, density=steel),
    "frustum": sb.Column.frustum(radius=0.5, top_radius=0.3, height=5.0, density=stone),
}
names = list(columns)
onset = [one.slenderness * one.gravity for one in columns.values()]  # m/s²
scale = [one.frequency_scale for one in columns.values()]  # rad/s
for name, one in columns.items():
    angle = np.degrees(one.tipping_angle)
    print(
        f"{name}: {one.mass:.0f} kg, c = {one.slenderness:.3f}, tipping at {angle:.1f}°"
    )

figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.2), layout="constrained")
left.bar(names, onset, width=0.6)
left.set_ylabel("acceleration at which\nit begins to rock [m/s²]")
right.bar(names, scale, width=0.6, color="C1")
right.set_ylabel("frequency scale ω₀ [rad/s]")

# %%
# The frustum has a low centre of mass, so it begins to rock at a larger acceleration.
# See :doc:`/how-to/columns` and :class:`stylobate.Column`.
