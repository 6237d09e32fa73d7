"""Measure the error of single runs at several tolerances. Run as `python -m benchmarks.accuracy`; it takes seconds.

The table is on the page "Numerical methods" of the documentation. All problems have c = 0.1.
"""

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

import stylobate as sb
from stylobate.results import Run

C, ETA = 0.1, 0.1
TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12, 1e-13)


def model(damping: float = 0.0) -> sb.Slender:
    """Create the slender column in units with m = g = ω0 = 1."""
    return sb.Slender(sb.Column.dimensionless(C), damping=damping)


def elliptic_motion(rtol: float) -> float:
    """Measure the largest error of tilt and rate [c] at τ = 3 against an independent integration to 1e-12."""
    a1, a2, phase, nu = 0.9 * C, 0.7 * C, 0.9, 1.7

    def rates(tau: float, state: np.ndarray) -> list[float]:
        x, y, vx, vy = state
        lean = 1.0 - C / np.hypot(x, y)
        return [vx, vy, lean * x - a1 * np.cos(nu * tau), lean * y - a2 * np.cos(nu * tau + phase)]

    start = C * np.array([0.5, 0.2, 0.1, 0.35])
    exact = solve_ivp(rates, (0.0, 3.0), start, "DOP853", rtol=1e-13, atol=1e-16, max_step=0.01).y[:, -1]
    motion = sb.Harmonic.elliptic(amplitude=(a1, a2), phase=phase, angular_frequency=nu)
    run = sb.simulate(model(), motion, tilt=start[:2], tilt_rate=start[2:], duration=3.0, rtol=rtol)
    end = run.sample(3.0).isel(time=0)
    found = np.concatenate([end["tilt"].to_numpy(), end["tilt_rate"].to_numpy()])
    return float(np.abs(found - exact).max()) / C


def steady_rolling(rtol: float) -> float:
    """Measure the peak relative deviation of the tilt from steady rolling over 50 periods."""
    nu, a0 = 1.5, 0.065
    branch = sb.theory.steady_rolling(nu, a0, c=C, eta=ETA).upper
    tilt, phase = float(branch.amplitude), float(branch.phase)
    lean = tilt * np.array([np.cos(phase), np.sin(phase)])
    motion = sb.Harmonic.circular(acceleration=a0, angular_frequency=nu)
    rate = nu * np.array([-lean[1], lean[0]])
    run = sb.simulate(model(ETA), motion, tilt=lean, tilt_rate=rate, duration=50 * motion.period, rtol=rtol)
    return float(np.abs(run.data["amplitude"] / tilt - 1.0).max())


def free_motion(rtol: float) -> Run:
    """Integrate free motion from 0.6c with the sideways rate 0.3c over τ = 500."""
    return sb.simulate(model(), tilt=(0.6 * C, 0.0), tilt_rate=(0.0, 0.3 * C), duration=500.0, rtol=rtol)


def drift(name: str) -> Callable[[float], float]:
    """Return a function that measures the peak relative drift of a constant of free motion."""

    def measure(rtol: float) -> float:
        values = free_motion(rtol).data[name].to_numpy()
        return float(np.abs(values / values[0] - 1.0).max())

    return measure


def planar_motion(rtol: float) -> float:
    """Measure the peak error [c] of free planar motion from 0.6c over τ = 500 against its closed form."""
    run = sb.simulate(model(), tilt=(0.6 * C, 0.0), duration=500.0, rtol=rtol)
    exact, _ = sb.theory.planar_free_motion(run.data["time"].to_numpy(), 0.6 * C, c=C)
    return float(np.abs(run.data["tilt"].sel(axis="x").to_numpy() - exact).max()) / C


def from_rest(rtol: float) -> float:
    """Measure the largest error [c] in straight motion from rest, with 44 passages, against (1) solved exactly.

    On each side of the vertical the equation is linear; its exponential propagates α, α̇, 1, cos ντ and sin ντ.
    """
    size, nu, eta, duration = 1.05 * C, 4.0, 0.05, 20.0
    motion = sb.Harmonic.straight(acceleration=size, angular_frequency=nu)
    run = sb.simulate(model(eta), motion, duration=duration, rtol=rtol)
    state, time, side, worst = np.array([0.0, 0.0, 1.0, 1.0, 0.0]), 0.0, -1.0, 0.0
    while time < duration:
        matrix = np.zeros((5, 5))
        matrix[0, 1], matrix[1, :4] = 1.0, (1.0, -eta, -side * C, -size)
        matrix[3, 4], matrix[4, 3] = -nu, nu

        def after(elapsed: float, matrix: np.ndarray = matrix, start: np.ndarray = state) -> np.ndarray:
            return np.asarray(expm(matrix * elapsed) @ start)

        steps = np.arange(1e-3, duration - time + 1e-3, 1e-3)
        beyond = next((step for step in steps if side * after(step)[0] < 0.0), None)
        swing = duration - time if beyond is None else float(brentq(lambda t: after(t)[0], 1e-4, beyond, xtol=1e-16))
        worst = max(worst, abs(run.sample(time + 0.5 * swing)["tilt"].to_numpy()[0, 0] - after(0.5 * swing)[0]))
        state, time, side = after(swing), time + swing, -side
        state[0] = 0.0
    return worst / C


PROBLEMS: dict[str, Callable[[float], float]] = {
    "elliptic motion": elliptic_motion,
    "steady rolling": steady_rolling,
    "energy": drift("energy"),
    "angular momentum": drift("angular_momentum"),
    "planar motion": planar_motion,
    "from rest": from_rest,
}


def main() -> None:
    """Print the table of errors in Markdown."""
    print("| `rtol` | " + " | ".join(PROBLEMS) + " |\n|" + "---|" * (len(PROBLEMS) + 1))
    for rtol in TOLERANCES:
        errors = [f"{measure(rtol):.1e}" for measure in PROBLEMS.values()]
        print(f"| {rtol:.0e} | " + " | ".join(errors) + " |")


if __name__ == "__main__":
    main()
