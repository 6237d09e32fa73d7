"""Columns of the table of a batch that describe the base motions of the runs."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.base_motions.combined import Delayed, Rotated, Scaled, Sum, members_of
from stylobate.base_motions.declared import is_pulse, numbers_of_motion, stated_numbers
from stylobate.engine.ensembles.beginnings import Bounds
from stylobate.engine.ensembles.model_columns import ModelColumns
from stylobate.engine.ensembles.polynomials import PolynomialTable, one_after_another, tabulated, tabulated_alike
from stylobate.engine.forcing import least_rest_energy
from stylobate.engine.kernel.columns import Tabulated
from stylobate.engine.kernel.shape import Harmonics, KernelForcing, Polynomials
from stylobate.engine.parameters import OFFSETS, changed_motion, declared_names, peak_acceleration
from stylobate.engine.verdict import remaining_acceleration

Floats = npt.NDArray[np.float64]


Complex = tuple[Any, Any]
"""Real and imaginary part."""

_COPIES = (Scaled, Rotated, Delayed)


@dataclass(frozen=True, slots=True)
class Term:
    """Acceleration Re(amplitude e^{i(ω(t − shift) + start_phase)}) after `onset`, with a rise over `ramp` from `shift`.

    All numbers may be arrays over runs.

    Parameters
    ----------
    angular_frequency
        ω [rad/s].
    amplitude
        Real and imaginary parts of the complex amplitudes along x, y, z [m/s²].
    start_phase
        [rad].
    shift, onset, ramp
        [s].
    """

    angular_frequency: Any
    amplitude: tuple[Complex, Complex, Complex]
    start_phase: Any
    shift: Any
    onset: Any
    ramp: Any

    @property
    def phase_at_start(self) -> Any:
        """Phase at t = 0 [rad]."""
        return self.start_phase - self.angular_frequency * self.shift

    def wave(self, time_scale: Any, gravity: Any, *, windowed: bool) -> tuple[Any, ...]:
        """Return the numbers of `Wave` in the units of the models; `windowed` adds its last ones."""
        numbers: tuple[Any, ...] = (self.angular_frequency * time_scale / (2.0 * math.pi),)
        for re, im in self.amplitude:
            numbers = (*numbers, np.hypot(re, im) / gravity, _turns(np.arctan2(im, re) + self.phase_at_start))
        if not windowed:
            return numbers
        # The end of the rise is exactly the break at which the kernel begins the next leg.
        ends = (self.shift + self.ramp) / time_scale
        return *numbers, self.onset / time_scale, self.shift / time_scale, ends

    def azimuths(self) -> tuple[Any, Any]:
        """Return the azimuths of the anticlockwise and clockwise components at t = 0 [rad]."""
        phase = self.phase_at_start
        cos, sin = np.cos(phase), np.sin(phase)
        (x_re, x_im), (y_re, y_im), _ = (_turned(part, cos, sin) for part in self.amplitude)
        forward = np.arctan2(x_im + y_re, x_re - y_im)
        return forward, np.arctan2(y_re - x_im, x_re + y_im)


def terms_of(motion: BaseMotion) -> tuple[Term, ...] | None:
    """Return the harmonic terms of `motion`, or None if it is not a sum of harmonic motions."""
    if type(motion) is Harmonic:
        return (term_of(motion),)
    if type(motion) is Sum:
        parts = [terms_of(part) for part in motion.motions]
        return None if None in parts else tuple(term for part in parts for term in part or ())
    if not isinstance(motion, _COPIES) or type(motion) not in _COPIES:  # a subclass can differ
        return None
    inner = terms_of(motion.motion)
    return None if inner is None else tuple(_transformed(motion, term) for term in inner)


def term_of(motion: Harmonic) -> Term:
    """Return the term of a harmonic motion."""
    (ax, ay, az), (fx, fy, fz) = motion.amplitude, motion.phase
    amplitude = (
        (ax * math.cos(fx), ax * math.sin(fx)),
        (ay * math.cos(fy), ay * math.sin(fy)),
        (az * math.cos(fz), az * math.sin(fz)),
    )
    return Term(motion.angular_frequency, amplitude, motion.start_phase, 0.0, -math.inf, motion.ramp)


def _transformed(motion: Scaled | Rotated | Delayed, term: Term) -> Term:
    if isinstance(motion, Delayed):
        begins = motion.delay if motion.delay > 0.0 else -math.inf
        return replace(term, shift=term.shift + motion.delay, onset=max(begins, term.onset + motion.delay))
    real, imaginary = (motion.changed(*parts) for parts in zip(*term.amplitude, strict=True))
    x, y, z = zip(real, imaginary, strict=True)
    return replace(term, amplitude=(x, y, z))


def _of_runs(
    terms: Sequence[tuple[Term, ...]],
    which: npt.NDArray[np.intp],
    values: Mapping[str, Floats],
    base_acceleration: Floats,
) -> tuple[Term, ...]:
    """Return the terms of runs, whose numbers are arrays, with the parameters of `values` changed.

    Parameters
    ----------
    terms
        Terms of each of some motions, all of the same number.
    which
        Index of the motion of each run, shape (n,).
    values
        Parameters that change, each of shape (n,).
    base_acceleration
        Peak horizontal acceleration of each run before the change [m/s²].
    """
    factor = factors(values, base_acceleration)
    return tuple(_changed(_together(same, which), values, factor) for same in zip(*terms, strict=True))


def _together(terms: Sequence[Term], which: npt.NDArray[np.intp]) -> Term:
    """Return one term, whose numbers are those of the motion of each run."""
    amplitude = np.array([term.amplitude for term in terms], dtype=float)[which]
    x, y, z = (tuple(part) for part in amplitude.transpose(1, 2, 0))
    of_runs = {
        name: np.array([getattr(term, name) for term in terms], dtype=float)[which]
        for name in Term.__slots__
        if name != "amplitude"
    }
    return Term(amplitude=(x, y, z), **of_runs)


def _changed(term: Term, values: Mapping[str, Floats], factor: Floats | None) -> Term:
    """Return a term with the parameters of `values`; amplitudes are multiplied by the `factor`."""
    own = {name: values[name] for name in Term.__slots__ if name in values}
    amplitude = term.amplitude
    if factor is not None:
        x, y, z = ((re * factor, im * factor) for re, im in amplitude)
        amplitude = (x, y, z)
    if "rotation" in values:
        cos, sin = np.cos(values["rotation"]), np.sin(values["rotation"])
        (x_re, x_im), (y_re, y_im), z = amplitude
        amplitude = (
            (cos * x_re - sin * y_re, cos * x_im - sin * y_im),
            (sin * x_re + cos * y_re, sin * x_im + cos * y_im),
            z,
        )
    shift, onset = term.shift, term.onset
    if "delay" in values:
        delay = values["delay"]
        shift = shift + delay
        onset = np.maximum(np.where(delay > 0.0, delay, -np.inf), onset + delay)
    return replace(term, amplitude=amplitude, shift=shift, onset=onset, **own)


def _breaks(terms: Sequence[Term]) -> Floats:
    """Return the increasing times of non-smooth acceleration [s], shape (n, breaks), padded with inf."""
    times = [term.onset for term in terms]
    times += [np.where(term.ramp > 0.0, term.shift + term.ramp, np.inf) for term in terms]
    every = np.stack(times, axis=1)
    every = np.sort(np.where(every > 0.0, every, np.inf), axis=1)
    return every[:, np.any(np.isfinite(every), axis=0)]


def factors(values: Mapping[str, Floats], base_acceleration: Floats) -> Floats | None:
    """Return the factor of the motion of each run from `acceleration` and `scale`, or None for 1."""
    factor = None
    if "acceleration" in values:
        factor = values["acceleration"] / base_acceleration
    if "scale" in values:
        factor = values["scale"] if factor is None else factor * values["scale"]
    return factor


def _turns(angle: Any) -> Any:
    turns = angle / (2.0 * math.pi)
    return turns - np.floor(turns + 0.5)


def _turned(part: Complex, cos: Any, sin: Any) -> Complex:
    """Return a complex number times cos + i sin."""
    re, im = part
    return re * cos - im * sin, re * sin + im * cos


_NO_PIECES = np.zeros((1, 5))


@dataclass(frozen=True, slots=True)
class MotionPlan:
    """Evaluation method of the base motion of an ensemble, the same for all runs.

    Each run has one of the motions `members`. If declared parameters of a tabulated motion vary, there is one member
    for each combination: `names` are these parameters, `levels` the increasing values of each, and `combinations` the
    joint indices of the values of each member. The same holds if numbers of a named constructor vary, such as a
    stroke. `terms` are those of each member, None for tabulated motions. `table` holds these one after another; each
    begins at its index in `first` and has its number of pieces in `lengths`.
    """

    motion: BaseMotion
    members: tuple[BaseMotion, ...]
    names: tuple[str, ...]
    levels: tuple[Floats, ...]
    combinations: npt.NDArray[np.intp]
    terms: tuple[tuple[Term, ...], ...] | None
    table: PolynomialTable | None
    first: npt.NDArray[np.intp]
    lengths: npt.NDArray[np.intp]
    windowed: bool
    vertical: bool
    base_acceleration: Floats

    @classmethod
    def of(cls, motion: BaseMotion, values: Mapping[str, Floats], duration: Floats) -> "MotionPlan":
        """Return the plan for runs that change these `values` of the motion.

        Raises
        ------
        ParameterError
            If a parameter of the motion is out of range, or a chosen motion does not exist.
        UnsupportedError
            If the motion lacks a parameter in `values`, or cannot be tabulated.
        """
        declared = declared_names(motion, values)
        for name, own in declared.items():
            for value in (values[name].min(initial=math.inf), values[name].max(initial=-math.inf)):
                if math.isfinite(value):
                    numbers_of_motion(motion)[own].quantity.checked(name, float(value))
        for number in np.unique(values["motion"]) if "motion" in values else ():
            changed_motion(motion, {"motion": float(number)})
        stated = tuple(name for name, own in declared.items() if own in stated_numbers(motion))
        is_plain = all(name == own for name, own in declared.items() if name not in stated)
        is_plain &= not any(name in values for name in OFFSETS)
        harmonic = is_plain and terms_of(motion) is not None
        names = () if not len(duration) else stated if harmonic else tuple(declared)
        if names and "motion" in values:
            names = ("motion", *names)
        levels, combinations = _combined([values[name] for name in names])
        members = members_of(motion) if "motion" in values else (motion,)
        if names:
            places = np.unravel_index(combinations, tuple(map(len, levels)))
            chosen = np.stack([level[place] for level, place in zip(levels, places, strict=True)], axis=1)
            changes = (dict(zip(names, numbers, strict=True)) for numbers in chosen.tolist())
            members = tuple(changed_motion(motion, change) for change in changes)
        scaled = "acceleration" in values
        base = np.array([peak_acceleration(member) if scaled else 1.0 for member in members])
        terms = tuple(terms_of(member) or () for member in members) if harmonic else None
        vertical = any(bound != 0.0 for member in members for bound in member.vertical_range(0.0))
        nowhere = np.zeros(1, dtype=np.intp)
        varied = (names, levels, combinations)
        if terms is not None:
            each_term = [term for one in terms for term in one]
            windowed = "delay" in values or any(term.ramp > 0.0 or term.onset > 0.0 for term in each_term)
            vertical = any(term.amplitude[2] != (0.0, 0.0) for term in each_term)
            return cls(motion, members, *varied, terms, None, nowhere, nowhere, windowed, vertical, base)
        least_delay = values["delay"].min(initial=0.0) if "delay" in values else 0.0
        end = float(duration.max(initial=1e-300)) - float(least_delay)
        alike = names == ("angular_frequency",) and is_pulse(motion)
        tables = tabulated_alike(members, end) if alike else [tabulated(member, end) for member in members]
        lengths = np.array([len(table.rows) for table in tables])
        table = one_after_another(tables)
        first = np.cumsum(lengths) - lengths
        return cls(motion, members, *varied, None, table, first, lengths, False, vertical, base)

    def member(self, values: Mapping[str, Floats], count: int) -> npt.NDArray[np.intp]:
        """Return the index in `members` of the motion of each of `count` runs."""
        if self.names:
            places = [np.searchsorted(level, values[name]) for name, level in zip(self.names, self.levels, strict=True)]
            return np.searchsorted(self.combinations, _combination(self.levels, places))
        return values["motion"].astype(np.intp) if "motion" in values else np.zeros(count, dtype=np.intp)

    def source(self, *, planar: bool) -> KernelForcing:
        """Return the kind of base motion for the kernels."""
        components = (*(("ah",) if planar else ("ax", "ay")), *(("az",) if self.vertical else ()))
        if self.terms is not None:
            return Harmonics(len(self.terms[0]), self.windowed, components)
        assert self.table is not None
        return Polynomials(self.table.degree, components)

    @property
    def pieces(self) -> Floats:
        """Table of pieces for the kernels; without content for harmonic motion."""
        return _NO_PIECES if self.table is None else self.table.rows


@dataclass(frozen=True, slots=True)
class MotionColumns:
    """Arrays over the runs in model units, of shape (n,) except `directions` (n, vectors, 2), `breaks`, `columns`.

    `duration` is the time after which the base motion has ended [s], and `remaining` the bound of the horizontal
    acceleration afterwards [g], that of a base out of level. `phase` is the phase of the forcing at t = 0 [turns].
    `forward` and `backward` are the azimuths [rad] at t = 0 of its anticlockwise and clockwise components, NaN for more
    than one frequency.
    """

    columns: Floats
    breaks: Floats
    frequency: Floats
    mean_frequency: Floats
    least_rest_energy: Floats
    duration: Floats
    period: Floats
    phase: Floats
    largest: Floats
    remaining: Floats
    minimum_vertical: Floats
    maximum_vertical: Floats
    directions: Floats
    forward: Floats
    backward: Floats

    @classmethod
    def of(cls, plan: MotionPlan, values: Mapping[str, Floats], models: ModelColumns) -> "MotionColumns":
        """Return the columns for runs of these `models` that change these `values`."""
        count = len(models.gravity)
        which = plan.member(values, count)

        def each(get: Callable[[BaseMotion], Any]) -> Floats:
            return np.array([get(member) for member in plan.members], dtype=float)[which]

        factor = factors(values, plan.base_acceleration[which])
        factor = np.ones(count) if factor is None else factor
        per_gravity = factor / models.gravity
        bounds = per_gravity * each(lambda motion: motion.vertical_range(0.0)).T
        rotation = values.get("rotation", np.zeros(count))
        offset = np.stack([values.get(name, np.zeros(count)) for name in OFFSETS], axis=-1)
        pushed = np.hypot(*offset.T) / models.gravity
        if plan.terms is not None:
            terms = _of_runs(plan.terms, which, values, plan.base_acceleration[which])
            waves = (term.wave(models.time_scale, models.gravity, windowed=plan.windowed) for term in terms)
            columns = np.array([np.broadcast_to(one, count) for wave in waves for one in wave]).reshape(-1, count).T
            breaks = _breaks(terms) if plan.windowed else np.empty((count, 0))
            frequency, phase, forward, backward = _single_frequency(terms, plan.motion, count)
            mean_frequency = frequency
        else:
            columns = _table_columns(plan, values, factor, rotation, offset, models)
            breaks = np.empty((count, 0))
            frequency = each(lambda motion: motion.highest_frequency)
            mean_frequency = each(lambda motion: motion.mean_frequency)
            phase = np.zeros(count)
            forward = backward = np.full(count, np.nan)
        lasts = each(lambda motion: motion.duration)
        period = each(lambda motion: motion.period or 0.0)
        if "angular_frequency" in values and plan.terms is not None:
            period = 2.0 * math.pi / values["angular_frequency"]
        return cls(
            columns=columns,
            breaks=breaks / models.time_scale[:, np.newaxis],
            frequency=frequency * models.time_scale,
            mean_frequency=mean_frequency * models.time_scale,
            least_rest_energy=each(least_rest_energy),
            duration=np.where(lasts > 0.0, np.maximum(0.0, lasts + values.get("delay", 0.0)), 0.0),
            period=period / models.time_scale,
            phase=phase,
            largest=np.abs(per_gravity) * each(lambda motion: motion.peak_horizontal(0.0)) + pushed,
            remaining=np.abs(per_gravity) * each(remaining_acceleration) + pushed,
            minimum_vertical=bounds.min(axis=0),
            maximum_vertical=bounds.max(axis=0),
            directions=_directions(plan.members, which, factor, rotation, offset),
            forward=forward,
            backward=backward,
        )

    @property
    def bounds(self) -> Bounds:
        """The numbers on which rest depends."""
        own = (self.frequency, self.mean_frequency, self.least_rest_energy, self.period, self.phase)
        return Bounds(*own, self.largest, self.minimum_vertical, self.maximum_vertical)


def _combined(values: Sequence[Floats]) -> tuple[tuple[Floats, ...], npt.NDArray[np.intp]]:
    """Return the distinct values of each parameter in increasing order, and the combinations that occur."""
    levels = tuple(np.unique(one) for one in values)
    places = [np.searchsorted(level, one) for level, one in zip(levels, values, strict=True)]
    return levels, np.unique(_combination(levels, places)) if levels else np.zeros(0, dtype=np.intp)


def _combination(levels: Sequence[Floats], places: Sequence[npt.NDArray[np.intp]]) -> npt.NDArray[np.intp]:
    return np.asarray(np.ravel_multi_index(tuple(places), tuple(map(len, levels))), dtype=np.intp)


def _single_frequency(terms: Sequence[Term], motion: BaseMotion, count: int) -> tuple[Floats, ...]:
    """Return the highest frequency of each run, its phase at t = 0, and the azimuths of its circular components."""
    nothing = np.full(count, np.nan)
    if not terms:
        return np.full(count, motion.highest_frequency), np.zeros(count), nothing, nothing
    if len(terms) > 1:
        highest = np.max([np.broadcast_to(term.angular_frequency, count) for term in terms], axis=0)
        return highest, np.zeros(count), nothing, nothing
    (term,) = terms
    return term.angular_frequency, term.phase_at_start / (2.0 * math.pi), *term.azimuths()


def _directions(
    members: Sequence[BaseMotion], which: npt.NDArray[np.intp], factor: Floats, rotation: Floats, offset: Floats
) -> Floats:
    spanning = [member.directions() for member in members]
    vectors = np.zeros((len(members), max(map(len, spanning)), 2))  # zero vectors are parallel to any line
    for number, given in enumerate(spanning):
        vectors[number, : len(given)] = np.array(given, dtype=float).reshape(-1, 2)
    cos, sin = np.cos(rotation)[:, np.newaxis], np.sin(rotation)[:, np.newaxis]
    x, y = np.moveaxis(vectors[which], -1, 0)
    turned = np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)
    return np.concatenate([factor[:, np.newaxis, np.newaxis] * turned, offset[:, np.newaxis]], axis=1)


def _table_columns(
    plan: MotionPlan,
    values: Mapping[str, Floats],
    factor: Floats,
    rotation: Floats,
    offset: Floats,
    models: ModelColumns,
) -> Floats:
    count = len(factor)
    scaled, which = factor / models.gravity, plan.member(values, count)
    delay = values.get("delay", np.zeros(count))
    first, number = plan.first[which], plan.lengths[which]
    columns = {
        Tabulated.FACTOR: scaled,
        Tabulated.COS: np.cos(rotation),
        Tabulated.SIN: np.sin(rotation),
        Tabulated.VERTICAL: scaled,
        Tabulated.DELAY: delay,
        Tabulated.OFFSET_X: offset[:, 0] / models.gravity,
        Tabulated.OFFSET_Y: offset[:, 1] / models.gravity,
        Tabulated.FIRST: first,
        Tabulated.COUNT: number,
    }
    return np.stack([columns[column] for column in Tabulated], axis=1)
