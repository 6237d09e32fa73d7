"""
A part on a vibrating conveyor
==============================

A steel pin stands on a vibrating trough. Does it slide, fly, rock or overturn, and how
fast does the trough convey it? This tutorial answers in the units of a data sheet:
frequency in Hz, stroke in mm, angle in degrees. It takes about ten minutes to read and
needs no knowledge of the equations. The guide :doc:`/how-to/conveyors` lists every
function for conveyors.
"""

# %%
# The part and the vibration
# --------------------------
#
# The part is a pin, 12 mm in diameter and 40 mm high. Its **slenderness** is c = r/h:
# the radius of its base over the height of its centre of mass.
#
# The trough vibrates along a line at the angle δ. A data sheet gives the frequency f
# and the **stroke** s, the peak-to-peak path along that line. The function below turns
# both into a base motion. ``lag_deg`` delays the vertical component; a later section
# uses it.

import math

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

GRAVITY = 9.80665  # m/s²


def vibration(frequency, stroke_mm, angle_deg, lag_deg=0.0):
    half, angle = 0.5e-3 * stroke_mm, math.radians(angle_deg)
    return sb.Harmonic.displacement_amplitude(
        amplitude=(half * math.cos(angle), 0.0, half * math.sin(angle)),
        phase=(0.0, 0.0, -math.radians(lag_deg)),
        angular_frequency=2.0 * math.pi * frequency,
    )


pin = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)
trough = vibration(frequency=50.0, stroke_mm=0.3, angle_deg=25.0)
print(f"slenderness c = {pin.slenderness:.2f}")

# %%
# A sketch of the conveyor. The stroke is enlarged.

figure, axes = plt.subplots(figsize=(6.4, 3.2))
axes.plot([-30.0, 60.0], [0.0, 0.0], color="black", linewidth=3)
axes.add_patch(
    plt.Rectangle((-6.0, 0.0), 12.0, 40.0, facecolor="#8fb8d8", edgecolor="k")
)
axes.plot(0.0, 20.0, marker="o", color="black")
delta = math.radians(25.0)
path = 18.0 * np.array([math.cos(delta), math.sin(delta)])
axes.annotate(
    "",
    xy=(30.0 + path[0], 12.0 + path[1]),
    xytext=(30.0 - path[0], 12.0 - path[1]),
    arrowprops={"arrowstyle": "<->", "color": "#d55e00", "linewidth": 2},
)
axes.text(49.0, 21.0, "stroke s", color="#d55e00")
turn = np.linspace(0.0, delta, 20)
corner = np.array([30.0 - path[0], 12.0 - path[1]])
axes.plot([corner[0], corner[0] + 22.0], [corner[1], corner[1]], color="gray")
axes.plot(
    corner[0] + 15.0 * np.cos(turn), corner[1] + 15.0 * np.sin(turn), color="gray"
)
axes.text(corner[0] + 16.5, corner[1] + 2.0, "δ")
for start, end, name, place in (
    ((0.0, 20.0), (0.0, 0.0), "h", (1.0, 9.0)),
    ((0.0, 20.0), (-6.0, 20.0), "r", (-4.0, 22.0)),
):
    axes.annotate("", xy=end, xytext=start, arrowprops={"arrowstyle": "->"})
    axes.text(*place, name)
axes.annotate("", xy=(60.0, -5.0), xytext=(40.0, -5.0), arrowprops={"arrowstyle": "->"})
axes.text(24.0, -6.5, "transport, x")
axes.set(xlim=(-30.0, 66.0), ylim=(-9.0, 44.0), aspect="equal")
axes.axis("off")
figure.tight_layout()

# %%
# The throw number
# ----------------
#
# Gravity presses the part onto the trough, and the trough accelerates downwards in one
# half of each period. The **throw number** compares the two:
#
# .. math:: \Gamma = \frac{s\,\Omega^2 \sin\delta}{2 g}, \qquad \Omega = 2\pi f.
#
# With Γ < 1 the part stays on the trough. With Γ > 1 it *flies* in each period.
# :func:`stylobate.theory.flight_throw_number` relates Γ to the length of a flight.

strokes_mm = np.array([0.1, 0.3, 0.6, 1.0])
for stroke in strokes_mm:
    motion = vibration(50.0, stroke, 25.0)
    gamma = sb.theory.throw_number(motion.vertical_range()[1] / GRAVITY)
    print(f"stroke {stroke:.1f} mm: throw number {float(gamma):.2f}")

# %%
# Slide or tip: the smaller of μ and c
# ------------------------------------
#
# A standing part begins to slide where the friction force reaches μN. It begins to tip
# where the force would need a support outside the base, at cN. So the smaller of the
# friction coefficient μ and the slenderness c decides.
# :func:`stylobate.conveying.start_boundary` computes the smallest horizontal
# acceleration for each.

