"""First Lyapunov coefficient of steady rolling at ν*: supercritical or subcritical Hopf bifurcation.

The coefficient of the Hopf bifurcation of (7) follows from second and third derivatives in closed form. The state is
(θ̇/c, β̇, θ/c, ψ) and the amplitude a = a0/c; at steady rolling θ̇ = 0 and β̇ = ν.
"""

from dataclasses import dataclass

import numpy as np

from stylobate.theory.arguments import ComplexArray, FloatArray, Real, Values, not_negative, plain_results, positive
from stylobate.theory.averaging import rotating_frame_jacobian
from stylobate.theory.rolling import critical_frequency, crossing_frequency, steady_rolling


@plain_results
def first_lyapunov_coefficient(a0: Real, *, c: Real, eta: Real) -> Values:
    """Compute the first Lyapunov coefficient of steady rolling on a circling base at the critical frequency.

    Parameters
    ----------
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η.

    Returns
    -------
    numpy.ndarray
        The coefficient, of the broadcast shape: negative if a stable modulated rolling bifurcates below ν*
        (supercritical). NaN if no ν* exists, at the start of its curve, and without damping, when the loss of stability
        is no Hopf bifurcation.

    Raises
    ------
    ParameterError
        If `c` is not positive, or `a0` or `eta` is negative.

    Notes
    -----
    l1 = Re[⟨p, C(q, q, q̄)⟩ − 2⟨p, B(q, J⁻¹B(q, q̄))⟩ + ⟨p, B(q̄, (2iΩ − J)⁻¹B(q, q))⟩] / (2Ω) with Jq = iΩq, Jᵀp = −iΩp,
    ⟨q, q⟩ = 1 and ⟨p, q⟩ = 1, in the state (θ̇/c, β̇, θ/c, ψ), so that l1 depends on a0/c and η alone. Only the sign
    has a meaning; the size depends on the scales of the state. l1 was negative in all cases computed: a0/c from 0.001
    to 100 and η from 0.001 to 20.

    References
    ----------
    Yu. A. Kuznetsov, Elements of Applied Bifurcation Theory, 3rd ed., Springer 2004, eq. (5.62).

    Examples
    --------
    >>> print(first_lyapunov_coefficient([0.02, 0.065], c=0.1, eta=0.1).round(4))
    [-4.3987 -1.6652]
    """
    amplitude, c, eta = np.broadcast_arrays(not_negative("a0", a0), positive("c", c), not_negative("eta", eta))
    nu, frequency = (np.asarray(of(amplitude, c=c, eta=eta)) for of in (critical_frequency, crossing_frequency))
    regular = (frequency > 0.0) & (eta > 0.0)
    coefficient = np.full(amplitude.shape, np.nan)
    coefficient[regular] = _coefficient(nu[regular], frequency[regular], amplitude[regular] / c[regular], eta[regular])
    return coefficient


def _coefficient(nu: FloatArray, frequency: FloatArray, a0: FloatArray, eta: FloatArray) -> FloatArray:
    rolling = steady_rolling(nu, a0, c=1.0, eta=eta).upper
    tilt, phase = rolling.amplitude, rolling.phase
    flow = _Expansion(nu=nu, tilt=tilt, push=a0 * np.cos(phase), drive=a0 * np.sin(phase))
    state = np.stack([np.zeros_like(nu), nu, tilt, phase])
    jacobian = rotating_frame_jacobian(state, a0, eta=eta).astype(np.complex128)
    q, p = _critical_vectors(nu, tilt, eta, frequency)
    forced = _solve(jacobian, flow.second(q, q.conj()))
    shifted = 2.0j * frequency[:, np.newaxis, np.newaxis] * np.eye(4) - jacobian
    doubled = _solve(shifted, flow.second(q, q))
    cubic = flow.third(q, q, q.conj()) - 2.0 * flow.second(q, forced) + flow.second(q.conj(), doubled)
    projected: ComplexArray = np.sum(p.conj() * cubic, axis=-1)
    return projected.real / (2.0 * frequency)


def _solve(matrices: ComplexArray, vectors: ComplexArray) -> ComplexArray:
    return np.linalg.solve(matrices, vectors[..., np.newaxis])[..., 0].astype(np.complex128)


