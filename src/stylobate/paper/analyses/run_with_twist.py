"""Runs of columns with free spin from the paper's solution without spin."""

import math

import numpy as np

from stylobate import theory
from stylobate.base_motions import Harmonic
from stylobate.column import Column
from stylobate.engine import simulate
from stylobate.models import Rolling, SlenderRolling
from stylobate.paper.analyses.setting import CIRCULAR_AMPLITUDES, DAMPING, SLENDERNESS
from stylobate.results import Response

A0, NU = CIRCULAR_AMPLITUDES[1], 3.0
"""a0 and ν of these runs."""

PERIODS = 300
"""Length of a run with damping: the slowest deviation decays by exp(−0.0254 τ), 1e-7 over these periods."""

GONE = 0.01
"""Tilt that counts as zero [c]."""

_PERIODS_WITHOUT = 15


def run_from_paper(kind: type[Rolling | SlenderRolling], zeta: float, periods: float = PERIODS) -> Response:
    """Integrate a column with free spin from the paper's solution (8) without spin."""
    motion = Harmonic.circular(acceleration=A0, angular_frequency=NU)
    model = kind(Column.dimensionless(SLENDERNESS), damping=DAMPING, spin_damping=zeta)
    branch = theory.steady_rolling(NU, A0, c=SLENDERNESS, eta=DAMPING).upper
    size, psi = float(branch.amplitude), float(branch.phase)
    x, y = size * math.cos(psi), size * math.sin(psi)
    rate = (-NU * y, NU * x)
    return simulate(model, motion, tilt=(x, y), tilt_rate=rate, duration=periods * motion.period, rest_energy=0.0)


def end_of_rolling(kind: type[Rolling | SlenderRolling]) -> tuple[float, float]:
    """Return τ and σ at which the tilt has decayed without spin damping; NaN if it remains."""
    run = run_from_paper(kind, 0.0, _PERIODS_WITHOUT)
    tilt = np.hypot(*run.data["tilt"].to_numpy().T)
    fallen = np.flatnonzero(tilt < GONE * SLENDERNESS)
    if not fallen.size:
        return math.nan, math.nan
    return float(run.data["time"][fallen[0]]), float(run.data["spin"][fallen[0]])
