"""A cylinder that rolls on its rim without impact and without loss: cases with exact answers for other programs."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

import stylobate as sb

Axes = npt.NDArray[np.float64]
"""Direction of the cylinder's axis at each sample."""

SAMPLE = 0.01
"""Time between two samples [s], a multiple of each step."""
G = 9.80665
DRIVE = 0.1 * G, 4.0
"""Acceleration [m/s²] and angular frequency [rad/s] of the circling base."""


def precession(times: Axes, _tilt: Axes, azimuth: Axes) -> float:
    """Return the mean rate of precession [rad/s]."""
    return float((azimuth[-1] - azimuth[0]) / times[-1])


def turn(times: Axes, tilt: Axes, azimuth: Axes) -> float:
    """Return the azimuth of the first maximum of the tilt, from that of the start [degrees]; NaN without maximum."""
    peaks = [i for i in range(4, len(tilt) - 3) if tilt[i - 1] < tilt[i] >= tilt[i + 1] and tilt[i] > 0.5 * tilt[0]]
    if not peaks:
        return math.nan
    near = slice(peaks[0] - 3, peaks[0] + 4)
    fit = np.polynomial.Polynomial.fit
    slopes = fit(times[near], tilt[near], 6).deriv().roots()
    top = min(slopes, key=lambda root: abs(root - times[peaks[0]])).real
    return math.degrees(fit(times[near], azimuth[near], 6)(top) - azimuth[0]) % 360.0


def farthest(_times: Axes, tilt: Axes, _azimuth: Axes) -> float:
    """Return the tilt that differs most from that of the start [degrees]."""
    return math.degrees(tilt[np.argmax(np.abs(tilt - tilt[0]))])


def last(_times: Axes, tilt: Axes, _azimuth: Axes) -> float:
    """Return the tilt at the end [degrees]."""
    return math.degrees(tilt[-1])


@dataclass(frozen=True, kw_only=True)
class Case:
    """A motion without impact, and the number that is compared."""

    title: str
    compared: str
    scalar: Callable[[Axes, Axes, Axes], float]
    column: sb.Column
    tilt: float
    turning: float
    """Initial rate of the azimuth [rad/s]; the tilt is at rest, and the column has no spin about its axis."""
    duration: float
    driven: bool = False
    resistance: float = 0.0
    """Lever arm of the normal force against the horizontal angular velocity, in radii."""

    @property
    def samples(self) -> int:
        """Number of samples after the start."""
        return round(self.duration / SAMPLE)

    @property
    def inertias(self) -> tuple[float, float, float]:
        """Moments of inertia about the centre of mass, the last about the axis [kg m²]."""
        return (self.column.transverse_inertia,) * 2 + (self.column.axial_inertia,)

    def gravity(self, at: float) -> list[float]:
        """Return gravity less the acceleration of the base: in the frame of the base they are the same."""
        size, frequency = DRIVE if self.driven else (0.0, 0.0)
        return [-size * math.cos(frequency * at), -size * math.sin(frequency * at), -G]

    def placed(self) -> tuple[Axes, Axes, Axes, Axes]:
        """Return centre, rotation, velocity and angular velocity of the start; the contact is the origin, at rest."""
        sine, cosine = math.sin(self.tilt), math.cos(self.tilt)
        rotation = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])
        centre = rotation @ (-self.column.radius, 0.0, self.column.mass_height)
        spinning = rotation @ (-self.turning * sine, 0.0, 0.0)
        return centre, rotation, np.cross(spinning, centre), spinning

    def stylobate(self, rtol: float) -> Callable[[], Axes]:
        """Return a run of `Rolling`."""
        base = sb.Harmonic.circular(acceleration=DRIVE[0], angular_frequency=DRIVE[1]) if self.driven else None
        start: dict[str, Any] = {"tilt": (self.tilt, 0.0), "tilt_rate": (0.0, self.tilt * self.turning)}
        options = start | {"duration": self.duration, "samples": self.samples + 1, "rtol": rtol}

        def run() -> Axes:
            model = sb.Rolling(self.column, rolling_resistance=self.resistance)
            x, y = sb.simulate(model, base, **options).data["tilt"].values.T
            tilt = np.hypot(x, y)
            return np.column_stack([np.sinc(tilt / np.pi) * x, np.sinc(tilt / np.pi) * y, np.cos(tilt)])

        return run

    def measured(self, axes: Axes) -> float:
        """Return the number that is compared."""
        x, y, z = axes.T
        times = np.linspace(0.0, self.duration, self.samples + 1)
        return self.scalar(times, np.arctan2(np.hypot(x, y), z), np.unwrap(np.arctan2(y, x)))

    @cached_property
    def exact(self) -> float:
        """The number by the package."""
        return self.measured(self.stylobate(1e-12)())


def steady(column: sb.Column, tilt: float) -> float:
    """Return the rate [rad/s] at which a column without spin rolls steadily round its rim."""
    body = {"c": column.slenderness, "inertia_ratio": column.inertia_ratio}
    return float(sb.theory.free_rolling(tilt, **body).rate[0]) * column.frequency_scale


def circling(column: sb.Column) -> float:
    """Return the tilt [rad] of steady rolling on the circling base."""
    ratio, share = DRIVE[1] / column.frequency_scale, DRIVE[0] / G
    body = {"c": column.slenderness, "inertia_ratio": column.inertia_ratio}
    return float(sb.theory.full_rolling(ratio, share, eta=0.0, zeta=0.0, **body).amplitude[-1])


def cases() -> dict[str, Case]:
    """Return the cases by name."""
    can = sb.Column.solid(radius=0.2, height=2.0, density=1000.0)
    coin = sb.Column.solid(radius=0.2, height=0.04, density=1000.0)
    return {
        "rolling": Case(
            title="rolling on the rim", compared="rate of precession [rad/s]", scalar=precession, column=can,
            tilt=0.1, turning=steady(can, 0.1), duration=10.0,
        ),
        "can": Case(
            title="wobbling can", compared="angle of turn [°]", scalar=turn, column=can,
            tilt=0.1, turning=0.02 * can.frequency_scale, duration=3.0,
        ),
        "circling": Case(
            title="rolling on a circling base", compared="tilt that differs most [°]", scalar=farthest, column=can,
            tilt=circling(can), turning=DRIVE[1], duration=10.0, driven=True,
        ),
        "coin": Case(
            title="coin", compared="rate of precession [rad/s]", scalar=precession, column=coin,
            tilt=0.2, turning=steady(coin, 0.2), duration=5.0,
        ),
    }  # fmt: skip


def settling() -> Case:
    """Return the case with loss: the rim that rolls as in "rolling", against rolling resistance."""
    loss = {"title": "settling", "compared": "tilt at the end [°]", "scalar": last, "resistance": 1e-2}
    return replace(cases()["rolling"], **loss)


def followed(case: Case, step: float, advance: Callable[[float, int], None], axis: Callable[[], Axes]) -> Axes:
    """Advance an engine from sample to sample and return the axes; `advance` takes a time and a number of steps."""
    each = round(SAMPLE / step)
    axes = [case.placed()[1][:, 2]]
    for sample in range(case.samples):
        advance(sample * SAMPLE, each)
        axes.append(np.array(axis()))
    return np.array(axes)
