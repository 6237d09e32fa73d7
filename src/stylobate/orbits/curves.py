"""Curves of bifurcations in two parameters."""

import json
import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.cards import CardSection, Row, card
from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.flow.periodic import FlowNumbers, PeriodicSystem
from stylobate.engine.parameters import present_value
from stylobate.equality import ByContent
from stylobate.errors import Interrupted, NoOrbitError, ParameterError, StylobateError
from stylobate.orbits.arclength import ASTRAY, BranchEnd, StepControl, control_of, enclosing, require_followed
from stylobate.orbits.bifurcations import (
    Bifurcation,
    BifurcationKind,
    PeriodMap,
    neimark_sacker_coefficient,
    period_doubling_coefficient,
    require_bifurcation,
)
from stylobate.orbits.orbit import CURVE, file_attributes, range_of, system_sections, write
from stylobate.orbits.shooting import Shots, shots
from stylobate.parameter_quantities import attributes_of, quantity_of
from stylobate.progress import Progress, Report, at_value, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.text import plural, unit_in_text

_log = logging.getLogger("stylobate")

Floats = npt.NDArray[np.float64]

_CLOSE, _MOST_STEPS = 1e-10, 12
# Step of the differences for the derivative of the condition; it does not move the solution of Newton's method.
_STEP = 1e-6
_LONGER, _SHORTER, _EASY, _HARD, _STRAIGHT = 1.5, 0.5, 4, 7, 0.95
# A pair of multipliers within this distance of the real axis is about to leave the circle.
_REAL = 1e-3


def _one(matrix: Floats) -> float:
    return float(np.linalg.det(matrix - np.eye(len(matrix))))


def _minus_one(matrix: Floats) -> float:
    return float(np.linalg.det(matrix + np.eye(len(matrix))))


def _pair(matrix: Floats) -> float:
    values = np.linalg.eigvals(matrix)
    first, second = np.triu_indices(len(values), 1)
    return float(np.prod(values[first] * values[second] - 1.0).real)


_CONDITIONS: dict[BifurcationKind, Callable[[Floats], float]] = {
    BifurcationKind.FOLD: _one,
    BifurcationKind.PITCHFORK: _minus_one,
    BifurcationKind.PERIOD_DOUBLING: _minus_one,
    BifurcationKind.NEIMARK_SACKER: _pair,
}


@dataclass(frozen=True, slots=True, eq=False)
class CurvePoint(ByContent):
    """A bifurcation on a curve: both parameters, the shooting segments of its orbit, and the critical eigenvalue."""

    values: tuple[float, float]
    chain: Shots
    multiplier: complex


@dataclass(frozen=True, eq=False)
class BifurcationCurve(ByContent):
    """The curve of a bifurcation in the plane of two parameters.

    Attributes
    ----------
    kind
        Kind of the bifurcation.
    parameters
        Names of the two parameters.
    path
        Points in order along the curve.
    ends
        Reasons why the curve ends, on either side.
    plane
        The plane of the two parameters, with the system.
    """

    kind: BifurcationKind
    parameters: tuple[str, str]
    path: tuple[CurvePoint, ...]
    ends: tuple[BranchEnd, BranchEnd]
    plane: "Plane"

    @cached_property
    def points(self) -> xr.Dataset:
        """The points as data over `point`: both parameters, tilts [rad], the coefficient of the normal form, its sign.

        `supercritical` is 1 if the loss of stability is supercritical, 0 if it is subcritical, −1 at folds and if the
        orbit is unstable on both sides.
        """
        coefficient = np.array([self.plane.coefficient(point) for point in self.path])
        supercritical = coefficient < 0.0 if self.kind is BifurcationKind.NEIMARK_SACKER else coefficient > 0.0
        decided = np.array([_only_critical(point) for point in self.path]) & ~np.isnan(coefficient)
        angle = np.abs(np.angle([point.multiplier for point in self.path]))
        system = self.plane.system
        return xr.Dataset(
            {
                "minimum_tilt": ("point", [p.chain.minimum_tilt for p in self.path], {"units": "rad"}),
                "peak_tilt": ("point", [p.chain.peak_tilt for p in self.path], {"units": "rad"}),
                "coefficient": ("point", coefficient, {"long_name": "coefficient of the normal form"}),
                "supercritical": ("point", np.where(decided, supercritical, -1).astype(np.int8)),
                "multiplier_angle": ("point", angle, {"units": "rad", "long_name": "angle of the critical eigenvalue"}),
            },
            coords={
                name: ("point", [p.values[k] for p in self.path], attributes_of(name))
                for k, name in enumerate(self.parameters)
            },
            attrs={
                "kind": "bifurcation curve",
                "bifurcation": self.kind.value,
                "parameters": json.dumps(self.parameters),
                "ends": json.dumps([end.value for end in self.ends]),
                "provenance": json.dumps(provenance_of_run(system.model, system.motion)),
            },
        )

    def save(self, path: str | Path) -> Path:
        """Write the curve to a netCDF file at `path`; `stylobate.load` reads it."""
        return write(self._data(), path)

    def _data(self) -> xr.Dataset:
        """Return the states of the points, from which shooting recovers the curve."""
        plane, critical = self.plane, np.array([point.multiplier for point in self.path])
        return xr.Dataset(
            {
                "states": (("point", "arc", "state"), np.stack([point.chain.states for point in self.path])),
                "values": (("point", "parameter"), np.array([point.values for point in self.path])),
                "multiplier": (("point", "part"), np.stack([critical.real, critical.imag], axis=-1)),
            },
            attrs={
                **file_attributes(plane.system, CURVE, 1),
                "bifurcation": self.kind.name,
                "parameters": json.dumps(self.parameters),
                "spans": np.array(plane.spans),
                "covered": plane.covered,
                "sense": plane.sense,
                "ends": json.dumps([end.name for end in self.ends]),
            },
        )

    def __repr__(self) -> str:
        """Describe the curve in one line."""
        ranges = " and ".join(f"{name} {values}" for name, values in self._ranges().items())
        return f"BifurcationCurve({self.kind.value}, {len(self.path)} points over {ranges})"

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        rows = [
            Row("kind", self.kind.value),
            *(
                Row(name.replace("_", " "), f"{values} {unit_in_text(quantity_of(name).unit)}")
                for name, values in self._ranges().items()
            ),
            Row("points", str(len(self.path))),
            Row("ends", "; ".join(end.value for end in self.ends)),
        ]
        return card("Bifurcation curve", [CardSection("", rows), *system_sections(self.plane.system)])

    def _ranges(self) -> dict[str, str]:
        return {name: range_of(point.values[k] for point in self.path) for k, name in enumerate(self.parameters)}


