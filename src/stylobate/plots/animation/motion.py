"""The motion of a column for animations: poses at equal time steps, and the path of the contact point."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.errors import Outcome, ParameterError, require_positive
from stylobate.plots.geometry import Floats, Shape, base_centres, quaternions
from stylobate.results import Run
from stylobate.results.plain import plain_numbers

# Maximum number of instants of a run: a page contains them all.
_MOST = 2000
# Tolerance for rounding in the number of instants.
_SLACK = 1e-9
# Variables that are interpolated linearly between samples.
_SMOOTH = ("tilt", "tilt_rate", "twist", "spin", "footprint", "clearance", "base_displacement")
# Significant digits of a motion in JSON.
_DIGITS = 7


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnMotion:
    """Poses of a column and displacements of its base at n equal time steps; positions are in the frame of the base.

    Attributes
    ----------
    shape
        The shape of the column.
    incline, incline_direction
        Angle of the plane and azimuth of the way down [rad].
    time
        Shape (n,) [s]: from the start of the run to its end.
    tilt, tilt_rate
        Shape (n, 2) [rad], [rad/s].
    twist, spin
        Angle of rotation about the axis and angular velocity about it, shape (n,) [rad], [rad/s]; the spin is None for
        models without it.
    footprint, contact_point
        Centre of the footprint circle on the base, and contact point, shape (n, 2) [m]. While the column stands
        upright, the contact point is the previous one or, before the first tilt, the next one.
    resting
        Whether the whole base is in contact, shape (n,).
    clearance
        Height of the lowest point above the base, shape (n,) [m], for models with flight.
    base
        Displacement of the base, shape (n, 3) [m].
    friction_demand
        Friction force over normal force, shape (n,), for models that provide it.
    friction_coefficient
        Friction coefficient of the contact, if known.
    outcome, decided_at, title
        The outcome, the time at which it was decided [s], and a line that states both.
    """

    shape: Shape
    incline: float
    incline_direction: float
    time: Floats
    tilt: Floats
    tilt_rate: Floats
    twist: Floats
    spin: Floats | None
    footprint: Floats
    contact_point: Floats
    resting: npt.NDArray[np.bool_]
    clearance: Floats | None
    base: Floats
    friction_demand: Floats | None
    friction_coefficient: float | None
    outcome: Outcome
    decided_at: float
    title: str

    @classmethod
    def of(
        cls,
        run: Run,
        *,
        frames_per_second: float | None = None,
        title: str | None = None,
        most: int = _MOST,
    ) -> Self:
        """Return the motion of `run` in at most `most` instants; arguments and errors as for `drawn_motion`."""
        _require_run(run)
        data = _at_equal_steps(run, frames_per_second, most)
        shape, plane = Shape.of(run), run.provenance["model"]
        tilt = data["tilt"].to_numpy()
        footprint = data["footprint"].to_numpy() if "footprint" in data else np.zeros_like(tilt)
        clearance = _optional(data, "clearance")
        given = run.provenance.get("friction_coefficient")
        coefficient = plane.get("friction_coefficient") if given is None else given
        touches = True if clearance is None else clearance <= 0.0
        return cls(
            shape=shape,
            incline=float(plane.get("incline", 0.0)),
            incline_direction=float(plane.get("incline_direction", 0.0)),
            time=data["time"].to_numpy(),
            tilt=tilt,
            tilt_rate=data["tilt_rate"].to_numpy(),
            twist=data["twist"].to_numpy() if "twist" in data else np.zeros(len(tilt)),
            spin=_optional(data, "spin"),
            footprint=footprint,
            contact_point=footprint + shape.radius * _directions(tilt),
            resting=data["resting"].to_numpy() | (~tilt.any(axis=1) & touches),
            clearance=clearance,
            base=data["base_displacement"].to_numpy(),
            friction_demand=_optional(data, "friction_demand"),
            friction_coefficient=None if coefficient is None else float(coefficient),
            outcome=run.outcome,
            decided_at=run.decided_at,
            title=f"{run.outcome.label}: {_without_advice(run.reason)}" if title is None else title,
        )

    @property
    def rotation(self) -> Floats:
        """The column's rotation as unit quaternions w, x, y, z, shape (n, 4), without jumps of the sign."""
        return quaternions(self.tilt, self.twist)

    @property
    def centre(self) -> Floats:
        """Centre of the bottom circle, shape (n, 3) [m]."""
        clearance = 0.0 if self.clearance is None else self.clearance
        return base_centres(self.tilt, self.footprint, self.shape.radius, clearance)

    @property
    def on_rim(self) -> npt.NDArray[np.bool_]:
        """Whether only a point of the rim touches the base, shape (n,)."""
        flying = np.zeros(self.time.size, dtype=bool) if self.clearance is None else self.clearance > 0.0
        return ~self.resting & ~flying

    def as_dict(self) -> dict[str, Any]:
        """Return the motion as plain numbers, lists and text for JSON."""
        return {
            "column": {name: one for name, one in asdict(self.shape).items() if name != "corners"},
            "plane": {"incline": self.incline, "incline_direction": self.incline_direction},
            "time": _plain(self.time),
            "tilt": _plain(self.tilt),
            "tilt_rate": _plain(self.tilt_rate),
            "twist": _plain(self.twist),
            "spin": _plain(self.spin),
            "footprint": _plain(self.footprint),
            "contact_point": _plain(self.contact_point),
            "resting": self.resting.astype(int).tolist(),
            "clearance": _plain(self.clearance),
            "base": _plain(self.base),
            "rotation": _plain(self.rotation),
            "centre": _plain(self.centre),
            "friction_demand": _plain(self.friction_demand),
            "friction_coefficient": self.friction_coefficient,
            "outcome": self.outcome.name,
            "decided_at": self.decided_at,
            "title": self.title,
        }