def _critical_vectors(
    nu: FloatArray, tilt: FloatArray, eta: FloatArray, frequency: FloatArray
) -> tuple[ComplexArray, ComplexArray]:
    """Return q and p of the eigenvalue iω_H in closed form from the sparse Jacobian, with a0 sin ψ = ηνθ."""
    s = 1.0j * frequency
    turn, detuning = nu * (2.0 * s + eta), s**2 + eta * s - 1.0 - nu**2
    q = np.stack([s * turn * tilt, s * detuning, turn * tilt, detuning], axis=-1)
    first, second = turn / tilt, -detuning
    third = (s + eta) * first + 2.0 * nu / tilt * second
    fourth = (s + eta) * second - 2.0 * nu * tilt * first
    p = np.stack([first, second, third, fourth], axis=-1).conj()
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return q, p / np.sum(p.conj() * q, axis=-1, keepdims=True).conj()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Expansion:
    """Second and third derivatives of (7) at steady rolling, applied to vectors (..., 4) in the order (θ̇, β̇, θ, ψ).

    Parameters
    ----------
    nu, tilt
        Rolling rate and tilt angle.
    push, drive
        a cos ψ and a sin ψ.
    """

    nu: FloatArray
    tilt: FloatArray
    push: FloatArray
    drive: FloatArray

    def second(self, x: ComplexArray, y: ComplexArray) -> ComplexArray:
        """Return B(x, y)."""
        xm, xw, xa, xp = np.moveaxis(x, -1, 0)
        ym, yw, ya, yp = np.moveaxis(y, -1, 0)
        tilting = 2.0 * self.tilt * xw * yw + 2.0 * self.nu * (xw * ya + xa * yw) + self.push * xp * yp
        turning = (
            self._moment_2(xm, xw, xp, ym, yw, yp) / self.tilt
            - (self._moment_1(xm, xp) * ya + self._moment_1(ym, yp) * xa) / self.tilt**2
            + 2.0 * self.drive * xa * ya / self.tilt**3
        )
        return _rates(tilting, turning)

    def third(self, x: ComplexArray, y: ComplexArray, z: ComplexArray) -> ComplexArray:
        """Return C(x, y, z)."""
        tilting = -self.drive * x[..., 3] * y[..., 3] * z[..., 3]
        turning = -self.push * x[..., 3] * y[..., 3] * z[..., 3] / self.tilt
        turning = turning - 6.0 * self.drive * x[..., 2] * y[..., 2] * z[..., 2] / self.tilt**4
        for u, v, w in ((x, y, z), (y, z, x), (z, x, y)):
            um, uw, ua, up = np.moveaxis(u, -1, 0)
            vm, vw, va, vp = np.moveaxis(v, -1, 0)
            wa = w[..., 2]
            tilting = tilting + 2.0 * uw * vw * wa
            turning = turning - self._moment_2(um, uw, up, vm, vw, vp) * wa / self.tilt**2
            turning = turning + 2.0 * self._moment_1(w[..., 0], w[..., 3]) * ua * va / self.tilt**3
        return _rates(tilting, turning)

    def _moment_1(self, m: ComplexArray, p: ComplexArray) -> ComplexArray:
        """Return the first derivative of −2θ̇β̇ + a sin ψ, θ times the turning acceleration without damping."""
        return -2.0 * self.nu * m + self.push * p

    def _moment_2(
        self,
        xm: ComplexArray,
        xw: ComplexArray,
        xp: ComplexArray,
        ym: ComplexArray,
        yw: ComplexArray,
        yp: ComplexArray,
    ) -> ComplexArray:
        """Return the second derivative of −2θ̇β̇ + a sin ψ."""
        return -2.0 * (xm * yw + xw * ym) - self.drive * xp * yp


def _rates(tilting: ComplexArray, turning: ComplexArray) -> ComplexArray:
    """Combine the derivatives of θ̈ and β̈ with the derivatives of θ̇ and ψ̇, which are linear."""
    none = np.zeros_like(tilting)
    return np.stack([tilting, turning, none, none], axis=-1)
