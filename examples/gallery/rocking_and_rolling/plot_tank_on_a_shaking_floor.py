"""
A slender water tank on a floor that begins to shake
====================================================

Does a slender, empty water tank of steel stand, rock or overturn when the floor below
it begins to shake? Four floor motions, from weak and slow to strong and fast.
"""

import stylobate as sb

tank = sb.Column.hollow(radius=0.6, inner_radius=0.55, height=9.0, density=7850.0)
model = sb.Wobbling(tank, damping=0.05)
cases = [(1.0, 2.0), (1.4, 2.0), (1.4, 5.0), (2.0, 5.0)]  # m/s², rad/s

runs, labels = [], []
for acceleration, angular_frequency in cases:
    floor = sb.Harmonic.elliptic(
        amplitude=(acceleration, 0.6 * acceleration),
        phase=1.2,
        angular_frequency=angular_frequency,
        ramp=4.0,
    )
    run = sb.simulate(model, floor, duration=60.0)
    runs.append(run)
    labels.append(f"{acceleration:g} m/s², {angular_frequency:g} rad/s")
    peak = run.measures["peak_tilt_over_c"]
    print(f"{labels[-1]}: {run.outcome.label}, peak tilt {peak:.2f} c")

# %%
# The tilt of each run against time, and the paths of the tilt vector. The dashed circle
# marks the tilt at which the centre of mass stands above the rim.
sb.plot(runs, labels=labels)