@shows_progress("curve", at_value)
def bifurcation_curve(
    bifurcation: Bifurcation,
    parameter: str,
    *,
    bounds: tuple[tuple[float, float], tuple[float, float]],
    control: StepControl | None = None,
    progress: Progress = None,
) -> BifurcationCurve:
    """Continue a fold, a pitchfork, a period doubling or a Neimark–Sacker point in a second parameter.

    Parameters
    ----------
    bifurcation
        Bifurcation from which to begin, on a branch over the first parameter.
    parameter
        Name of the second parameter.
    bounds
        Minimum and maximum of the first and of the second parameter.
    control
        Length of steps, in units of c for states and of the widths of the bounds for parameters, and maximum number of
        points in each direction.
    progress
        A function that is called with both parameters of each new point; a bar by default, False for none.

    Raises
    ------
    ParameterError
        If the bifurcation is a branch point, the second parameter is the first, or it lies outside the bounds.
    NoOrbitError
        If no first point of the curve was found.
    Interrupted
        On Ctrl-C; `partial` is the curve so far.

    Notes
    -----
    Pseudo-arclength continuation of the orbit's equations together with the condition of the bifurcation. The
    derivative of the condition is a finite difference; the condition itself is met to rounding.
    """
    require_bifurcation(bifurcation)
    require_followed(parameter)
    control = control_of(control)
    first = bifurcation.point.family.name
    if bifurcation.kind not in _CONDITIONS:
        raise ParameterError(
            f"bifurcation must not be a branch point, which a second parameter breaks up; got {bifurcation!r}"
        )
    if parameter == first:
        raise ParameterError(f"parameter must differ from {first}, over which the bifurcation was found")
    system = bifurcation.orbit.system
    at = (bifurcation.parameter, present_value(system.model, system.motion, parameter))
    pairs = _pairs(bounds)
    first_bounds, second_bounds = (
        enclosing(system, pair, name, value) for pair, name, value in zip(pairs, (first, parameter), at, strict=True)
    )
    bounds = (first_bounds, second_bounds)
    family = bifurcation.point.family
    plane = Plane(
        system,
        (first, parameter),
        family.covered,
        family.sense,
        bifurcation.kind,
        tuple(high - low for low, high in bounds),
    )
    guess = np.concatenate([bifurcation.point.chain.states.ravel(), at])
    start = plane.corrected(guess / plane.units(guess.size - 2), None)
    if isinstance(start, BranchEnd):
        raise NoOrbitError(f"the curve could not start: {start.value}")
    seen = report_of(progress)
    path, last = _followed(plane, start, 1.0, bounds, control, seen)
    begin: BranchEnd = last if last is BranchEnd.CLOSED else BranchEnd.BEGUN
    if last not in (BranchEnd.CLOSED, BranchEnd.INTERRUPTED):
        backward, begin = _followed(plane, start, -1.0, bounds, control, seen)
        path = [*reversed(backward[1:]), *path]
    curve = BifurcationCurve(bifurcation.kind, plane.names, tuple(path), (begin, last), plane)
    if BranchEnd.INTERRUPTED in curve.ends:
        message = f"stopped after {plural(len(path), 'point')}; `partial` is the curve so far"
        raise Interrupted(message, curve)
    return curve


