"""When a motion under a periodic base motion counts as rolling, rocking or modulated."""

from dataclasses import dataclass

from stylobate.errors import require_positive, require_whole


@dataclass(frozen=True, slots=True, kw_only=True)
class OutcomeRules:
    """Thresholds of the outcomes that are judged over the last periods of a run.

    Parameters
    ----------
    periods
        Number n of forcing periods at the end of the run that are looked at.
    frequency_tolerance
        Rolling and modulated: the mean of β̇ differs from the forcing frequency by less than this part of it. For a
        modulated motion the mean follows from the average lag behind the forcing over the last n periods and over
        the n before.
    repeat_tolerance
        The motion repeats if states one period apart differ by less than this part of the largest tilt and rate.
    rest_tilt
        Rolling: the tilt never falls below this part of c.
    settled_tolerance, modulation_floor
        Modulated: states one period apart differ by more than the floor, and over the last n periods by as much as
        over the n before, to this part. A difference that shrinks or grows is a motion still on its way.

    Raises
    ------
    ParameterError
        If a number is not positive, or `periods` no whole number.
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
