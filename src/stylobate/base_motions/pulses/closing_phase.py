"""Phase of a sinusoidal pulse of several cycles without residual displacement."""

import math

_HALVINGS = 60


def closing_phase(cycles: int) -> float:
    """Compute φ [rad] of the pulse Cₙ, n = `cycles`: its displacement ends with 0.

    Notes
    -----
    cos[(2n + 1)π − φ] + [(2n + 1)π − 2φ] sin φ − cos φ = 0, that is [(n + ½)π − φ] tan φ = 1; the left side grows
    from 0 to beyond 1 between 0 and π/4. N. Makris, "Rigidity–plasticity–viscosity: can electrorheological dampers
    protect base-isolated structures from near-source ground motions?", Earthquake Engineering and Structural Dynamics
    26 (1997).
    """
    low, high = 0.0, 0.25 * math.pi
    for _ in range(_HALVINGS):
        phase = 0.5 * (low + high)
        if ((cycles + 0.5) * math.pi - phase) * math.tan(phase) < 1.0:
            low = phase
        else:
            high = phase
    return 0.5 * (low + high)
