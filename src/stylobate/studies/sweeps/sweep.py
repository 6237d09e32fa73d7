"""`Sweep`: one description of many runs."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Self, Unpack

import numpy.typing as npt

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.base_motions.declared import is_pulse
from stylobate.engine.parameters import own_numbers
from stylobate.engine.verdict import duration_of_runs
from stylobate.errors import ParameterError, require_positive, require_vector
from stylobate.kinds import names_code
from stylobate.models import Model
from stylobate.provenance import provenance_of_run
from stylobate.results import OutcomeRules
from stylobate.results.random_numbers import Rng
from stylobate.run_arguments import RunOptions, defaults_of
from stylobate.studies.known_rolling import require_closed_form
from stylobate.studies.sweeps.chunks import Blocks, Layout, Recipe, bytes_on_disk, layout_of
from stylobate.studies.sweeps.designs import OF_A_RUN, Box, Design, Grid, Points, check_quantities, whole
from stylobate.studies.sweeps.fingerprint import identity_of


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sweep:
    """Describe many runs that differ in some quantities: `Sweep.grid`, `Sweep.random` or `Sweep.points`.

    These can vary: the initial conditions tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y, spin [rad/s]; duration [s];
    and every parameter of `simulate_ensemble`, such as acceleration [m/s²], angular_frequency [rad/s], damping or size.

    Parameters
    ----------
    model, motion
        The column and its base motion. Quantities that vary replace their values.
    design
        Values of the quantities that vary.
    duration
        Duration of each run [s]. If all base motions end, such as records or pulses, the default is that of the longest
        one and a free-vibration tail of 20/p, where p is `model.column.frequency_parameter`.
    periods
        Duration of each run in periods of its base motion, instead of `duration`.
    options
        Further arguments of `simulate_ensemble`: tilt, tilt_rate, spin, method, rtol, atol, tilt_limit, rest_energy,
        max_steps, samples, strobes, rules, demands, known_orbits (a list); and end_converged, to end runs early
        that have converged to steady rolling in closed form.

    Raises
    ------
    ParameterError
        If a quantity cannot vary; the message names it.

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> from stylobate.studies.sweeps import Sweep
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)
    >>> over = {"angular_frequency": np.linspace(0.5, 3.0, 26), "acceleration": np.linspace(0.1, 0.4, 31)}
    >>> sweep = Sweep.grid(model, motion, over=over, periods=20.0)
    >>> sweep.runs, sweep.dims
    (806, ('angular_frequency', 'acceleration'))
    """

    model: Model
    motion: BaseMotion
    design: Design
    duration: float | None = None
    periods: float | None = None
    options: RunOptions = field(default_factory=RunOptions)

    def __post_init__(self) -> None:
        if not isinstance(self.model, Model):
            raise ParameterError(f"model must be a model such as Slender(column), got {self.model!r}")
        if not isinstance(self.motion, BaseMotion):
            raise ParameterError(
                f"motion must be a base motion such as Harmonic.circular(...) or None, got {self.motion!r}"
            )
        check_quantities(self.design.argument, self.model, self.design.names, self.motion)
        self._check_duration()
        defaults = defaults_of(RunOptions)
        unknown = [name for name in self.options if name not in defaults]
        if unknown:
            raise ParameterError(f"{unknown[0]} is no option of a sweep; the options are {', '.join(defaults)}")
        options = {**defaults, **self.options}
        for name, unit in (("tilt", "rad"), ("tilt_rate", "rad/s")):
            options[name] = require_vector(name, options[name], 2, unit)
        if options["end_converged"]:
            require_closed_form(self.model, self.motion, [name for name in self.design.names if name not in OF_A_RUN])
        object.__setattr__(self, "options", options)

    @classmethod
    def grid(
        cls,
        model: Model,
        motion: BaseMotion | None = None,
        *,
        over: Mapping[str, npt.ArrayLike],
        duration: float | None = None,
        periods: float | None = None,
        **options: Unpack[RunOptions],
    ) -> Self:
        """Return a sweep over every combination of these values; its result has the dimensions of `over`, in order."""
        return cls._of(
            Grid.of(over, own_numbers(model, motion)),
            model,
            motion,
            duration=duration,
            periods=periods,
            options=options,
        )

    @classmethod
    def random(
        cls,
        model: Model,
        motion: BaseMotion | None = None,
        *,
        over: Mapping[str, Sequence[float]],
        count: int,
        rng: Rng,
        duration: float | None = None,
        periods: float | None = None,
        **options: Unpack[RunOptions],
    ) -> Self:
        """Return a sweep of `count` runs drawn uniformly between these bounds.

        `rng` is a seed or a numpy.random.Generator. The same seed gives the same runs for all chunk sizes, and the
        first runs of a longer sweep are those of a shorter one. From a generator one number is drawn and kept as the
        seed, so that a store can be resumed.
        """
        return cls._of(
            Box.of(over, count, rng, own_numbers(model, motion)),
            model,
            motion,
            duration=duration,
            periods=periods,
            options=options,
        )

    @classmethod
    def points(
        cls,
        model: Model,
        motion: BaseMotion | None = None,
        *,
        at: Mapping[str, npt.ArrayLike],
        duration: float | None = None,
        periods: float | None = None,
        **options: Unpack[RunOptions],
    ) -> Self:
        """Return a sweep of runs at these values, arrays of one length."""
        return cls._of(
            Points.of(at, own_numbers(model, motion)),
            model,
            motion,
            duration=duration,
            periods=periods,
            options=options,
        )

    @classmethod
    def _of(cls, design: Design, model: Model, motion: BaseMotion | None, **length_and_options: Any) -> Self:
        base = BASE_AT_REST if motion is None else motion
        return cls(model=model, motion=base, design=design, **length_and_options)

    @property
    def dims(self) -> tuple[str, ...]:
        """The dimensions of the result."""
        return self.design.dims

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the dimensions."""
        return self.design.shape

    @property
    def runs(self) -> int:
        """The number of runs."""
        return math.prod(self.shape)

    def estimated_bytes(self, chunk_size: int | None = None) -> int:
        """Estimate the maximum size of a store of this sweep on disk [bytes], without compression."""
        return bytes_on_disk(self.layout, self.design, Blocks.of(self.shape, chunk_size))

    @property
    def layout(self) -> Layout:
        """Layout of the results; mistakes in the options raise an error."""
        return layout_of(self.recipe, self.design.names)

    @property
    def recipe(self) -> Recipe:
        """Recipe of each run, without the values that vary, for workers."""
        return Recipe(self.model, self.motion, self.duration, self.periods, self.options)

    def describe(self) -> dict[str, Any]:
        """Return the identity of this sweep, version included, as plain values."""
        options: dict[str, Any] = {**self.options}
        options["rules"] = asdict(options["rules"] or OutcomeRules())
        options["known_orbits"] = [orbit.plain() for orbit in options["known_orbits"]]
        for name in ("known_orbits", "end_converged"):  # absent in stores made without them
            if not options[name]:
                del options[name]
        provenance = provenance_of_run(self.model, self.motion, **options)
        for name, thing in (("model", self.model), ("motion", self.motion)):
            if provenance[name].get("kind") == "other":
                provenance[name] = identity_of(thing)
            elif names_code(provenance[name]):  # code can change while its path and its numbers do not
                provenance[f"{name} code"] = identity_of(thing)
        return {**provenance, "duration": self.duration, "periods": self.periods, "design": self.design.describe()}

    def _check_duration(self) -> None:
        given = [name for name in ("duration", "periods") if getattr(self, name) is not None]
        if "duration" in self.design.names:
            given.append("duration among what varies")
        if not given and (self.motion.ends or 0.0 < self.motion.duration < math.inf):
            duration = duration_of_runs(self.model, self.motion, _ends(self.design))
            object.__setattr__(self, "duration", duration)
        elif len(given) != 1:
            got = " and ".join(given) or "none of them"
            raise ParameterError(f"a sweep needs one of duration [s], periods, or a duration that varies; got {got}")
        if self.duration is not None:
            object.__setattr__(self, "duration", require_positive("duration", self.duration, "s"))
        if self.periods is not None:
            object.__setattr__(self, "periods", require_positive("periods", self.periods))
            varied = "angular_frequency" in self.design.names and not is_pulse(self.motion)
            if not varied and self.motion.period is None:
                raise ParameterError(f"periods needs a periodic base motion; give duration [s] for {self.motion!r}")


def _ends(design: Design) -> dict[str, tuple[float, float]]:
    """Return the smallest and largest value of each quantity that varies."""
    if isinstance(design, Box):
        return dict(design.bounds)
    values = design.coordinates(whole(design))
    return {name: (float(one.min()), float(one.max())) for name, one in values.items() if one.size}
