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
        modulated rolling the mean follows from the mean phase lag over the last n periods and over the n before.
    repeat_tolerance
        Periodic motion: maximum difference of states one period apart, as a fraction of the maximum tilt and rate.
    rest_tilt
        Rolling: minimum tilt, as a fraction of c.
    settled_tolerance
        Modulated rolling: maximum relative change of the difference of states one period apart, from the n periods
        before to the last n periods. A difference that shrinks or grows further is still a transient.
    modulation_floor
        Modulated rolling: minimum difference of states one period apart, as a fraction of the maximum tilt and rate.

    Raises
    ------
    ParameterError
        If a number is not positive, or `periods` is not a whole number.
    """

    periods: int = 10
    frequency_tolerance: float = 1e-3
    repeat_tolerance: float = 1e-6
    rest_tilt: float = 1e-6
    settled_tolerance: float = 0.05
    modulation_floor: float = 1e-3

    def __post_init__(self) -> None:
        object.__setattr__(self, "periods", require_whole("rules.periods", self.periods, least=1))
        for name in self.__slots__[1:]:
            object.__setattr__(self, name, require_positive(f"rules.{name}", getattr(self, name)))