model = sb.Sliding(pin, friction_coefficient=0.2, damping=0.05, normal_restitution=0.1)
onset = sb.conveying.start_boundary(
    model,
    slenderness=np.linspace(0.05, 0.8, 151),
    friction_coefficient=0.2,
    vertical_ratio=math.tan(math.radians(25.0)),
)
figure = sb.plot(onset)
axes = figure.axes[0]
axes.axvline(pin.slenderness, color="black", linewidth=1)
axes.text(pin.slenderness + 0.01, 0.2, "the pin")

# %%
# On a smooth trough, μ = 0.2, the pin slides. On a rubber lining with μ = 0.4 it would
# rock, because then μ > c = 0.3.
#
# Sliding
# -------
#
# Simulate 0.2 s on the smooth trough. The part never tips, so the tilt is zero. The
# interesting quantity is the position of its base on the trough.

sliding = sb.simulate(model, trough, duration=0.2)
print(sliding.outcome.name, "-", sliding.reason)

# %%
# A stroke of 0.6 mm raises Γ to 1.28: the part flies. The outcome of such a run is
# `LIFTED_OFF`.

flying = sb.simulate(model, vibration(50.0, 0.6, 25.0), duration=0.2)
print(flying.outcome.name, "-", flying.reason)

figure, panels = plt.subplots(2, 1, figsize=(7.0, 4.8), sharex=True)
for run, name, colour in (
    (sliding, "0.3 mm", "#0072b2"),
    (flying, "0.6 mm", "#d55e00"),
):
    time = np.linspace(0.1, 0.2, 1001)
    sample = run.sample(time)
    milliseconds = 1000.0 * (time - 0.1)
    travel = 1000.0 * sample["footprint"].sel(axis="x")
    panels[0].plot(milliseconds, travel - travel[0], color=colour, label=name)
    panels[1].plot(milliseconds, 1000.0 * sample["clearance"], color=colour)
panels[0].set_ylabel("position on the trough [mm]")
panels[0].legend(title="stroke")
panels[1].set_ylabel("clearance [mm]")
panels[1].set_xlabel("time [ms]")
figure.tight_layout()

# %%
# The position moves forwards and backwards in each period of 20 ms, and advances on
# average. The clearance shows the flights.
#
# Transport velocity against stroke
# ---------------------------------
#
# :func:`stylobate.conveying.drift` simulates each stroke and averages the velocity
# over the last periods. It varies the horizontal acceleration amplitude, which is
# proportional to the stroke; the vertical amplitude keeps its ratio.
#
# A part that stays upright moves like a block. For a block the theory follows each
# phase of the motion exactly, so both results must agree.

factor = 0.5e-3 * math.cos(delta) * trough.angular_frequency**2  # m/s² per mm
strokes_mm = np.linspace(0.05, 1.5, 30)
simulated = sb.conveying.drift(
    model, trough, over={"acceleration": factor * strokes_mm}, periods=60
)
velocity = 1000.0 * simulated["mean_velocity"].sel(axis="x").values

along = factor * strokes_mm / GRAVITY
block = sb.theory.mean_block_speed(
    along, along * math.tan(delta), static_friction=0.2, normal_restitution=0.1
)
block_mm = 1000.0 * block * GRAVITY / trough.angular_frequency

figure, axes = plt.subplots(figsize=(7.0, 3.6))
axes.plot(strokes_mm, block_mm, color="black", label="block, closed form")
axes.plot(strokes_mm, velocity, "o", color="#0072b2", label="simulation")
flies_from = strokes_mm[0] / (along[0] * math.tan(delta))  # Γ = 1
axes.axvline(flies_from, color="gray", linestyle=":")
axes.set_xlabel("stroke [mm]")
axes.set_ylabel("mean transport velocity [mm/s]")
axes.legend()
figure.tight_layout()
print(f"largest difference: {np.nanmax(abs(velocity - block_mm)):.2g} mm/s")

# %%
# Beyond the dotted line, Γ = 1, the part flies, and the velocity rises faster than the
# stroke. The curve is not smooth there: the number of periods after which the flights
# repeat changes.
#
# Transport velocity against phase
# --------------------------------
#
# Two exciters can drive the horizontal and the vertical component separately. Then the
# vertical component may lag behind the horizontal one, and the line becomes an
# ellipse. The same closed form gives the velocity, here with a stroke of 0.6 mm.

lags = np.linspace(0.0, 360.0, 73)
strong = vibration(50.0, 0.6, 25.0)
along = strong.peak_horizontal() / GRAVITY
scale = 1000.0 * GRAVITY / strong.angular_frequency

figure, axes = plt.subplots(figsize=(7.0, 3.6))
for friction, colour in ((0.1, "#0072b2"), (0.2, "#d55e00"), (0.29, "#009e73")):
    speed = sb.theory.mean_block_speed(
        along,
        along * math.tan(delta),
        static_friction=friction,
        normal_restitution=0.1,
        phase=-np.radians(lags),
        cycles=200,
    )
    axes.plot(lags, scale * speed, color=colour, label=f"μ = {friction:g}")
    best = lags[np.argmax(speed)]
    print(f"μ = {friction:g}: {scale * max(speed):.0f} mm/s at a lag of {best:.0f}°")

