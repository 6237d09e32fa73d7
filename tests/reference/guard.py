"""What ends a kind of contact: guards looked at within each step, their ends located on its dense output."""

from collections.abc import Callable
from dataclasses import dataclass

from scipy.optimize import brentq

from stylobate.models import Model

from .forcing import Floats, Forcing

# Parts of each step at whose ends the guards are looked at.
_PARTS = 4

# A margin below this is all but broken.
_NEXT_TO_NOUGHT = 1e-8


@dataclass(frozen=True, slots=True)
class Guard:
    """Watches the guards of a model; `rest_energy` is ε."""

    model: Model
    forcing: Forcing
    rest_energy: float

    def guards(self, tau: float, state: Floats) -> tuple[float, ...]:
        """Return the guards of one state."""
        assert self.model.guards is not None
        run = (self.rest_energy, self.model.loss_tilt)
        return self.model.guards(*state.tolist(), *self.forcing.at(tau), *run, *self.model.parameters)

    def broken(self, guards: tuple[float, ...]) -> int | None:
        """Return the first margin that is below nought, but for the last, which must have come from above."""
        return next((number for number, margin in enumerate(guards[:-1]) if margin < 0.0), None)

    def nearly_broken(self, guards: tuple[float, ...]) -> int | None:
        """Return the margin next to whose end no step can be made, as where slip is all but gone, if there is one."""
        least = min(range(len(guards) - 1), key=guards.__getitem__)
        return least if guards[least] < _NEXT_TO_NOUGHT else None

    def first_event(
        self, start: float, end: float, dense: Callable[[float], Floats], before: tuple[float, ...]
    ) -> tuple[float, int, tuple[float, ...]]:
        """Return when within a step a margin is first below nought, and which; or its end, −1 and the guards there.

        Parameters
        ----------
        start, end
            The step.
        dense
            The state at a time within it.
        before
            Margins at its start.
        """
        past, guards = start, before
        for place in range(1, _PARTS + 1):
            tau = end if place == _PARTS else start + (end - start) * place / _PARTS
            found = self.guards(tau, dense(tau))
            crossed = [
                (self._crossing(number, past, tau, dense, old), number)
                for number, (old, new) in enumerate(zip(guards, found, strict=True))
                if new < 0.0 and (old >= 0.0 or number < len(found) - 1)
            ]
            if crossed:
                time, number = min(crossed)
                return time, number, found
            past, guards = tau, found
        return end, -1, guards

    def _crossing(self, number: int, low: float, high: float, dense: Callable[[float], Floats], old: float) -> float:
        """Return the first time found at which a margin is below nought."""
        if old < 0.0:
            return low

        def margin(tau: float) -> float:
            return self.guards(tau, dense(tau))[number]

        if margin(low) <= 0.0:
            return low
        # Ends at a place where it is below nought, within a rounding of where it vanishes.
        found = float(brentq(margin, low, high, xtol=4e-15 * max(1.0, abs(high))))
        step = 4e-15 * max(1.0, abs(found))
        while margin(found) >= 0.0 and found < high:
            found, step = min(found + step, high), 2.0 * step
        return found