def _pairs(bounds: tuple[tuple[float, float], tuple[float, float]]) -> tuple[Sequence[float], Sequence[float]]:
    try:
        first, second = bounds
    except (TypeError, ValueError):
        raise ParameterError(
            f"bounds must be two pairs of numbers, of the first and of the second parameter; got {bounds!r}"
        ) from None
    return first, second


@dataclass(frozen=True)
class _Step:
    """A corrected point with the values for the next step."""

    point: CurvePoint
    u: Floats
    tangent: Floats
    steps: int


@dataclass(frozen=True, eq=False)
class Plane(ByContent):
    """The plane of two parameters, over which orbits of a system are continued."""

    system: PeriodicSystem
    names: tuple[str, str]
    covered: float
    sense: float
    kind: BifurcationKind
    spans: tuple[float, ...]

    def units(self, count: int) -> Floats:
        """Return the units of states and parameters."""
        return np.concatenate([np.full(count, self.system.scale * np.sqrt(count)), self.spans])

    def at(self, values: Floats) -> PeriodicSystem:
        """Return the system with these values of both parameters."""
        return self.system.changed(**dict(zip(self.names, map(float, values), strict=True)))

    def coefficient(self, point: CurvePoint) -> float:
        """Return the coefficient of the normal form, NaN at a fold."""
        period_map = PeriodMap(self.at(np.array(point.values)), point.chain.states[0], self.covered, self.sense)
        if self.kind is BifurcationKind.FOLD:
            return float("nan")
        if self.kind is BifurcationKind.NEIMARK_SACKER:
            return neimark_sacker_coefficient(period_map, point.multiplier)
        return period_doubling_coefficient(period_map)

    def corrected(self, u: Floats, normal: Floats | None) -> _Step | BranchEnd:
        """Return the point of the curve in the plane through `u` across `normal`, or without it the nearest to `u`."""
        here = u
        for steps in range(1, _MOST_STEPS + 1):
            try:
                looked = self._looked(here)
            except StylobateError:
                return BranchEnd.SHORT
            if isinstance(looked, FlowStatus):
                return {FlowStatus.LOST: BranchEnd.LOST, FlowStatus.GONE: BranchEnd.GONE}.get(looked, BranchEnd.SHORT)
            residual, jacobian, chain = looked
            if normal is None:
                step = np.linalg.lstsq(jacobian, -residual, rcond=None)[0]
            else:
                matrix = np.vstack([jacobian, normal])
                try:
                    step = np.linalg.solve(matrix, -np.append(residual, normal @ (here - u)))
                except np.linalg.LinAlgError:
                    return BranchEnd.SHORT
            if not np.all(np.isfinite(step)) or np.abs(step).max() > 1.0:
                return BranchEnd.SHORT
            if np.abs(step).max() < _CLOSE:
                values = (float(here[-2] * self.spans[0]), float(here[-1] * self.spans[1]))
                multiplier = self._critical(chain.map_derivative)
                tangent = np.asarray(np.linalg.svd(jacobian)[2][-1])
                return _Step(CurvePoint(values, chain, multiplier), here, tangent, steps)
            here = here + step
        return BranchEnd.SHORT

    def _shots(self, here: Floats, name: str | None) -> Shots:
        units = self.units(here.size - 2)
        system = self.at(here[-2:] * units[-2:])
        states = (here[:-2] * units[:-2]).reshape(-1, system.order)
        change = None if name is None else self._derivative(name, here[-2:] * units[-2:])
        return shots(system, states, self.covered, sense=self.sense, change=change)

    def _derivative(self, name: str, values: Floats) -> FlowNumbers:
        """Return the derivative of the numbers by one parameter at a fixed value of the other."""
        place = self.names.index(name)
        other = self.names[1 - place]
        return self.system.changed(**{other: float(values[1 - place])}).derivative(name, float(values[place]))

    def _looked(self, here: Floats) -> tuple[Floats, Floats, Shots] | FlowStatus:
        units = self.units(here.size - 2)
        first, second = (self._shots(here, name) for name in self.names)
        if first.status is not FlowStatus.DONE:
            return first.status
        scale = self._scale(first.map_derivative)
        value = _CONDITIONS[self.kind](first.map_derivative) / scale
        gradient = np.empty(here.size)
        for k in range(here.size):
            step = np.zeros(here.size)
            step[k] = _STEP
            sides = [self._shots(here + side * step, None) for side in (1.0, -1.0)]
            up, down = (_CONDITIONS[self.kind](side.map_derivative) / scale for side in sides)
            gradient[k] = (up - down) / (2.0 * _STEP)
        jacobian = np.column_stack([first.matrix, first.by_parameter, second.by_parameter]) * units
        # All rows in units of c.
        jacobian = np.vstack([jacobian / self.system.scale, gradient])
        return np.append(first.residual.ravel() / self.system.scale, value), jacobian, first

    def _scale(self, matrix: Floats) -> float:
        return float(max(1.0, np.abs(np.linalg.eigvals(matrix)).max()))

    def _critical(self, matrix: Floats) -> complex:
        values = np.linalg.eigvals(matrix)
        if self.kind is BifurcationKind.NEIMARK_SACKER:
            upper = values[values.imag > 0.0]
            return complex(upper[np.argmin(np.abs(np.abs(upper) - 1.0))]) if upper.size else complex("nan")
        wanted = 1.0 if self.kind is BifurcationKind.FOLD else -1.0
        return complex(values[np.argmin(np.abs(values - wanted))])