def drawn_motion(run: Run, *, frames_per_second: float | None = None, title: str | None = None) -> dict[str, Any]:
    """Convert a run to poses as plain numbers, for a web page or another program to draw.

    Lengths are in m, angles in rad, times in s; z points up. Positions are in the frame of the base, whose displacement
    is `base`. The unit quaternion `rotation` (w, x, y, z) turns the column, Rz(β) Ry(θ) Rz(γ − β), and `centre` is the
    centre of its bottom circle. All poses are computed states: the motion of a column that overturned ends when
    overturning was certain.

    Parameters
    ----------
    run
        A run. The samples of a loaded run are interpolated linearly.
    frames_per_second
        Poses per second of the run; by default one per sample. There are at most 2000.
    title
        A line of text; by default the outcome.

    Returns
    -------
    dict
        Lists of equal length by name: "time", "tilt", "tilt_rate", "twist", "spin", "footprint", "contact_point",
        "resting", "clearance", "base", "rotation", "centre", "friction_demand", with seven digits. A quantity that the
        model does not provide, or a demand that is not finite, is None. Also "column", "plane",
        "friction_coefficient", "outcome", "decided_at" and "title".

    Raises
    ------
    ParameterError
        If `run` is not a run, or `frames_per_second` is not positive.
    """
    return DrawnMotion.of(run, frames_per_second=frames_per_second, title=title).as_dict()


def _without_advice(reason: str) -> str:
    """Return the reason of an outcome without the advice that follows it."""
    return reason.partition(";")[0]


def _require_run(run: Run) -> None:
    if not isinstance(run, Run):
        raise ParameterError(f"run must be a run, as simulate returns it, got {type(run).__name__}")
    if run.data.sizes["time"] < 2:  # noqa: PLR2004  no motion in less
        raise ParameterError(f"run must have 2 samples at least, got {run.data.sizes['time']}")


def _at_equal_steps(run: Run, frames_per_second: float | None, most: int) -> xr.Dataset:
    own, end = run.data["time"].to_numpy(), float(run.data["time"][-1])
    count = own.size
    if frames_per_second is not None:
        count = math.ceil(end * require_positive("frames_per_second", frames_per_second, "1/s") - _SLACK) + 1
    time = np.linspace(0.0, end, min(max(count, 2), most))
    if time.size == own.size and np.allclose(time, own, rtol=0.0, atol=_SLACK * end / own.size):
        return run.data
    return run.sample(time) if run.sampler is not None else _between(run.data, time)


