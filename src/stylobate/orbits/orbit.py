"""Periodic orbits: their properties, their files, and checks of the arguments for them."""

import cmath
import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.cards import CardSection, Row, card
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.engine.forcing import common_line
from stylobate.equality import ByContent
from stylobate.errors import FileError, ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.models.consistency.check import check_once
from stylobate.orbits.shooting import Shots, is_stable
from stylobate.provenance import provenance_of_run
from stylobate.results.storage import write_netcdf
from stylobate.results.tables import to_dataframe
from stylobate.text import four_digits, plural

if TYPE_CHECKING:
    import pandas as pd

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]

_SAMPLES = 128
# An orbit has a symmetry if it differs from its image by at most this fraction of its size.
_SAME = 1e-7
# Tilt [c] below which a planar state is in a passage of the vertical, and a short time after the passage [periods].
_PASSING, _LATER = 1e-9, 0.03


@dataclass(frozen=True, eq=False)
class PeriodicOrbit(ByContent):
    """A periodic orbit, exact to rounding, with its Floquet multipliers.

    Attributes
    ----------
    model, motion
        The column and its base motion.
    periods
        Length of the orbit in periods of the base motion.
    chain
        Its shooting segments, in units of the model.
    line
        Unit vector of the vertical plane of a planar orbit, or None.
    rtol
        Relative tolerance of the flow.
    """

    model: Model
    motion: BaseMotion
    periods: int
    chain: Shots
    line: tuple[float, float] | None = None
    rtol: float = 1e-12

    @property
    def state(self) -> Floats:
        """State at t = 0, in units of the model; tilt and its rate along `line` for a planar orbit."""
        return np.asarray(self.chain.states[0])

    @property
    def tilt(self) -> Floats:
        """Tilt vector at t = 0 [rad]."""
        tilt: Floats = self._lean[:2]
        return tilt

    @property
    def tilt_rate(self) -> Floats:
        """Rate of the tilt vector at t = 0 [rad/s]."""
        return np.asarray(self._lean[2:] / self.model.time_scale)

    @property
    def spin(self) -> float:
        """Angular velocity about the axis at t = 0 [rad/s]; 0 for a model without spin."""
        place = self.model.spin_state
        return 0.0 if place is None or self.planar else float(self.state[place]) / self.model.time_scale

    @cached_property
    def _lean(self) -> Floats:
        lean: Floats = lean_of(self.system, self.state[:, np.newaxis])[:, 0]
        return lean

    @property
    def period(self) -> float:
        """Period of the orbit [s]."""
        period = self.motion.period
        assert period is not None
        return self.periods * period

    @cached_property
    def system(self) -> PeriodicSystem:
        """The system of the orbit."""
        return PeriodicSystem(self.model, self.motion, self.line, self.rtol)

    @cached_property
    def multipliers(self) -> Complexes:
        """Floquet multipliers, the largest first; for a planar orbit those of disturbances within the plane."""
        found = np.linalg.eigvals(self._monodromy).astype(complex)
        return found[np.argsort(-np.abs(found), kind="stable")]

    @property
    def _monodromy(self) -> Floats:
        """Derivative of the state after the orbit by the state at its start.

        If the orbit starts in a passage of the vertical, rounding decides whether the jump counts at the start or at
        the end. The derivative then starts a short time later; its eigenvalues are the same.
        """
        if not self.planar or abs(self.state[0]) > _PASSING * self.system.scale:
            return self.chain.monodromy
        before = self.system.carry(self.state, 0.0, _LATER)
        around = self.system.carry(before.end, _LATER, _LATER + self.periods, side=before.side)
        return around.by_start

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle; for a planar orbit, stability within its plane.

        Without damping nothing decays: the product of the multipliers is 1. True then means neutrally stable: no
        multiplier lies outside the unit circle by more than 1e-9, their accuracy.
        """
        return is_stable(self.multipliers)

    @property
    def planar(self) -> bool:
        """Whether the orbit is planar; disturbances out of its plane then have no multiplier."""
        return self.line is not None

    @property
    def minimum_tilt(self) -> float:
        """Minimum tilt angle [rad]."""
        return self.chain.minimum_tilt

    @property
    def peak_tilt(self) -> float:
        """Maximum tilt angle [rad]."""
        return self.chain.peak_tilt

    @cached_property
    def path(self) -> Floats:
        """Tilt vector [rad] and its rate [rad per unit of the model's time] over the orbit, shape (4, n)."""
        return lean_of(self.system, self.states(_SAMPLES * self.periods))

    def states(self, count: int) -> Floats:
        """Return states at `count` equal steps of time over the orbit, shape (order, count), beginning with t = 0."""
        arcs = len(self.chain.states)
        states = np.empty((self.system.order, count))
        at, state, side = 0.0, self.state, 0.0
        for index, phase in enumerate(self.periods * np.arange(count) / count):
            # Each arc starts on the orbit, so that drift along an unstable orbit does not accumulate.
            arc = int(phase * arcs / self.periods + 1e-12)
            begin = arc / arcs * self.periods
            if begin > at + 1e-12:
                at, state, side = begin, self.chain.states[arc], 0.0
            if phase > at:
                flow = self.system.carry(state, at, float(phase), side=side)
                at, state, side = float(phase), flow.end, flow.side if self.planar else 0.0
            states[:, index] = state
        return states

    @property
    def mean_tilt(self) -> float:
        """Mean tilt angle [rad]."""
        return float(np.hypot(*self.path[:2]).mean())

    @property
    def turns(self) -> float:
        """Turns of the contact point round the rim in one period of the base motion, anticlockwise positive.

        It is 0 for a planar orbit: the contact point jumps from one side to the other.
        """
        return round(self.chain.turns) / self.periods

    @cached_property
    def inversion(self) -> bool:
        """Whether the column leans the opposite way half a period later: x(t + nT/2) = −x(t)."""
        samples = self.path.shape[1]
        return self._same(-np.roll(self.path, samples // 2, axis=1))

    @cached_property
    def reflection(self) -> bool:
        """Whether the orbit is its own mirror image, half a period later, across the line of a straight base motion.

        That is x(t + nT/2) = −x(t), y(t + nT/2) = y(t), with x along the line; False for other base motions.
        """
        line = common_line(*self.motion.directions())
        if line is None:
            return False
        ux, uy = line
        x, y, vx, vy = np.roll(self.path, self.path.shape[1] // 2, axis=1)
        along, rate = ux * x + uy * y, ux * vx + uy * vy
        return self._same(np.stack([x - 2 * ux * along, y - 2 * uy * along, vx - 2 * ux * rate, vy - 2 * uy * rate]))

    def _same(self, image: Floats) -> bool:
        size = np.abs(self.path).max(axis=1, keepdims=True)
        return bool(np.all(np.abs(self.path - image) <= _SAME * np.where(size > 0.0, size, 1.0)))

    def to_dataframe(self) -> "pd.DataFrame":
        """Convert the orbit to a table in pandas: tilt vector and its rate at equal steps of time over the period."""
        count = self.path.shape[1]
        time = ("time", self.period * np.arange(count) / count, {"units": "s"})
        tilt, rate = self.path[:2].T, self.path[2:].T / self.model.time_scale
        data = {
            "tilt": (("time", "axis"), tilt, {"units": "rad"}),
            "tilt_rate": (("time", "axis"), rate, {"units": "rad s-1"}),
        }
        return to_dataframe(xr.Dataset(data, coords={"time": time, "axis": ["x", "y"]}))

    def save(self, path: str | Path) -> Path:
        """Write the orbit to a netCDF file at `path`; `stylobate.load` reads it."""
        return write(self._data(), path)

    def _data(self) -> xr.Dataset:
        """Return the states from which shooting recovers the orbit."""
        states = (("arc", "state"), self.chain.states)
        return xr.Dataset({"states": states}, attrs=file_attributes(self.system, ORBIT, self.periods))

    def __repr__(self) -> str:
        """Describe the orbit in one line."""
        stability = "stable" if self.stable else "unstable"
        kind = f"period {self.periods}, {self.turns:+.3g} turns per period"
        return f"PeriodicOrbit({stability}, {kind}, tilt {range_of([self.minimum_tilt, self.peak_tilt])} rad)"

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        largest = complex(self.multipliers[0])
        angle = f" at {four_digits(abs(cmath.phase(largest)))} rad" if largest.imag else ""
        rows = [
            Row("stability", f"{'stable' if self.stable else 'unstable'}{' within its plane' if self.planar else ''}"),
            Row("period", f"{four_digits(self.period)} s, {plural(self.periods, 'period')} of the base motion"),
            Row("turns per period", f"{self.turns:+.4g}"),
            Row("tilt", f"{range_of([self.minimum_tilt, self.peak_tilt])} rad", "θ"),
            Row("largest multiplier", f"{four_digits(abs(largest))}{angle}"),
        ]
        return card("Periodic orbit", [CardSection("", rows), *system_sections(self.system)])


def range_of(values: Iterable[float]) -> str:
    """Format the minimum and maximum of numbers in one line."""
    values = list(values)
    return f"{four_digits(min(values))}…{four_digits(max(values))}"


def system_sections(system: PeriodicSystem) -> list[CardSection]:
    """Return the rows of a card for the model and the base motion of a system."""
    return [CardSection("system", [Row("model", repr(system.model)), Row("base motion", repr(system.motion))])]


def lean_of(system: PeriodicSystem, states: Floats) -> Floats:
    """Return tilt vectors and rates, shape (4, n), of states, shape (order, n)."""
    model = system.model
    if system.line is not None:
        ux, uy = system.line
        tilt, rate = states
        return np.stack([tilt * ux, tilt * uy, rate * ux, rate * uy])
    lean = model.tilt_of(*states, *model.parameters)
    return np.stack(np.broadcast_arrays(*lean)).astype(float)


def require_subject(model: Model, motion: BaseMotion) -> None:
    """Raise ParameterError unless these are a model and a base motion, ModelError if the model contradicts itself."""
    if isinstance(model, BaseMotion) and isinstance(motion, Model):
        raise ParameterError(
            f"model must come before motion: got {type(model).__name__} as model, {type(motion).__name__} as motion"
        )
    if not isinstance(model, Model):
        raise ParameterError(f"model must be a model such as Slender(column), got {model!r}")
    if not isinstance(motion, BaseMotion) or motion == BASE_AT_REST:
        raise ParameterError(f"motion must be a periodic base motion such as Harmonic.circular(...), got {motion!r}")
    check_once(model)


def require_orbit(orbit: PeriodicOrbit) -> None:
    """Raise ParameterError unless `orbit` is a periodic orbit."""
    if not isinstance(orbit, PeriodicOrbit):
        raise ParameterError(f"orbit must be a PeriodicOrbit such as periodic_orbit(model, motion), got {orbit!r}")


ORBIT, BRANCH, CURVE = "stylobate orbit 1", "stylobate branch 1", "stylobate bifurcation curve 1"
"""Formats of the files of orbits, branches and curves."""

SUPERCRITICAL = {True: 1, False: 0, None: -1}
"""Code of a supercritical loss of stability in files and tables; −1 if undecided."""

SUPERCRITICAL_OF = {code: supercritical for supercritical, code in SUPERCRITICAL.items()}
"""Meaning of the code."""

_SUFFIX = ".nc"


def write(data: xr.Dataset, path: str | Path) -> Path:
    """Write the data of an orbit, a branch or a curve to the netCDF file `path`.

    Raises
    ------
    ParameterError
        If the path does not end in .nc.
    FileError
        If the file cannot be written.
    """
    path = path_of(path)
    if path.suffix != _SUFFIX:
        raise ParameterError(f"path must end in {_SUFFIX}, the format of the file; got {str(path)!r}")
    if not path.parent.is_dir():
        raise FileError(f"cannot write {path}: there is no folder {path.parent}")
    return write_netcdf(data, path)


def path_of(path: str | Path) -> Path:
    """Return `path`, or raise ParameterError if it is not the name of a file."""
    try:
        return Path(path)
    except TypeError:
        raise ParameterError(f"path must be the name of a file, got {path!r}") from None


def file_attributes(system: PeriodicSystem, format_name: str, periods: int) -> dict[str, Any]:
    """Return the attributes of a file: its format, the length of the orbit and the system.

    Raises
    ------
    UnsupportedError
        If model or motion is of a class of your own, which a file cannot hold.
    """
    provenance = provenance_of_run(system.model, system.motion)
    for name in ("model", "motion"):
        if provenance[name].get("kind") == "other":
            raise UnsupportedError(f"an orbit of a {name} of your own cannot be saved: {provenance[name]['repr']}")
    return {
        "format": format_name,
        "periods": periods,
        "line": np.array(system.line if system.line is not None else (math.nan, math.nan)),
        "rtol": system.rtol,
        "provenance": json.dumps(provenance),
    }
