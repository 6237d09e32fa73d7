"""A slender water tank on a floor that begins to shake: it stands, keeps rocking and rolling, or falls.

Run it with `python examples/tank_on_a_shaking_floor.py`; it prints a table and draws tank.png.
"""

import stylobate as sb

tank = sb.Column.hollow(radius=0.6, inner_radius=0.55, height=9.0, density=7850.0)
model = sb.Slender(tank, damping=0.05)
print(f"slenderness {tank.slenderness:.4f}, frequency scale {tank.frequency_scale:.3f} rad/s")

runs, labels = [], []
for acceleration, angular_frequency in ((1.0, 2.0), (1.4, 2.0), (1.4, 5.0), (2.0, 5.0)):
    floor = sb.Harmonic.elliptic(
        amplitude=(acceleration, 0.6 * acceleration), phase=1.2, angular_frequency=angular_frequency, ramp=4.0
    )
    run = sb.simulate(model, floor, duration=60.0)
    runs.append(run)
    labels.append(f"{acceleration:g} m/s², {angular_frequency:g} rad/s")
    print(f"{labels[-1]}: {run.outcome.value:12s} largest tilt {run.measures['largest_tilt_over_c']:.3f} c")

sb.plot(runs, labels=labels).savefig("tank.png")
