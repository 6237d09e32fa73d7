"""Round bodies that others measured: steady spin on a rim, the angle of turn, and disks that settle.

No table of measurements was at hand. The measured statements are those of abstracts and excerpts, which each source
names; the other rows compare closed forms with the package.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

import stylobate as sb
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.plots.style import BLACK, BLUE, DASHES, GREEN, ORANGE, PURPLE, VERMILION, new_figure, styled

from .finding import FOLDER, Finding, Kind
from .rolling_rim import cases

Floats = npt.NDArray[np.float64]

FIGURE = FOLDER / "settling.png"

RADIUS, MASS = 0.0375, 0.4
"""Radius [m] and mass [kg] of the toy "Euler's Disk", from excerpts of Bildsten (2001) and Science News (2000)."""


def thin_disk(thinness: float = 200.0) -> sb.Column:
    """Return a uniform disk of the toy's radius and mass, whose centre of mass is r/`thinness` above its base."""
    return sb.Column(
        radius=RADIUS,
        mass_height=RADIUS / thinness,
        mass=MASS,
        transverse_inertia=MASS * RADIUS**2 / 4.0,
        axial_inertia=MASS * RADIUS**2 / 2.0,
    )


def cylinder(height_ratio: float) -> sb.Column:
    """Return a solid cylinder of 20 mm diameter; `height_ratio` is its height over its diameter."""
    return sb.Column.solid(radius=0.01, height=0.02 * height_ratio, density=1200.0)


def numbers_of(column: sb.Column) -> dict[str, float]:
    """Return the dimensionless numbers of a column, as closed forms take them."""
    return {"c": column.slenderness, "inertia_ratio": column.inertia_ratio, "axial_ratio": column.axial_ratio}


def centred_rate(column: sb.Column, tilt: float) -> float:
    """Compute the rolling rate [rad/s] at which the centre of mass stays at rest; NaN in the forbidden range of tilts.

    A body whose centre of mass and contact point are at rest turns about the line between them. Euler's equations then
    require β̇² sin θ (I_t cos θ − I_a (h/r) sin θ) = m g (r cos θ − h sin θ).
    """
    sine, cosine = math.sin(tilt), math.cos(tilt)
    moment = column.mass * column.gravity * (column.radius * cosine - column.mass_height * sine)
    inertia = column.transverse_inertia * cosine - column.axial_inertia / column.slenderness * sine
    square = moment / (sine * inertia)
    return math.sqrt(square) if square >= 0.0 else math.nan


def centred_start(column: sb.Column, tilt: float, falling: float = 0.0) -> dict[str, Any]:
    """Return the initial conditions of that motion, with the tilt falling at the rate `falling` [rad/s]."""
    rate = centred_rate(column, tilt)
    # The centre of mass is at rest if c w3 + w1 = 0, w1 = −β̇ sin θ.
    spin = rate * math.sin(tilt) / column.slenderness
    return {"tilt": (tilt, 0.0), "tilt_rate": (-falling, tilt * rate), "spin": spin}


def package_rate(column: sb.Column, tilt: float) -> float:
    """Return the rate [rad/s] that `theory.free_rolling` has at this tilt and the spin of a centre of mass at rest."""
    scale, spin = column.frequency_scale, centred_start(column, tilt)["spin"]
    rates = sb.theory.free_rolling(tilt, spin / scale, **numbers_of(column)).rate * scale
    return float(min(rates, key=lambda rate: abs(rate - centred_rate(column, tilt))))


def centred_stable(column: sb.Column, tilt: float) -> bool:
    """Return whether `theory.free_rolling` calls that motion stable."""
    scale, spin = column.frequency_scale, centred_start(column, tilt)["spin"]
    rolling = sb.theory.free_rolling(tilt, spin / scale, **numbers_of(column))
    nearest = int(np.argmin(np.abs(rolling.rate * scale - centred_rate(column, tilt))))
    return bool(rolling.stable[nearest])


