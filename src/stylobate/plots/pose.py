"""Pose of a column that leans on its rim: the definition that all figures and animations share."""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def quaternions(tilt: npt.ArrayLike, twist: npt.ArrayLike) -> Floats:
    """Return the rotations Rz(β) Ry(θ) Rz(χ − β) of leaning columns as unit quaternions w, x, y, z.

    The quaternions are smooth functions of tilt vector and twist, also through the vertical: their sign never jumps.

    Parameters
    ----------
    tilt
        Tilt vectors θ(cosβ, sinβ), shape (…, 2) [rad].
    twist
        Angles of turn χ about the axis, shape (…) [rad].

    Returns
    -------
    numpy.ndarray
        Shape (…, 4).
    """
    lean, half = np.asarray(tilt, dtype=float), 0.5 * np.asarray(twist, dtype=float)
    angle = np.hypot(lean[..., 0], lean[..., 1])
    # sin(θ/2)/θ, ½ at θ = 0; np.sinc(u) is sin(πu)/(πu).
    share = 0.5 * np.sinc(angle / (2.0 * np.pi))
    sine, cosine = np.sin(half), np.cos(half)
    return np.stack(
        [
            np.cos(0.5 * angle) * cosine,
            share * (lean[..., 0] * sine - lean[..., 1] * cosine),
            share * (lean[..., 0] * cosine + lean[..., 1] * sine),
            np.cos(0.5 * angle) * sine,
        ],
        axis=-1,
    )


def frames(rotation: npt.ArrayLike) -> Floats:
    """Return the matrices of unit quaternions, shape (…, 3, 3), with the body's x, y and axis as columns."""
    w, x, y, z = np.moveaxis(np.asarray(rotation, dtype=float), -1, 0)
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def base_centres(
    tilt: npt.ArrayLike, footprint: npt.ArrayLike, radius: float, clearance: npt.ArrayLike = 0.0
) -> Floats:
    """Return the centres of the bottom circles of columns that stand on their rims, or upright [m].

    Parameters
    ----------
    tilt
        Tilt vectors, shape (…, 2) [rad].
    footprint
        Centres of the circles on the ground about which the contact points lie, shape (…, 2) [m].
    radius
        Base radius [m].
    clearance
        Heights of the lowest points above the ground [m].

    Returns
    -------
    numpy.ndarray
        Shape (…, 3).
    """
    lean = np.asarray(tilt, dtype=float)
    angle = np.hypot(lean[..., 0], lean[..., 1])
    # (1 − cosθ)/θ along the lean, 0 at θ = 0.
    share = np.sin(0.5 * angle) * np.sinc(angle / (2.0 * np.pi))
    along = np.asarray(footprint, dtype=float) + radius * share[..., None] * lean
    return np.concatenate([along, (radius * np.sin(angle) + clearance)[..., None]], axis=-1)
