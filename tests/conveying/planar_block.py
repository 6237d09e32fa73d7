"""A rigid block in the plane on a vibrating base, by time stepping: impacts and Coulomb friction at two corners.

Independent of the package: Moreau's scheme for all runs at once, in the accelerating frame of the base. Impulses of
each step fulfil Newton's law of impact and Coulomb's law at both corners together, by Gauss–Seidel iteration.
"""

import numpy as np

SWEEPS = 8


def fallen_and_travel(column, *, friction, restitution, along, normal, frequency, tilts, phases, periods, steps=250):
    """Return which blocks fell, and the paths of their centres [m].

    Parameters
    ----------
    along, normal
        Amplitudes of the base acceleration along the plane and along its normal [m/s²], each times cos(2πft + phase).
    frequency
        f [Hz].
    tilts, phases
        Initial tilt [rad] and phase [rad] of each block.
    steps
        Time steps per period.
    """
    r, h, m, inertia, g = (
        column.radius, column.mass_height, column.mass, column.transverse_inertia, column.gravity,
    )  # fmt: skip
    theta = np.array(tilts, dtype=float)
    x, vx, vz, w = np.zeros((4, theta.size))
    z = r * np.sin(np.abs(theta)) + h * np.cos(theta)
    dt = 1.0 / (frequency * steps)
    fallen = np.zeros(theta.size, dtype=bool)
    for step in range(int(periods * steps)):
        time = (step + 0.5) * dt
        x, z, theta = x + 0.5 * dt * vx, z + 0.5 * dt * vz, theta + 0.5 * dt * w
        cos, sin = np.cos(theta), np.sin(theta)
        corners = [(s * r * cos - h * sin, -s * r * sin - h * cos) for s in (1.0, -1.0)]
        wave = np.cos(2.0 * np.pi * frequency * time + phases)
        before = [vz - w * dx for dx, _ in corners]
        vx, vz = vx - dt * along * wave, vz - dt * (g + normal * wave)
        touching = [z + dz <= 0.0 for _, dz in corners]
        if any(touch.any() for touch in touching):
            impulses = [np.zeros((2, theta.size)) for _ in corners]
            for _ in range(SWEEPS):
                for (dx, dz), old, touch, impulse in zip(corners, before, touching, impulses, strict=True):
                    wanted = vz - w * dx + restitution * np.minimum(old, 0.0)
                    total = np.where(touch, np.maximum(impulse[0] - wanted / (1.0 / m + dx * dx / inertia), 0.0), 0.0)
                    change, impulse[0] = total - impulse[0], total
                    vz, w = vz + change / m, w - dx * change / inertia
                    slip = vx + w * dz
                    most = friction * impulse[0]
                    total = np.clip(impulse[1] - slip / (1.0 / m + dz * dz / inertia), -most, most)
                    change, impulse[1] = total - impulse[1], total
                    vx, w = vx + change / m, w + dz * change / inertia
        x, z, theta = x + 0.5 * dt * vx, z + 0.5 * dt * vz, theta + 0.5 * dt * w
        fallen |= np.abs(theta) > 1.0
        if fallen.any():  # a block that has fallen is of no interest
            vx, vz, w = (np.where(fallen, 0.0, one) for one in (vx, vz, w))
    return fallen, x
