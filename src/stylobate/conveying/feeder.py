"""The sheet of a feeder: the numbers of one part on one vibration, in one table."""

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.base_motions.harmonic import as_harmonic
from stylobate.conveying.posture import PERIODS, PHASES, TILTS, Posture, upright
from stylobate.conveying.transport import PERIODIC, TOLERANCE, Transport, drift, named, throw_number_of
from stylobate.errors import UnsupportedError, require_positive
from stylobate.models import Model, Sliding
from stylobate.progress import Progress, shows_progress
from stylobate.quantities import cf_attributes, parameters_of
from stylobate.run_arguments import RunOptions
from stylobate.studies.proportions import require_confidence
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.designs import checked_values
from stylobate.text import plural
from stylobate.theory import BlockPhase, block_cycle, mean_block_speed

Floats = npt.NDArray[np.float64]

KIND = "feeder sheet"
"""Value of the attribute `kind` of the result."""

# Share of the runs that stand, whose speeds a range covers.
_COVERED = (0.05, 0.95)
# Bisections of the angle of a track, and periods of each computed motion.
_HALVINGS, _CYCLES = 11, 100
# Periods within which hops must repeat.
_MOST_HOPS = 3000
_STRAIGHT, _SAMPLES = 1e-9, 721
_TURN = 2.0 * math.pi