def _between(data: xr.Dataset, time: Floats) -> xr.Dataset:
    """Interpolate samples linearly; values that are not numbers keep the value of the sample before."""
    own = data["time"].to_numpy()
    before = np.clip(np.searchsorted(own, time, side="right") - 1, 0, own.size - 1)
    smooth = [name for name in _SMOOTH if name in data]
    joined = {name: _joined(data[name], own, time) for name in smooth}
    return data.isel(time=before).assign_coords(time=time).assign(joined)


def _joined(values: xr.DataArray, own: Floats, time: Floats) -> xr.Variable:
    flat = values.to_numpy().reshape(own.size, -1)
    joined = np.stack([np.interp(time, own, part) for part in flat.T], axis=-1)
    return xr.Variable(values.dims, joined.reshape(time.size, *values.shape[1:]))


def _optional(data: Mapping[Any, xr.DataArray], name: str) -> Floats | None:
    return data[name].to_numpy() if name in data else None


def _directions(tilt: Floats) -> Floats:
    """Return unit vectors along the tilt; without tilt, the vector of the nearest instant before, or else after."""
    size = np.hypot(*tilt.T)
    leaning = np.flatnonzero(size > 0.0)
    if not leaning.size:
        return np.tile([1.0, 0.0], (len(tilt), 1))
    last = np.searchsorted(leaning, np.arange(len(tilt)), side="right") - 1
    known = leaning[np.clip(last, 0, None)]
    return np.asarray(tilt[known] / size[known, None])


def _plain(values: Floats | None) -> list[Any] | None:
    return None if values is None else plain_numbers(values, _DIGITS)


# Maximum distance between instants that a contact that can change moves without a jump [base radii].
_LEAP = 0.5
# Between instants the contact point moves along the footprint circle, drawn in chords no wider than this [rad].
_CHORD = 0.1


def contact_path(motion: DrawnMotion) -> tuple[Floats, Floats]:
    """Return times, shape (n,) [s], and points in the plane of the base, shape (n, 2) [m], of the contact point.

    Rows of NaN separate the pieces: no point of the rim touches there, or the contact jumps to another point.
    """
    pieces = [_on_arcs(motion, piece) for piece in _touching(motion)]
    if not pieces:
        return np.zeros(0), np.zeros((0, 2))
    gap = np.full((1, 2), np.nan)
    times = [np.append(times, times[-1]) for times, _ in pieces]
    points = [np.concatenate([points, gap]) for _, points in pieces]
    return np.concatenate(times), np.concatenate(points)


def _touching(motion: DrawnMotion) -> list[npt.NDArray[np.intp]]:
    """Return the indices of instants in which the rim touches, in pieces without jumps of the contact."""
    absent = ~motion.on_rim
    moved = np.hypot(*np.diff(motion.contact_point, axis=0).T)
    # Near the vertical, a contact that cannot change moves fast round the rim; one that can change jumps at impacts.
    leaps = (moved > _LEAP * motion.shape.radius) & (motion.clearance is not None)
    breaks = np.flatnonzero(leaps | (absent[1:] != absent[:-1])) + 1
    pieces = np.split(np.arange(motion.time.size), breaks)
    return [piece for piece in pieces if piece.size > 1 and not absent[piece[0]]]


def _on_arcs(motion: DrawnMotion, piece: npt.NDArray[np.intp]) -> tuple[Floats, Floats]:
    """Return times and points of a path, with more points between instants that lie far apart on the circle."""
    rim = motion.contact_point[piece] - motion.footprint[piece]
    azimuth = np.unwrap(np.arctan2(rim[:, 1], rim[:, 0]))
    parts = np.ceil(np.abs(np.diff(azimuth)) / _CHORD).astype(int).clip(1)
    fine = np.append(np.concatenate([at + np.arange(n) / n for at, n in enumerate(parts)]), piece.size - 1)
    own = np.arange(piece.size)
    angle, time, x, y = (
        np.interp(fine, own, values) for values in (azimuth, motion.time[piece], *motion.footprint[piece].T)
    )
    path = np.stack([x + motion.shape.radius * np.cos(angle), y + motion.shape.radius * np.sin(angle)], axis=-1)
    return time, path
