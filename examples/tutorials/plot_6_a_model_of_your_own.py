"""
A model of your own
===================

Add a physical effect that no built-in model has: a spring between the column and its
base, such as a vertical tendon or a soft pad. This tutorial derives the equation,
writes the model, lets the package check it, and then uses it in runs, maps and
periodic orbits. You need to know how to write a Python class. The guide
:doc:`/how-to/write-a-model` lists all members of a model.
"""

# %%
# The equation
# ------------
#
# The slender column obeys, with the tilt vector **θ**, its direction **u**, the
# slenderness c, the damping η and the base acceleration **a** in units of g,
#
# .. math::
#
#    \ddot{\boldsymbol\theta} = (1 + a_z)(\boldsymbol\theta - c\,\mathbf u)
#    - \eta\,\dot{\boldsymbol\theta} - \mathbf a_h .
#
# Times are in units of 1/ω₀. A rotational spring of the stiffness :math:`k_\theta`
# [N m/rad] adds a moment towards the vertical. Divide it by m g h, and the equation
# contains one more term:
#
# .. math::
#
#    \ddot{\boldsymbol\theta} = (1 + a_z)(\boldsymbol\theta - c\,\mathbf u)
#    - k\,\boldsymbol\theta - \eta\,\dot{\boldsymbol\theta} - \mathbf a_h,
#    \qquad k = \frac{k_\theta}{m g h} .
#
# The restoring moment at rest shows the effect. Without a spring it vanishes at θ = c,
# where the column overturns. With 0 < k < 1 it vanishes at θ = c/(1 − k). With k ≥ 1
# it grows, and the column cannot overturn.

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

tilt = np.linspace(0.0, 3.0, 301)  # θ/c
figure, axes = plt.subplots(figsize=(6.4, 3.4))
for stiffness, colour in ((0.0, "black"), (0.5, "#0072b2"), (1.2, "#d55e00")):
    moment = 1.0 - tilt + stiffness * tilt
    axes.plot(tilt, moment, color=colour, label=f"k = {stiffness:g}")
axes.axhline(0.0, color="black", linewidth=0.6)
axes.set_xlabel("tilt θ/c")
axes.set_ylabel("restoring moment / (m g r)")
axes.set_ylim(-1.5, 2.0)
axes.legend()
figure.tight_layout()

# %%
# Write the class
# ---------------
#
# A model is a class. Its equations are static functions of plain numbers: the package
# reads their text and compiles it for ensembles, maps and orbits. So the text must be
# in a module, in a script such as this one, or in a cell of a notebook. Functions
# without a text, such as those made by ``exec``, cannot be compiled. Then single runs
# use plain Python and print a notice, and ensembles raise an error.
#
# The spring changes one term of :class:`stylobate.Slender`. So the class inherits from
# it and replaces members. The first attempt replaces three of them:
#
# * ``stiffness``, a declared number with symbol, text and bounds;
# * ``parameters``, the numbers that all static functions receive last;
# * ``rates``, the equations. ``contact``, the forces on the rim, has the same term.


def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
    _, _, bx, by = sb.Slender.rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)
    return vx, vy, bx - k * x, by - k * y


def contact(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
    """Return normal force, friction, and moment about the vertical: N, T, M."""
    _, _, bx, by = rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k)
    tx, ty = ax + kappa * bx, ay + kappa * by
    across = (x * ty - y * tx) / math.sqrt(x * x + y * y + 1e-300)
    return 1.0 + az, math.hypot(tx, ty), abs(across)


@dataclass(frozen=True, slots=True)
class HalfDone(sb.Slender):
    """A slender column with a spring, which other members still ignore."""

    stiffness: Annotated[
        float, sb.Quantity(symbol="k", text="stiffness of the spring", ge=0.0)
    ] = 0.0

    name: ClassVar[str] = "half done"
    rates = staticmethod(rates)
    contact = staticmethod(contact)

    @property
    def parameters(self):
        column = self.column
        return column.slenderness, self.damping, column.inertia_ratio, self.stiffness


# %%
# Let the package find the contradictions
# ---------------------------------------
#
# Each inherited member makes a claim that the spring may break.
# :func:`stylobate.models.check` compares all members with the equations at random
# states. The first run of your own model makes the cheap comparisons by itself.

stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
try:
    sb.models.check(HalfDone(stone, damping=0.05, stiffness=0.5))
except sb.errors.ModelError as error:
    for problem in error.problems:
        print("-", problem)

# %%
# Complete the model
# ------------------
#
# ``planar_rates`` are the equations of planar motion. ``no_return_tilt`` is the tilt
# from which overturning is certain. Beyond it the tilt accelerates outwards under every
# admissible base acceleration:
#
# .. math::
#
#    (1 + a_z)(\theta - c) - k\theta - |a_h| > 0
#    \quad\Leftrightarrow\quad
#    \theta > \frac{c\,(1 + a_z) + |a_h|}{1 + a_z - k} .
#
# The right-hand side is largest at the smallest vertical acceleration. Where its
# denominator is not positive, the column can always come back: return infinity.
#
# ``energy`` and ``balance`` are optional. They let a run that ends in motion state
# whether the column could still overturn: ``balance`` is the tilt and the energy at
# which the column stands in unstable balance on its rim. A subclass with other
# ``rates`` does not inherit it.