def fast_tilt(column: sb.Column) -> float:
    """Find the tilt at which the rate grows without bound, from `theory.free_rolling_spin` at a huge rate [rad]."""
    fast = 1e9

    def excess(tilt: float) -> float:
        spin = float(sb.theory.free_rolling_spin(tilt, fast, **numbers_of(column))) / fast
        return spin - math.sin(tilt) / column.slenderness

    low, high = 1e-3, 0.5 * math.pi - 1e-3
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (excess(middle) > 0.0) == (excess(low) > 0.0) else (low, middle)
    return 0.5 * (low + high)


def critical_height_ratio() -> float:
    """Find the height over diameter at which the forbidden range of tilts of a cylinder shrinks to nothing."""
    low, high = 0.5, 2.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        column = cylinder(middle)
        low, high = (low, middle) if fast_tilt(column) > column.tipping_angle else (middle, high)
    return 0.5 * (low + high)


@dataclass(frozen=True, slots=True)
class Loss:
    """A law of dissipation of a settling disk: its power as a power of the rate Ω of the contact point.

    Steady rolling of a flat disk has Ω² ∝ 1/θ and an energy ∝ θ. A loss ∝ Ω^q then ends after a finite time if q > −2,
    with θ ∝ (t_f − t)^(2/(2 + q)) and Ω ∝ (t_f − t)^(−1/(2 + q)).
    """

    name: str
    power: float

    @property
    def tilt_exponent(self) -> float:
        """Exponent of the tilt in the time before the end."""
        return 2.0 / (2.0 + self.power)

    @property
    def rate_exponent(self) -> float:
        """Exponent of the rate of the contact point in the time before the end."""
        return -1.0 / (2.0 + self.power)


RESISTANCE = Loss("`rolling_resistance`", -1.0)
LOSSES = (
    RESISTANCE,
    Loss("constant along the path", 1.0),
    Loss("loss ∝ Ω²", 2.0),
    Loss("air, boundary layer", 2.5),
    Loss("air, whole gap", 4.0),
)
"""The laws that end after a finite time."""


@dataclass(frozen=True, slots=True)
class Settling:
    """A simulated disk that settles: times [s], tilts [rad], rates of the contact point [rad/s], energies [J]."""

    times: Floats
    tilt: Floats
    rate: Floats
    energy: Floats

    @property
    def loss_power(self) -> float:
        """Power of the rate to which the loss is proportional, by regression."""
        loss = -np.gradient(self.energy, self.times)[1:-1]
        return float(np.polyfit(np.log(self.rate[1:-1]), np.log(loss), 1)[0])

    @property
    def inverse_rate_slope(self) -> float:
        """Slope of 1/Ω in time, by regression."""
        return float(np.polyfit(self.times, 1.0 / self.rate, 1)[0])


def settle(tilt: float = 0.05, decades: float = 2.0, **loss: float) -> Settling:
    """Simulate a thin disk from steady rolling at `tilt` [rad] with a small loss, over `decades` of its energy."""
    disk = thin_disk()
    model = sb.Rolling(disk, **loss)
    start = centred_start(disk, tilt)
    lost = -np.diff(sb.simulate(model, **start, duration=1e-3, samples=2, rest_energy=0.0).data["energy"].to_numpy())
    decay = float(1e-3 * 1.5 * MASS * STANDARD_GRAVITY * RADIUS * tilt / lost[0])  # E/|Ė|
    if "rolling_resistance" in loss:  # E ∝ (t_f − t)²
        duration = 2.0 * decay * (1.0 - 10.0 ** (-0.5 * decades))
    else:  # E ∝ exp(−t/decay), the law of damping
        duration = decades * math.log(10.0) * decay
    start = centred_start(disk, tilt, falling=tilt / decay)
    run = sb.simulate(model, **start, duration=duration, samples=2001, rest_energy=0.0, rtol=1e-10, max_steps=2_000_000)
    data = run.data
    return Settling(*(data[name].to_numpy() for name in ("time", "amplitude", "rolling_rate", "energy")))


