"""Options of an ensemble, and their checks."""

from dataclasses import dataclass

from stylobate.config.run_numbers import Accuracy, numbers_of
from stylobate.engine.tolerances import OVERTURNED_TILT, RTOL_RANGE
from stylobate.errors import MOST_STEPS, ParameterError, require_positive, require_whole
from stylobate.results import OutcomeRules

METHODS = ("dop853", "taylor")
"""Methods of integration of an ensemble."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """Options that all runs of an ensemble share, as in `simulate`."""

    method: str
    rtol: float
    atol: float | None
    tilt_limit: float | None
    rest_energy: float | None
    max_steps: int
    samples: int
    strobes: int
    rules: OutcomeRules
    demands: bool
    recheck: bool

    @classmethod
    def checked(
        cls,
        *,
        method: str = "dop853",
        rtol: float,
        atol: float | None,
        tilt_limit: float | None,
        rest_energy: float | None,
        max_steps: int,
        samples: int | None,
        strobes: int,
        rules: OutcomeRules | None,
        demands: bool = False,
        recheck: bool = False,
    ) -> "Options":
        """Check and return the options.

        Raises
        ------
        ParameterError
            If an option is out of range.
        """
        if method not in METHODS:
            message = f"method must be one of {', '.join(map(repr, METHODS))}, got {method!r}"
            raise ParameterError(message)
        declared, (low, high) = numbers_of(Accuracy), RTOL_RANGE
        rtol = require_positive("rtol", rtol)
        if not low <= rtol <= high:
            message = f"rtol must lie between {low!r} and {high!r}, got {rtol!r}"
            raise ParameterError(message)
        if rules is not None and not isinstance(rules, OutcomeRules):
            message = f"rules must be OutcomeRules(...) or None, got {rules!r}"
            raise ParameterError(message)
        return cls(
            method=method,
            rtol=rtol,
            atol=declared["atol"].checked(atol),
            tilt_limit=declared["tilt_limit"].checked(tilt_limit),
            rest_energy=declared["rest_energy"].checked(rest_energy),
            max_steps=require_whole("max_steps", max_steps, least=1, most=MOST_STEPS),
            samples=0 if samples is None else require_whole("samples", samples, least=2),
            strobes=require_whole("strobes", strobes, least=0),
            rules=rules or OutcomeRules(),
            demands=bool(demands),
            recheck=bool(recheck),
        )

    @property
    def overturned_tilt(self) -> float:
        """Tilt that counts as overturned if no criterion proves overturning [rad]."""
        return OVERTURNED_TILT
