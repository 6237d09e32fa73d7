"""Trajectory of one run: a polynomial for each step, from the trace of its kernel."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from stylobate.compiler.compiled import over_rows
from stylobate.engine.kernel.columns import TRACE_TERMS, Trace
from stylobate.engine.kernel.driver.events import TraceKind
from stylobate.models import Model

Floats = npt.NDArray[np.float64]

# Nodes of Gauss's rule in each step, for the integration of passive states.
_NODES = 0.5 + 0.5 * np.polynomial.legendre.leggauss(8)[0]
# Row k holds the antiderivative of the polynomial that is 1 at node k and 0 at the other nodes, by powers of u.
_ANTIDERIVATIVES = np.array(
    [
        np.polynomial.Polynomial.fit(_NODES, row, len(_NODES) - 1, domain=(0.0, 1.0), window=(0.0, 1.0)).integ().coef
        for row in np.eye(len(_NODES))
    ]
)


@dataclass(frozen=True)
class Trajectory:
    """Motion of a run from its start to its end, as a function of dimensionless time.

    Parameters
    ----------
    model
        Model of the column.
    stretches
        Entries of the trace that are not events, shape (n, columns).
    line
        Unit vector of the line of planar motion.
    carried
        Initial passive states.
    end
        End of the run.
    """

    model: Model
    stretches: Floats
    line: tuple[float, float]
    carried: tuple[float, ...]
    end: float

    @property
    def steps(self) -> int:
        """Number of integration steps."""
        return int(np.isin(self._kinds, (TraceKind.STEP, TraceKind.PLANE_STEP)).sum())

    @property
    def half_turns(self) -> int:
        """Number of half turns of the contact point round the rim; each passage near the vertical is about one."""
        turned = self.stretches[:, Trace.END_AZIMUTH] - self.stretches[:, Trace.AZIMUTH]
        return round(2.0 * float(np.abs(turned[self._kinds == TraceKind.STEP]).sum()))

    @property
    def starts(self) -> Floats:
        """Start of each stretch."""
        return self.stretches[:, Trace.START]

    @property
    def ends(self) -> Floats:
        """End of each stretch, the start of the next one."""
        return np.append(self.starts[1:], self.end)

    @cached_property
    def on_base(self) -> npt.NDArray[np.bool_]:
        """Whether the column stands on its base, at rest or sliding, in each stretch."""
        stands = np.asarray(self._kinds == TraceKind.STAND)
        return stands | (self.contacts <= 1) if self.model.switches else stands

    @property
    def contacts(self) -> npt.NDArray[np.int8]:
        """Kind of contact in each stretch, for a model that changes between kinds of contact."""
        return np.asarray(self._terms[0, len(self.model.state_names) - 1], dtype=np.int8)

    @property
    def standing(self) -> list[tuple[float, float]]:
        """Start and end of each interval in which the column stands on its base."""
        stands = self._kinds == TraceKind.STAND
        return list(zip(self.starts[stands].tolist(), self.ends[stands].tolist(), strict=True))

    def until(self, end: float) -> "Trajectory":
        """Return the motion up to an earlier `end`."""
        begun = self.starts < end
        return replace(self, stretches=self.stretches[begun] if begun.any() else self.stretches[:1], end=end)

    def states(self, tau: Floats, stretch: int | None = None) -> Floats:
        """Return the states, shape (number of states, n), at times between the start and the end.

        At the time of an impact the velocities are those after the impact, or those of the stretch with the index
        `stretch`.
        """
        which = self._at(tau) if stretch is None else np.full(tau.shape, stretch)
        states = self._lifted(self._within(which, self._share(which, tau)), which)
        if not self.carried:
            return states
        return np.concatenate([states, self._carried_at(which, tau)])

    def resting(self, tau: Floats) -> npt.NDArray[np.bool_]:
        """Return whether the column stands on its base, shape (n,)."""
        return np.asarray(self.on_base[self._at(tau)])

    def azimuth(self, tau: Floats, tilt: Floats) -> Floats:
        """Return the continuous azimuth [rad] of the `tilt` vectors, shape (2, n), at `tau`.

        The azimuth is NaN if the column stands upright; in planar motion it is not continuous.
        """
        which = self._at(tau)
        x, y = tilt
        here = np.arctan2(y, x) / (2.0 * np.pi)
        # Within a stretch the tilt vector rotates in one direction by less than a turn.
        middle = 0.5 * (self.stretches[:, Trace.AZIMUTH] + self.stretches[:, Trace.END_AZIMUTH])[which]
        kinds = self._kinds[which]
        turns = np.where(kinds == TraceKind.PLANE_STEP, 0.0, np.round(middle - here))
        known = (kinds != TraceKind.STAND) & (np.hypot(x, y) > 0.0)
        return np.where(known, 2.0 * np.pi * (here + turns), np.nan)

    @property
    def _kinds(self) -> Floats:
        return self.stretches[:, Trace.KIND]

    @cached_property
    def _terms(self) -> Floats:
        """States at the starts, and coefficients, shape (8, number of states, n), contiguous for fast selection."""
        terms = self.stretches[:, len(Trace) :].reshape(len(self.stretches), TRACE_TERMS, -1)
        return np.ascontiguousarray(terms.transpose(1, 2, 0))

    def _at(self, tau: Floats) -> npt.NDArray[np.intp]:
        return np.clip(np.searchsorted(self.starts, tau, side="right") - 1, 0, None)

    def _share(self, which: npt.NDArray[np.intp], tau: Floats) -> Floats:
        return np.asarray((tau - self.starts[which]) / self.stretches[which, Trace.LENGTH])

    def _within(self, which: npt.NDArray[np.intp], share: Floats) -> Floats:
        """Return the values of the polynomials of these stretches: states, or tilt and rate for planar motion.

        E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., section II.6.
        """
        change = np.zeros((self._terms.shape[1], which.size))
        for power in reversed(range(1, TRACE_TERMS)):
            change += np.take(self._terms[power], which, axis=1)
            change *= share if power % 2 else 1.0 - share
        return np.asarray(np.take(self._terms[0], which, axis=1) + change)

    def _lifted(self, states: Floats, which: npt.NDArray[np.intp]) -> Floats:
        """Return the states of the model from the `states` of these stretches."""
        planar = self._kinds[which] == TraceKind.PLANE_STEP
        if not planar.any():
            return states[: len(self.model.state_names)]
        assert self.model.from_plane is not None
        lifted = self.model.from_plane(states[0], states[1], *self.line, *self.model.parameters)
        count = len(self.model.state_names)
        return np.where(planar, np.stack(np.broadcast_arrays(*lifted)), states[:count])

    def _carried_at(self, which: npt.NDArray[np.intp], tau: Floats) -> Floats:
        begun, terms = self._carried
        gained = _polynomials(terms, which, self._share(which, tau))
        return np.asarray(np.take(begun, which, axis=1) + self.stretches[which, Trace.LENGTH] * gained)

    @cached_property
    def _carried(self) -> tuple[Floats, Floats]:
        """Passive states at the start of each stretch (c, n), and their increments by powers of the share (p, c, n)."""
        assert self.model.carried_rates is not None
        count, carried = len(self.stretches), len(self.carried)
        terms = np.zeros((len(_NODES) + 1, carried, count))
        steps = np.flatnonzero(self._kinds == TraceKind.STEP)
        if steps.size:
            each, nodes = np.repeat(steps, len(_NODES)), np.tile(_NODES, steps.size)
            rates = self._carried_rates(self._within(each, nodes).T).reshape(steps.size, len(_NODES), carried)
            terms[..., steps] = np.einsum("nkc,kp->pcn", rates, _ANTIDERIVATIVES)
        analytical = np.flatnonzero(self._kinds == TraceKind.ANALYTICAL_STEP)
        if analytical.size:
            terms[1][:, analytical] = self._carried_rates(self._terms[0][:, analytical].T).T
        each = np.arange(count)
        gained = _polynomials(terms, each, self._share(each, self.ends)) * self.stretches[:, Trace.LENGTH]
        before = np.cumsum(np.hstack([np.zeros((carried, 1)), gained[:, :-1]]), axis=1)
        return np.array(self.carried)[:, np.newaxis] + before, terms

    def _carried_rates(self, states: Floats) -> Floats:
        assert self.model.carried_rates is not None
        parameters = np.broadcast_to(self.model.parameters, (len(states), len(self.model.parameters)))
        rows = np.hstack([states[:, : len(self.model.state_names)], parameters])
        return over_rows(self.model.carried_rates, rows, name=self.model.name)


def _polynomials(terms: Floats, which: npt.NDArray[np.intp], share: Floats) -> Floats:
    """Return the values at `share` of the polynomials with these indices, coefficients of shape (powers, c, n)."""
    value = np.zeros((terms.shape[1], which.size))
    for coefficients in reversed(terms):
        value *= share
        value += np.take(coefficients, which, axis=1)
    return value
