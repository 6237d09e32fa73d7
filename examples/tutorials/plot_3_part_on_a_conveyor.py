"""
A part on a vibrating conveyor
==============================

A steel pin stands on a vibrating trough. Does it slide, hop, rock or overturn, and how
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
# With Γ < 1 the part stays on the trough. With Γ > 1 it *hops* in each period.
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
figure

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
# A stroke of 0.6 mm raises Γ to 1.28: the part hops. The outcome of such a run is
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
hops_from = strokes_mm[0] / (along[0] * math.tan(delta))  # Γ = 1
axes.axvline(hops_from, color="gray", linestyle=":")
axes.set_xlabel("stroke [mm]")
axes.set_ylabel("mean transport velocity [mm/s]")
axes.legend()
figure.tight_layout()
print(f"largest difference: {np.nanmax(abs(velocity - block_mm)):.2g} mm/s")

# %%
# Beyond the dotted line, Γ = 1, the part hops, and the velocity rises faster than the
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
# is `factor` times the stroke in mm. Each cell is one run of 50 periods. The part
# starts with a tilt of 1 mrad, which is 12 µm under a base of 12 mm. The tilt is out of
# the plane of vibration: a tilt exactly within it keeps the part in this plane, which
# no real part does. The right panel is the peak tilt.

accelerations = factor * np.linspace(0.02, 1.5, 30)
contact = sb.studies.overturning_map(
    model,
    trough,
    over={
        "acceleration": accelerations,
        "friction_coefficient": np.linspace(0.065, 0.565, 21),
    },
    periods=50,
    tilt=(0.0, 1e-3),
)
figure = sb.plot(contact)
for axes in figure.axes[:2]:
    axes.axhline(pin.slenderness, color="black", linestyle="--", linewidth=1)
axes.text(3.0, pin.slenderness + 0.01, "μ = c", backgroundcolor="white")
figure

# %%
# The part rocks in most cells, on both sides of the dashed line μ = c, and it overturns
# in some. A small friction coefficient does not keep it upright: each landing on one
# side of the base tips it.
#
# The same map from a tilt of exactly 0 would show no rocking below the dashed line. Its
# landings strike the whole base at once, which no real part does. A run warns of them:

flat = sb.simulate(model, vibration(50.0, 1.0, 25.0), duration=0.5)
print(flat.outcome.name, "-", *flat.warnings)

# %%
# One cell is one phase of the vibration and one initial tilt. A fair answer counts
# postures over both. :func:`stylobate.conveying.upright` does it, here for strokes of
# 0.3 mm, 0.6 mm and 1 mm:

postures = {}
for stroke in (0.3, 0.6, 1.0):
    motion = vibration(50.0, stroke, 25.0)
    postures[stroke] = sb.conveying.upright(
        model, motion, tilts=[1e-5, 1e-3, 1e-2], phases=32
    )
    print(f"stroke {stroke} mm:", postures[stroke].attrs["verdict"])

figure = sb.plot(postures[1.0])

# %%
# Stroke and friction together, from a tilt of 1 mrad. A smoother trough lowers the
# share that falls; above Γ = 1 it does not make it zero at every stroke.

for stroke in (0.6, 1.0):
    for friction in (0.1, 0.2, 0.4):
        motion = vibration(50.0, stroke, 25.0)
        found = sb.conveying.upright(
            model, motion, tilts=[1e-3], phases=32, friction=friction
        )
        share = float(found["share"].sel(posture_name="fallen"))
        print(f"stroke {stroke} mm, μ = {friction}: {share:.0%} of the runs fall")

# %%
# One of these runs as an animation, eight times slower than the motion. The blue line
# is the path of the contact point. :func:`stylobate.animate` saves it as a GIF, a film
# or a web page if you pass a path.

runs = postures[1.0]
first = np.flatnonzero(runs["posture"] == sb.conveying.Posture.FALLEN)[0]
start = runs.isel(run=first)
changed = sb.with_parameters(
    model, vibration(50.0, 1.0, 25.0), start_phase=float(start["start_phase"])
)
tilt = (float(start["tilt_x"]), float(start["tilt_y"]))
fallen = sb.simulate(*changed, tilt=tilt, duration=5.0)
print(fallen.outcome.name, f"after {fallen.decided_at:.2f} s")

sb.animate(fallen, size=(420, 320), speed=0.125)

# %%
# What to do with these results
# -----------------------------
#
# * Count postures by :func:`stylobate.conveying.upright`, with the initial tilts of
#   your process. Lower the stroke or the friction until few enough parts fall.
# * Below Γ = 1 a part that starts flat slides if μ < c, and the drive alone does not
#   tip it. A part that starts askew rocks.
# * Above Γ = 1 no friction coefficient keeps a part upright by itself: a landing on
#   one side of the base tips it.
#
# Next: :doc:`/how-to/conveyors` for inclines, bowl feeders and the command line;
# :doc:`/explanation/sliding` for the model and its assumptions.