def _followed(
    plane: Plane,
    start: _Step,
    sign: float,
    bounds: tuple[tuple[float, float], tuple[float, float]],
    control: StepControl,
    seen: Report,
) -> tuple[list[CurvePoint], BranchEnd]:
    """Return the points of the curve from `start` in one sense, and the reason of its end, which may be Ctrl-C."""
    points = [start.point]
    try:
        return points, _follow(plane, start, sign, bounds, control, seen, points)
    except KeyboardInterrupt:
        return points, BranchEnd.INTERRUPTED


def _follow(
    plane: Plane,
    start: _Step,
    sign: float,
    bounds: tuple[tuple[float, float], tuple[float, float]],
    control: StepControl,
    seen: Report,
    points: list[CurvePoint],
) -> BranchEnd:
    """Append the points of the curve to `points`, and return the reason of its end."""
    here, length = start, min(control.first, control.largest)
    sense = sign * start.tangent
    while len(points) <= control.most:
        _log.info("%d points of a curve of bifurcations, at %.4g, %.4g", len(points), *points[-1].values)
        guess = here.u + length * sense
        found = plane.corrected(guess, sense)
        # A point farther away may lie on another curve.
        if not isinstance(found, BranchEnd) and np.linalg.norm(found.u - guess) > ASTRAY * length:
            found = BranchEnd.SHORT
        bent = not isinstance(found, BranchEnd) and abs(found.tangent @ sense) < _STRAIGHT
        if isinstance(found, BranchEnd) or bent:
            length *= _SHORTER
            if length < control.least:
                return found if isinstance(found, BranchEnd) else BranchEnd.SHORT
            continue
        outside = [not low <= value <= high for value, (low, high) in zip(found.point.values, bounds, strict=True)]
        if any(outside):
            last = _at_bound(plane, here, found, bounds, outside.index(True))
            points += [] if last is None else [last]
            return BranchEnd.BOUND
        if plane.kind is BifurcationKind.NEIMARK_SACKER and not _on_circle(found.point.multiplier):
            return BranchEnd.RESONANCE
        points.append(found.point)
        seen(*found.point.values)
        sense = found.tangent if found.tangent @ sense > 0.0 else -found.tangent
        if len(points) > 10 and np.linalg.norm(found.u - start.u) < 0.75 * length:  # noqa: PLR2004
            return BranchEnd.CLOSED
        here = found
        length = min(_LONGER * length, control.largest) if found.steps <= _EASY else length
        length = _SHORTER * length if found.steps >= _HARD else length
    return BranchEnd.STEPS


def _at_bound(
    plane: Plane, here: _Step, beyond: _Step, bounds: tuple[tuple[float, float], tuple[float, float]], which: int
) -> CurvePoint | None:
    """Return the point of the curve on the bound of one parameter, between two points of the curve."""
    low, high = bounds[which]
    bound = low if beyond.point.values[which] < low else high
    entry = which - 2  # the parameters are the last two
    share = (bound / plane.spans[which] - here.u[entry]) / (beyond.u[entry] - here.u[entry])
    normal = np.zeros_like(here.u)
    normal[entry] = 1.0
    found = plane.corrected(here.u + share * (beyond.u - here.u), normal)
    return None if isinstance(found, BranchEnd) else found.point


def _only_critical(point: CurvePoint) -> bool:
    """Return whether no multiplier lies outside the unit circle."""
    return bool(np.abs(np.linalg.eigvals(point.chain.map_derivative)).max() < 1.0 + 1e-6)


def _on_circle(multiplier: complex) -> bool:
    return abs(abs(multiplier) - 1.0) < 1e-6 and abs(multiplier.imag) > _REAL  # noqa: PLR2004