@dataclass(frozen=True, slots=True)
class Sprung(HalfDone):
    """A slender column with a rotational spring between column and base."""

    name: ClassVar[str] = "sprung"

    @staticmethod
    def planar_rates(tilt, rate, side, horizontal, vertical, c, eta, _kappa, k):
        lean = (1.0 + vertical) * (tilt - c * side)
        return rate, lean - k * tilt - eta * rate - horizontal

    @staticmethod
    def no_return_tilt(horizontal, vertical, c, _eta, _kappa, k):
        weight = 1.0 + vertical
        if weight <= k:
            return math.inf
        return (c * weight + horizontal) / (weight - k)

    def energy(self, states):
        """Return the energy above rest [J]."""
        x, y, vx, vy = states[:4]
        tilt = np.hypot(x, y)
        c, k = self.column.slenderness, self.stiffness
        energy = 0.5 * (vx**2 + vy**2) + c * tilt - 0.5 * (1.0 - k) * tilt**2
        return energy * self.unit

    @property
    def balance(self):
        """Tilt [rad] and energy [J] of unstable balance."""
        c, k = self.column.slenderness, self.stiffness
        if k >= 1.0:
            return sb.models.Balance(tilt=math.inf, energy=math.inf)
        energy = 0.5 * c**2 / (1.0 - k) * self.unit
        return sb.models.Balance(tilt=c / (1.0 - k), energy=energy)

    @property
    def unit(self):
        """Unit of energy, J0 ω0² [J]."""
        return self.column.base_inertia * self.column.frequency_scale**2


for stiffness in (0.0, 0.5, 1.2):
    sb.models.check(Sprung(stone, damping=0.05, stiffness=stiffness))
print("no contradictions")

# %%
# A wrong formula does not pass. Declared bounds work as in the built-in models, too:

try:
    Sprung(stone, stiffness=-1.0)
except sb.errors.ParameterError as error:
    print(error)

# %%
# Simulate an earthquake
# ----------------------
#
# Without the spring the model must equal :class:`stylobate.Slender`. This comparison is
# the first test to write.

quake = sb.sample_record("el centro 1940")
plain = sb.simulate(sb.Slender(stone, damping=0.05), quake)
same = sb.simulate(Sprung(stone, damping=0.05, stiffness=0.0), quake)
end = min(float(run.data["time"][-1]) for run in (plain, same))
time = np.linspace(0.0, end, 500)
difference = abs(plain.sample(time)["tilt"] - same.sample(time)["tilt"]).max()
print(f"largest difference of the tilt: {float(difference):.1e} rad")

# %%
# Scale the record until the free column overturns, and add springs.

strong = quake.scaled(1.3)
runs, labels = [], []
for stiffness in (0.0, 0.5, 1.2):
    run = sb.simulate(Sprung(stone, damping=0.05, stiffness=stiffness), strong)
    runs.append(run)
    labels.append(f"k = {stiffness:g}")
    print(f"{labels[-1]}: {run.outcome.name} - {run.reason}")
sb.plot(runs, labels=labels)

# %%
# Compute a map
# -------------
#
# Ensembles, maps and sweeps compile the equations of the model. ``stiffness`` is a
# parameter like any other.

shaking = sb.Harmonic.straight(acceleration=1.5, angular_frequency=7.0)
found = sb.studies.overturning_map(
    Sprung(stone, damping=0.05),
    shaking,
    over={
        "acceleration": np.linspace(0.5, 15.0, 59),
        "stiffness": np.linspace(0.0, 1.0, 41),
    },
    periods=40,
)
sb.plot(found)

# %%
# The black region shrinks as the spring becomes stiffer, and its border is irregular:
# near it, small changes decide the outcome. The onset of rocking does not change,
# because the spring is unloaded while the column stands.
#
# Find a periodic orbit
# ---------------------
#
# :func:`stylobate.orbits.periodic_orbit` differentiates the equations of any smooth
# model. The closed form of steady rolling is not known for this one, so pass a guess:
# here steady rolling of the column without spring. Then follow the orbit over the
# stiffness.

circle = sb.Harmonic.circular(acceleration=0.8, angular_frequency=5.0)
guess = sb.orbits.periodic_orbit(sb.Slender(stone, damping=0.1), circle)
start = (*guess.tilt, *guess.tilt_rate)
orbit = sb.orbits.periodic_orbit(Sprung(stone, damping=0.1), circle, guess=start)
branch = sb.orbits.continue_branch(orbit, "stiffness", bounds=(0.0, 2.0))

print("stable from end to end:", bool(branch.points["stable"].all()))
figure, axes = plt.subplots(figsize=(6.4, 3.4))
tilt = branch.points["mean_tilt"] / stone.slenderness
axes.plot(branch.points["stiffness"], tilt, color="#0072b2", linewidth=2)
axes.set_xlabel("stiffness of the spring k")
axes.set_ylabel("mean tilt of rolling, θ/c")
figure.tight_layout()

# %%
# Where to go on
# --------------
#
# * Put the class into a module of your project, and call
#   ``sb.models.check`` in its tests.
# * In a TOML file or on the command line the model is ``file.py:Sprung``.
# * :doc:`/how-to/write-a-model` lists every optional member and how to contribute a
#   model. :doc:`/how-to/orbits` continues with bifurcations.
