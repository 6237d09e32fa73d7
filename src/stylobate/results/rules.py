"""Rules that classify a motion under a periodic base motion as rolling, rocking or modulated."""

from dataclasses import dataclass

from stylobate.errors import require_positive, require_whole


@dataclass(frozen=True, slots=True, kw_only=True)
class OutcomeRules:
    """Thresholds that classify the motion over the last periods of a run.

    Parameters
    ----------
    periods
        Number n of base periods at the end of the run that are compared.
    frequency_tolerance
        Rolling and modulated rolling: maximum relative difference of the mean rolling rate and the base frequency. For
        modulated rolling it is the trend of the phase lag over the second half of the run.
    repeat_tolerance
        Periodic motion: maximum difference of states one period apart, as a fraction of the maximum tilt and rate.
    rest_tilt
        Rolling: minimum tilt, as a fraction of c.
    steady_periods
        Motion that does not repeat: minimum number of base periods of the run. In shorter runs the differences of a
        transient can scatter as those of a lasting motion.
    settled_tolerance
        Motion that does not repeat: maximum relative change of the difference of states one period apart, along its
        exponential trend over the second half of the run. A difference that shrinks or grows is still a transient.
    sampling_errors
        Number of standard errors of this trend by which the difference may change as well: the differences of an
        aperiodic motion scatter, while those of a transient shrink or grow steadily.
    modulation_floor
        Motion that does not repeat: minimum difference of states one period apart, as a fraction of the maximum tilt
        and rate.

    Raises
    ------
    ParameterError
        If a number is not positive, or a number of periods is not a whole number.
    """

    periods: int = 10
    steady_periods: int = 100
    frequency_tolerance: float = 1e-3
    repeat_tolerance: float = 1e-6
    rest_tilt: float = 1e-6
    settled_tolerance: float = 0.05
    sampling_errors: float = 6.0
    modulation_floor: float = 1e-3

    def __post_init__(self) -> None:
        object.__setattr__(self, "periods", require_whole("rules.periods", self.periods, least=1))
        least = require_whole("rules.steady_periods", self.steady_periods, least=1)
        object.__setattr__(self, "steady_periods", least)
        for name in self.__slots__[2:]:
            object.__setattr__(self, name, require_positive(f"rules.{name}", getattr(self, name)))