for lag in (0.0, 90.0, 180.0, 270.0):
    found = sb.conveying.drift(
        model, vibration(50.0, 0.6, 25.0, lag), over={"friction_coefficient": [0.2]}
    )
    axes.plot(lag, 1000.0 * found["mean_velocity"].values[0, 0], "o", color="#d55e00")
axes.axhline(0.0, color="black", linewidth=0.6)
axes.set_xticks(range(0, 361, 60))
axes.set_xlabel("lag of the vertical component [°]")
axes.set_ylabel("mean transport velocity [mm/s]")
axes.legend()
figure.tight_layout()

# %%
# Lines: closed form. Dots: simulation. A lag of 180° turns the line of vibration over,
# and the part moves backwards at the same speed.
#
# Pivoting
# --------
#
# A part that arrives with a rotation about its axis is stopped by friction. While the
# trough vibrates, the base slides at the same time. Sliding friction then shares its
# direction with pivoting friction, and the part rotates further before it stops.

figure, axes = plt.subplots(figsize=(7.0, 3.2))
for stroke, colour in ((0.0, "black"), (0.3, "#0072b2"), (0.6, "#d55e00")):
    motion = vibration(50.0, stroke, 25.0) if stroke else None
    run = sb.simulate(model, motion, spin=20.0, duration=0.2)
    time = np.linspace(0.0, 0.2, 801)
    twist = np.degrees(run.sample(time)["twist"])
    axes.plot(1000.0 * time, twist, color=colour, label=f"stroke {stroke:g} mm")
axes.set_xlabel("time [ms]")
axes.set_ylabel("rotation about the axis [°]")
axes.legend()
figure.tight_layout()

# %%
# Where it rocks and overturns
# ----------------------------
#
# A contact map repeats the simulation over friction and horizontal acceleration, which
# is `factor` times the stroke in mm. Each cell is one run of 50 periods from rest. A
# run in which the part leaves the trough is of the class *flies*, even if it rocks too.

accelerations = factor * np.linspace(0.02, 1.5, 30)
contact = sb.conveying.contact_map(
    model,
    trough,
    over={
        "acceleration": accelerations,
        "friction_coefficient": np.linspace(0.06, 0.56, 21),
    },
    periods=50,
)
figure = sb.plot(contact)
axes = figure.axes[0]
axes.axhline(pin.slenderness, color="black", linestyle="--", linewidth=1)
axes.text(3.0, pin.slenderness + 0.01, "μ = c", backgroundcolor="white")

# %%
# Below the dashed line, μ = c, the pin stays upright: it slides, and it flies where
# Γ > 1. Above the line it rocks. The classes of rocking do not occur here, because the
# rim of a rocking pin leaves the trough too: it flies even where Γ < 1. In some cells
# it overturns.
#
# One cell is one start phase of the vibration. A fair answer counts outcomes over many
# start phases, with a stroke of 1 mm and 5 s of motion:

coefficients = [0.2, 0.28, 0.32, 0.4, 0.5]
phases = np.linspace(0.0, 2.0 * math.pi, 32, endpoint=False)
runs = sb.simulate_ensemble(
    model,
    vibration(50.0, 1.0, 25.0),
    duration=5.0,
    parameters={
        "friction_coefficient": np.repeat(coefficients, phases.size),
        "start_phase": np.tile(phases, len(coefficients)),
    },
)
overturned = (runs["outcome"].values == sb.Outcome.OVERTURNED).reshape(-1, phases.size)
for friction, count in zip(coefficients, overturned.sum(axis=1), strict=True):
    print(f"μ = {friction:.2f}: {count} of {phases.size} runs overturn")

# %%
# One of these runs as an animation, eight times slower than the motion. The blue line
# is the path of the contact point. :func:`stylobate.animate` saves it as a GIF, a film
# or a web page if you pass a path.

first = np.flatnonzero(overturned.ravel())[0]
changed = sb.with_parameters(
    model,
    vibration(50.0, 1.0, 25.0),
    friction_coefficient=coefficients[first // phases.size],
    start_phase=phases[first % phases.size],
)
fallen = sb.simulate(*changed, duration=5.0)
print(fallen.outcome.name, f"after {fallen.decided_at:.2f} s")

sb.animate(fallen, size=(420, 320), speed=0.125)

# %%
# What to do with these results
# -----------------------------
#
# * Keep μ below c, and the part stays upright: choose a smoother trough or a wider
#   part.
# * Where μ > c cannot be avoided, keep Γ small and check the outcome over start phases
#   and over the plausible range of μ.
# * A part that was set down askew can overturn for every μ. Pass ``tilt=`` to check.
#
# Next: :doc:`/how-to/conveyors` for inclines, bowl feeders and the command line;
# :doc:`/explanation/sliding` for the model and its assumptions.
