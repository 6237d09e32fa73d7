"""Response curve of straight-line motion: exact orbits against plain shooting with SciPy.

Run as `python -m benchmarks.orbits`. Task: rolling at a1 = 0.13, c = η = 0.1, from ν = 8 down to 0.8 with Floquet
multipliers. Plain shooting uses Newton's method at each frequency from an extrapolation of the two previous orbits.
solve_ivp (DOP853) integrates equations (1) and their variational equations in Python at the same tolerance, 1e-12. It
locates no bifurcation.
"""

import math
import os
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import stylobate as sb

C = ETA = 0.1
A1, LOW, HIGH, RTOL = 0.13, 0.8, 8.0, 1e-12
TARGET = Path("docs/_static/benchmarks/orbits.txt")


def variational(t, y, nu):
    """Evaluate the right-hand side of (1) and of its variational equations."""
    x, z, vx, vz = y[:4]
    tilt = math.hypot(x, z)
    lean = 1.0 - C / tilt
    ax = A1 * math.cos(nu * t)
    cube = C / tilt**3
    jacobian = np.array(
        [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [lean + cube * x * x, cube * x * z, -ETA, 0.0],
            [cube * x * z, lean + cube * z * z, 0.0, -ETA],
        ]
    )
    return np.concatenate(
        [[vx, vz, lean * x - ETA * vx - ax, lean * z - ETA * vz], (jacobian @ y[4:].reshape(4, 4)).ravel()]
    )


def shot(state, nu):
    """Compute the state after a period and its derivative."""
    start = np.concatenate([state, np.eye(4).ravel()])
    run = solve_ivp(
        variational, (0.0, 2.0 * math.pi / nu), start, "DOP853", args=(nu,), rtol=RTOL, atol=1e-2 * RTOL * C
    )
    return run.y[:4, -1], run.y[4:, -1].reshape(4, 4)


def plain(start, frequencies):
    """Compute multipliers at each frequency, by shooting from an extrapolation of the two previous orbits."""
    state, found, before = start, [], []
    for nu in frequencies:
        if len(before) > 1:
            (older, there), (old, here) = before[-2:]
            state = here + (here - there) * (nu - old) / (old - older)
        for _ in range(20):
            end, derivative = shot(state, nu)
            step = np.linalg.solve(derivative - np.eye(4), state - end)
            state = state + step
            if np.abs(step).max() < 1e-10 * np.abs(state).max():
                break
        before.append((nu, state))
        found.append(np.linalg.eigvals(derivative))
    return np.array(found)


def main():
    """Time both methods and write the table."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    model = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
    motion = sb.Harmonic.straight(acceleration=A1, angular_frequency=HIGH)

    def ours():
        orbit = sb.orbits.periodic_orbit(model, motion)
        return sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(LOW, HIGH))

    ours()  # compiled and loaded
    times = []
    for _ in range(5):
        begun = time.perf_counter()
        branch = ours()
        times.append(time.perf_counter() - begun)
    quick = sorted(times)[len(times) // 2]
    frequencies = np.array([point.value for point in branch.path])[::-1]
    begun = time.perf_counter()
    multipliers = plain(branch.path[-1].chain.states[0], frequencies)
    slow = time.perf_counter() - begun
    known = np.array([np.abs(point.multipliers[0]) for point in branch.path[::-1]])
    gap = np.abs(np.abs(multipliers).max(axis=1) / known - 1.0).max()
    located = ", ".join(f"{one.parameter:.9f}" for one in branch.bifurcations)
    TARGET.write_text(
        "| response curve, ν = 8 to 0.8, one core | time [s] | |\n|---|---|---|\n"
        f"| plain shooting with SciPy, {frequencies.size} frequencies | {slow:.3g} | no bifurcation located |\n"
        f"| stylobate, {frequencies.size} orbits | {quick:.3g} | pitchforks at {located} |\n\n"
        f"Ratio {slow / quick:.0f}. The largest multipliers agree within {gap:.0e} of themselves.\n",
        encoding="utf-8",
    )
    print(TARGET.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
