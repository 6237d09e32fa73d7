"""Tanh–sinh quadrature over a quarter turn, for integrands with thin boundary layers.

The nodes approach both ends double-exponentially, so a layer of width 1e-10 needs no more points than a smooth
integrand. For double precision, sine and cosine are formed from the distance to the end at which they vanish.
"""

import numpy as np


def quarter_turn(*, step: float = 1.0 / 24.0, reach: float = 3.6) -> list[tuple[float, float, float]]:
    """Return nodes and weights of tanh–sinh quadrature over (0, π/2).

    Parameters
    ----------
    step
        Step in the double-exponential variable; halving it squares the error. The default leaves 1e-12.
    reach
        Largest double-exponential variable: at 3.6 the nearest node is 1e-25 from the end.

    Returns
    -------
    list of tuple
        sin φ, cos φ and the weight for each node φ, such that the integral of f is the sum of weight · f.

    References
    ----------
    H. Takahasi and M. Mori, Double exponential formulas for numerical integration, Publ. RIMS 9 (1974) 721-741.

    Examples
    --------
    >>> print(round(sum(weight * sine for sine, cosine, weight in quarter_turn()), 12))
    1.0
    """
    count = round(reach / step)
    t = step * np.arange(-count, count + 1)
    stretch = np.pi * np.sinh(t)
    sine = np.sin(0.5 * np.pi / (1.0 + np.exp(-stretch)))
    cosine = np.sin(0.5 * np.pi / (1.0 + np.exp(stretch)))
    weight = step * 0.125 * np.pi**2 * np.cosh(t) / np.cosh(0.5 * stretch) ** 2
    return list(zip(sine.tolist(), cosine.tolist(), weight.tolist(), strict=True))