@shows_progress("feeder")
def sheet(
    model: Model,
    motion: BaseMotion,
    *,
    friction: float | Sequence[float] | None = None,
    tilts: npt.ArrayLike = TILTS,
    phases: int = PHASES,
    azimuth: float | None = None,
    periods: float = PERIODS,
    tolerance: float = TOLERANCE,
    confidence: float = 0.9,
    executor: Executor | None = None,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Compute the sheet of a feeder: how a part hops, how fast it is conveyed, how steeply, and whether it falls.

    Parameters
    ----------
    model
        The part on the track, a `Sliding` model.
    motion
        A harmonic base motion, such as `Harmonic.stroke`. Its angle is measured from the track.
    friction
        Friction coefficient, or several; that of the model by default.
    tilts, phases, azimuth, periods
        Initial tilts and phases of the part, and duration of each run, as for `upright`.
    tolerance
        Relative half-width of the interval of the speed, as for `drift`.
    confidence
        Confidence level of the intervals.
    executor, progress
        As for `overturning_map`.
    **options
        Options of all runs, as in `simulate_ensemble`.

    Returns
    -------
    xarray.Dataset
        Of kind "feeder sheet".

        * `machine_number` K, the peak acceleration along the path over gravity; `throw_number` Γ; `hop_number`, the
          longest flight of an upright part over the period, `flight_time` [s] and `hop_periods`, the number of periods
          after which its hops repeat, 0 if they do not within 3000; `critical_friction`, the slenderness r/h;
          `vibration_angle`, the angle of the path to the track, or atan of the ratio of the amplitudes [rad].
        * Over `friction`: `speed`, `speed_low` and `speed_high` of a part that starts flat [m/s], `transport` (a
          `Transport`) and `direction`, the azimuth of its velocity [rad]; `tilted_speed_low` and `tilted_speed_high`,
          which cover nine tenths of the speeds of the tilted parts that do not fall [m/s]; `steepest_incline`, the
          steepest track that a part which stays upright climbs in the direction of transport [rad], and
          `steepest_verdict`, the posture on that track in one line; over `posture_name` too `share`, `share_low` and
          `share_high` of the tilted parts that stay upright, rock and fall. `verdict` is the posture in one line.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    UnsupportedError
        If the model is not `Sliding`, or the base motion not harmonic.

    See Also
    --------
    drift, upright, stylobate.theory.block_cycle : the numbers of the sheet, over any parameters.

    Notes
    -----
    Hop number and steepest track are those of a block that stays upright, see `theory.block_cycle`. The track is found
    by bisection up to the friction angle, which no steady motion uphill exceeds; it is NaN if the vibration is not in
    one vertical plane. A part that tilts can fall on it: read `steepest_verdict`.

    Examples
    --------
    >>> import stylobate as sb
    >>> pin = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)
    >>> part = sb.Sliding(pin, friction_coefficient=0.2, damping=0.05, normal_restitution=0.1)
    >>> trough = sb.Harmonic.stroke(stroke=0.0006, frequency=50.0, angle=0.436)
    >>> found = sb.conveying.sheet(part, trough, tilts=[1e-3], phases=16, periods=40)
    >>> print(float(found["machine_number"].round(2)), float(found["throw_number"].round(2)))
    3.02 1.28
    >>> print(f"{1000.0 * float(found['speed'][0]):.1f} mm/s, {float(found['hop_number']):.2f} of a period")
    19.5 mm/s, 0.44 of a period
    """
    harmonic = as_harmonic(motion)
    if not isinstance(model, Sliding):
        got = getattr(model, "name", model)
        raise UnsupportedError(
            f"model: a feeder sheet needs a part that can slide (got {got!s}). Pass Sliding(column)."
        )
    if harmonic is None:
        raise UnsupportedError(f"motion: a feeder sheet needs a harmonic base motion (got {named(motion)}). {PERIODIC}")
    given = model.friction_coefficient if friction is None else friction
    frictions = checked_values("friction", "friction_coefficient", given, scalar=True)
    tolerance, confidence = require_positive("tolerance", tolerance), require_confidence(confidence)
    shared: Any = {"executor": executor, "progress": progress, **options}
    starts: Any = {"tilts": tilts, "phases": phases, "azimuth": azimuth, "periods": periods, "confidence": confidence}
    postures = [upright(model, motion, friction=float(mu), **starts, **shared) for mu in frictions]
    moved = drift(
        model, motion, over={"friction_coefficient": frictions}, tolerance=tolerance, confidence=confidence, **shared
    )
    mean = moved["mean_velocity"].transpose(..., "axis").to_numpy()
    tilted = np.array([_tilted_speeds(posture) for posture in postures])
    steepest, sloping = np.empty(frictions.size), list[str]()
    for place, mu in enumerate(frictions.tolist()):
        steepest[place], down = _steepest_track(replace(model, friction_coefficient=mu), harmonic)
        known = math.isfinite(steepest[place])
        track = replace(model, incline=float(steepest[place]), incline_direction=down) if known else model
        posture = upright(track, motion, friction=mu, **starts, **shared) if known else None
        sloping.append("" if posture is None else str(posture.attrs["verdict"]))
    hop, repeats = _hops(model, harmonic)
    peak = float(np.linalg.norm(motion.acceleration(np.linspace(0.0, harmonic.period, _SAMPLES)), axis=1).max())
    scalars = {
        "machine_number": (peak / model.column.gravity, "1", "machine number K"),
        "throw_number": (throw_number_of(model, motion), "1", "throw number Γ"),
        "hop_number": (hop, "1", "longest flight of an upright part over the period"),
        "flight_time": (hop * harmonic.period, "s", "longest flight of an upright part"),
        "hop_periods": (repeats, "1", "periods after which the hops repeat, 0 for none found"),
        "critical_friction": (model.column.slenderness, "1", "critical friction coefficient r/h"),
        "vibration_angle": (_angle_of(harmonic), "rad", "angle of the vibration to the track"),
    }
    by_friction = {
        "speed": (moved["transport_speed"].to_numpy(), "m s-1", "mean transport speed from a flat start"),
        "speed_low": (moved["speed_low"].to_numpy(), "m s-1", "lower end of its interval"),
        "speed_high": (moved["speed_high"].to_numpy(), "m s-1", "upper end of its interval"),
        "direction": (np.arctan2(mean[:, 1], mean[:, 0]), "rad", "azimuth of the mean velocity"),
        "tilted_speed_low": (tilted[:, 0], "m s-1", "speed that 95 % of the tilted parts that stand exceed"),
        "tilted_speed_high": (tilted[:, 1], "m s-1", "speed that 5 % of the tilted parts that stand exceed"),
        "steepest_incline": (steepest, "rad", "steepest track that a part which stays upright climbs"),
    }
    described = {**json.loads(postures[0].attrs["provenance"]), "friction": frictions.tolist(), "tolerance": tolerance}
    return xr.Dataset(
        {
            **{name: ((), value, cf_attributes(units, text)) for name, (value, units, text) in scalars.items()},
            **{
                name: ("friction", values, cf_attributes(units, text))
                for name, (values, units, text) in by_friction.items()
            },
            "transport": ("friction", moved["transport"].to_numpy(), moved["transport"].attrs),
            **{
                name: (
                    ("friction", "posture_name"),
                    [one[name].to_numpy() for one in postures],
                    postures[0][name].attrs,
                )
                for name in ("share", "share_low", "share_high")
            },
            "verdict": ("friction", [one.attrs["verdict"] for one in postures]),
            "steepest_verdict": ("friction", sloping),
        },
        coords={
            "friction": ("friction", frictions, cf_attributes("1", "friction coefficient")),
            "posture_name": postures[0]["posture_name"].to_numpy(),
        },
        attrs={"kind": KIND, "confidence": confidence, "provenance": json.dumps(described)},
    )


def sheet_rows(found: xr.Dataset) -> list[tuple[str, list[str]]]:
    """Return the rows of a sheet, in mm/s, ms and degrees: a label, and the value of each friction coefficient."""
    one = {name: float(found[name]) for name in ("machine_number", "throw_number", "hop_number", "flight_time")}
    every, repeats = found.sizes["friction"], int(found["hop_periods"])
    again = f"repeats after {plural(repeats, 'period')}" if repeats else f"no repetition found in {_MOST_HOPS} periods"
    hop = f"{one['hop_number']:.3g} of a period, {1000.0 * one['flight_time']:.3g} ms; {again}"
    cases = [found.isel(friction=place) for place in range(every)]
    return [
        ("vibration angle", [_angle(float(found["vibration_angle"]))] * every),
        ("machine number K", [f"{one['machine_number']:.3g}"] * every),
        ("throw number Γ", [f"{one['throw_number']:.3g}"] * every),
        ("longest hop", [hop if one["hop_number"] > 0.0 else "none"] * every),
        ("critical friction r/h", [f"{float(found['critical_friction']):.3g}"] * every),
        ("friction", [_friction(float(case["friction"])) for case in cases]),
        ("speed from a flat start", [_speed(case) for case in cases]),
        ("speed from tilted starts", [_range(case) for case in cases]),
        ("posture", [str(case["verdict"].item()) for case in cases]),
        ("steepest track of a part that stays upright", [_angle(float(case["steepest_incline"])) for case in cases]),
        ("posture on that track", [str(case["steepest_verdict"].item()) or "not known" for case in cases]),
    ]


def _speed(case: xr.Dataset) -> str:
    known = Transport(int(case["transport"]))
    if known in (Transport.ACCELERATES, Transport.ENDED):
        return known.name.lower()
    speed, low, high = (1000.0 * float(case[name]) for name in ("speed", "speed_low", "speed_high"))
    azimuth = math.degrees(float(case["direction"]))
    towards = f" towards {azimuth:.0f}°" if speed > 0.0 else ""
    interval = f" ({low:.1f} to {high:.1f} mm/s)" if f"{low:.1f}" != f"{high:.1f}" else ""
    return f"{speed:.1f} mm/s{towards}{interval}"


def _range(case: xr.Dataset) -> str:
    low, high = (1000.0 * float(case[f"tilted_speed_{end}"]) for end in ("low", "high"))
    none = "none stands" if float(case["share"].sel(posture_name="fallen")) == 1.0 else "not known"
    return none if math.isnan(low) else f"{low:.1f} to {high:.1f} mm/s"


def _angle(angle: float) -> str:
    return (
        "not known" if math.isnan(angle) else f"{math.degrees(angle):.1f}°" + (" (horizontal)" if angle == 0.0 else "")
    )


def _friction(value: float) -> str:
    usual = parameters_of(Sliding)["friction_coefficient"].default
    return f"{value:.3g}" + (" (the default)" if value == usual else "")


def _angle_of(motion: Harmonic) -> float:
    x, y, z = map(abs, motion.amplitude)
    return math.atan2(z, math.hypot(x, y))


def _tilted_speeds(posture: xr.Dataset) -> tuple[float, float]:
    """Return the range of most speeds of the tilted parts that stand at the end [m/s]; NaN without such a part."""
    stands = (posture["posture"] >= 0) & (posture["posture"] != Posture.FALLEN) & (posture["initial_tilt"] > 0.0)
    moved = np.hypot(*posture["end_footprint"].transpose("axis", ...).to_numpy())
    speeds = (moved / posture["end_time"].to_numpy())[stands.to_numpy()]
    return tuple(np.quantile(speeds, _COVERED).tolist()) if speeds.size else (math.nan, math.nan)


def _hops(part: Sliding, motion: Harmonic) -> tuple[float, int]:
    """Return the longest flight over the period and the number of periods of a cycle, of a part that stays upright."""
    gravity, incline, restitution = part.column.gravity, part.incline, part.normal_restitution
    normal = abs(motion.amplitude[2]) / gravity
    whole = _whole_periods(normal / math.cos(incline)) if restitution == 0.0 else 0
    if whole:
        return float(whole), whole
    bodies: Any = {"static_friction": 1e3, "normal_restitution": restitution, "incline": incline}
    cycle = block_cycle(0.0, normal, **bodies, cycles=_MOST_HOPS)
    flights, current = [0.0], 0.0
    segments = cycle.segments
    ends = [one.phase is BlockPhase.FLIGHT for one in (segments[-1], segments[0])]
    for place, one in enumerate(segments):
        if one.phase is BlockPhase.FLIGHT:
            current = one.end - one.start
            # A flight over the end of the cycle is cut there.
            wraps = place == len(segments) - 1 and all(ends) and len(segments) > 1
            flights.append(current + (segments[0].end - segments[0].start if wraps else 0.0))
    return max(flights) / _TURN, cycle.period


def _whole_periods(throw: float) -> int:
    """Return n if each hop with inelastic landings lasts n whole periods, else 0: 1 + (nπ)² ≤ Γ² ≤ 4 + (nπ)².

    Near the upper end the hops approach this motion so slowly that no computed number of them shows it.
    """
    whole = int(math.sqrt(max(throw * throw - 1.0, 0.0)) / math.pi)
    return whole if throw * throw <= 4.0 + (whole * math.pi) ** 2 else 0


def _steepest_track(part: Sliding, motion: Harmonic) -> tuple[float, float]:
    """Return the steepest track that a part which stays upright climbs, and the azimuth of its way down [rad].

    The track is NaN if the path is not in one plane.
    """
    x, y, z = (np.asarray(a * np.exp(1j * phase)) for a, phase in zip(motion.amplitude, motion.phase, strict=True))
    size = math.hypot(abs(x), abs(y))
    if size == 0.0 or abs((x.conjugate() * y).imag) > _STRAIGHT * size**2:
        return math.nan, 0.0
    along = x if abs(x) >= abs(y) else y
    gravity = part.column.gravity
    numbers = part.numbers
    given: Any = {
        "static_friction": numbers.static,
        "kinetic_friction": numbers.kinetic,
        "normal_restitution": part.normal_restitution,
        "phase": float(np.angle(z) - np.angle(along)),
        "cycles": _CYCLES,
    }
    shaken = (size / gravity, abs(z) / gravity)

    def climbs(sense: float, incline: float) -> bool:
        return bool(mean_block_speed(sense * shaken[0], shaken[1], incline=incline, **given) > 0.0)

    level = float(mean_block_speed(*shaken, **given))
    sense = math.copysign(1.0, level)
    down = math.atan2(*(-sense * float((one * along.conjugate()).real) for one in (y, x)))
    low, high = 0.0, math.atan(numbers.kinetic)
    if level == 0.0 or not climbs(sense, low):
        return 0.0, down
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if climbs(sense, middle) else (low, middle)
    return low, down