def findings() -> Iterator[Finding]:
    """Yield all comparisons of this part, and draw the figure."""
    yield from _spinning()
    yield from _turning()
    yield from _settling()
    figure().savefig(FIGURE, dpi=200)


@styled
def figure() -> Any:
    """Draw tilt over time, and rate over the time before the end, of disks with the same loss at the start."""
    drawn = new_figure(3.4)
    falling, rising = drawn.subplots(1, 2)
    colors = (BLUE, VERMILION, GREEN, PURPLE, ORANGE)
    for loss, color, dash in zip(LOSSES, colors, DASHES, strict=False):
        before = loss.tilt_exponent * np.logspace(0.0, -3.0, 301)  # time before the end, in E/|Ė| at the start
        tilt = (before / before[0]) ** loss.tilt_exponent
        label = loss.name.replace("`", "")
        falling.plot([*(before[0] - before), before[0]], [*tilt, 0.0], color=color, linestyle=dash, label=label)
        rising.plot(before, tilt**-0.5, color=color, linestyle=dash)
    run = settle(rolling_resistance=0.003)
    decay = run.energy[0] / -np.gradient(run.energy, run.times)[0]
    end = float(np.roots(np.polyfit(run.times, 1.0 / run.rate, 1))[0])
    chosen = slice(None, None, 125)
    dots = {"color": BLUE, "marker": "o", "markersize": 4, "linestyle": "", "label": "rolling_resistance, simulated"}
    falling.plot(run.times[chosen] / decay, run.tilt[chosen] / run.tilt[0], **dots)
    rising.plot((end - run.times[chosen]) / decay, run.rate[chosen] / run.rate[0], **dots)
    damped = np.linspace(0.0, 3.0, 200)
    falling.plot(damped, np.exp(-damped), color=BLACK, linewidth=0.9, label="damping")
    falling.set(xlabel="time over E/|dE/dt| at the start [1]", ylabel="tilt over that at the start [1]")
    rising.set(xlabel="time before the end, in the same unit [1]", ylabel="rate Ω over that at the start [1]")
    rising.set(xscale="log", yscale="log", xlim=(3.0, 1e-3), ylim=(0.9, 100.0))
    drawn.legend(*falling.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return drawn


_JACKSON = "closed form of this page, for the motion of Jackson et al. (2019)"


def _spinning() -> Iterator[Finding]:
    for ratio, tilt in ((2.0, 0.2), (2.0, 1.4), (0.3, 0.1)):
        column = cylinder(ratio)
        rate = centred_rate(column, tilt)
        run = sb.simulate(sb.Rolling(column), **centred_start(column, tilt), duration=40.0 * math.pi / rate, rtol=1e-12)
        azimuth = run.data["azimuth"].to_numpy()
        mean = float((azimuth[-1] - azimuth[0]) / run.data["time"][-1])
        stable = centred_stable(column, tilt)
        yield Finding(
            _JACKSON,
            f"spinning cylinder, height {ratio:g} diameters, centre of mass at rest, tilt {tilt:g} rad: "
            "rate of the contact point [rad/s]",
            rate,
            mean if stable else package_rate(column, tilt),
            Kind.MATHEMATICS,
            allowed=1e-9,
            remark="stable; mean of 20 turns of `Rolling`" if stable else "unstable; `theory.free_rolling`",
        )
    lying = cylinder(2.0)
    rate = package_rate(lying, 0.5 * math.pi - 1e-9)
    compared = "Ω² r/g of a cylinder that is spun lying down, the limit of a tilt of π/2"
    yield Finding(
        _JACKSON, compared, 2.0, rate**2 * lying.radius / lying.gravity, Kind.MATHEMATICS, remark="for every height"
    )
    compared = "height over diameter of a solid cylinder at which the forbidden range of tilts changes sides"
    yield Finding(
        _JACKSON, compared, math.sqrt(0.75), critical_height_ratio(), Kind.MATHEMATICS,
        remark="I_t = I_a; the abstract states that there is a critical value, not its number",
    )  # fmt: skip


_RUINA = "Srinivasan and Ruina (2008), abstract read"


def turns(offset: float) -> list[float]:
    """Return the angle of turn [degrees] of two cans that differ in the axial inertia only."""
    case = cases()["can"]
    slow = replace(case, turning=offset * case.column.frequency_scale)
    light = replace(slow, column=replace(slow.column, axial_inertia=0.2 * slow.column.axial_inertia))
    return [slow.exact, light.exact]


def _turning() -> Iterator[Finding]:
    column = cases()["can"].column
    limit = math.degrees(sb.theory.angle_of_turn(column.slenderness, inertia_ratio=column.inertia_ratio))
    solid, light = turns(1e-4)
    compared = "angle of turn of a can, c = 0.2 [°]"
    tall = "“just over π” for tall containers; `Slender` and `PlanarRocking` have exactly π"
    yield Finding(_RUINA, compared, 180.0, limit, Kind.EXPERIMENT, remark=tall)
    compared = "angle of turn of two cans of axial inertias 1 and 0.2: difference [°]"
    remark = "stated as independent of the axial inertia; `Rolling`, offset 1e-4"
    yield Finding(_RUINA, compared, 0.0, light - solid, Kind.MATHEMATICS, scale=1.0, allowed=5e-3, remark=remark)


_BILDSTEN = "Bildsten, arXiv gr-qc/0102046 (2001), excerpt read"
_MCDONALD = "McDonald and McDonald, arXiv physics/0008227 (2001), abstract read"
_SUMMARY = "Wikipedia, “Euler's Disk”, excerpt of a copy read"


def _settling() -> Iterator[Finding]:
    disk, tilt = thin_disk(), 1e-3
    compared = "Ω² r θ/g of a thin disk at a small tilt"
    rate = package_rate(disk, tilt)
    yield Finding(
        _BILDSTEN, compared, 4.0, rate**2 * RADIUS * tilt / STANDARD_GRAVITY, Kind.CODE, allowed=1e-3,
        remark="`theory.free_rolling` at a tilt of 1e-3 rad",
    )  # fmt: skip
    lever = 0.003
    resisted, damped = settle(rolling_resistance=lever), settle(damping=1.0)
    closed = "closed form of this page"
    compared = "`rolling_resistance` μ_r: slope of 1/Ω in time over μ_r, by `Rolling`"
    yield Finding(
        closed, compared, -1.0 / 3.0, resisted.inverse_rate_slope / lever, Kind.CODE, allowed=5e-3,
        remark="two decades of the tilt from 0.05 rad, μ_r = 0.003",
    )  # fmt: skip
    compared = "the same: power of Ω to which the loss is proportional"
    yield Finding(closed, compared, -1.0, resisted.loss_power, Kind.CODE, allowed=5e-3)
    compared = "`damping`: power of Ω to which the loss is proportional"
    yield Finding(closed, compared, -2.0, damped.loss_power, Kind.CODE, allowed=5e-3)
    remark = "the loss of the measured disk grows while it settles, with `rolling_resistance` it falls"
    compared = "power of Ω to which the loss of a settling disk is proportional, to the last cycle"
    yield Finding(_MCDONALD, compared, 2.0, resisted.loss_power, Kind.EXPERIMENT, scale=1.0, remark=remark)
    compared = "exponent of Ω in the time before the end, measured “approximately”"
    yield Finding(
        _SUMMARY, compared, -1.0 / 3.0, -1.0 / (2.0 + resisted.loss_power), Kind.EXPERIMENT, scale=1.0,
        remark="a constant loss for each length of the path of contact has −1/3",
    )  # fmt: skip
