"""Standing column: conclusions 1 and 2, uplift and the centre of pressure."""

import math

import numpy as np
import xarray as xr

from stylobate.base_motions import Harmonic
from stylobate.engine import simulate
from stylobate.errors import Outcome
from stylobate.paper.analyses.setting import SLENDERNESS, judged, paper_model
from stylobate.results import ClaimStatus, Finding, Section

_C = SLENDERNESS


def check_standing() -> Section:
    """Check the paper's statements on a column that starts at rest or from other initial conditions."""
    return Section((_sign_of_forces(), _stays(), _overturns()), {"pressure": pressure_data()})


def pressure_data() -> xr.Dataset:
    """Compute the path of the centre of pressure of a standing column for several base motions."""
    motions = {
        "circle, a0 = 0.5c": Harmonic.circular(acceleration=0.5 * _C, angular_frequency=2.0),
        "circle, a0 = c": Harmonic.circular(acceleration=_C, angular_frequency=2.0),
        "line, a1 = 0.8c": Harmonic.straight(acceleration=0.8 * _C, angular_frequency=2.0, direction=0.4),
        "ellipse, 0.7c by 0.5c": Harmonic.elliptic(amplitude=(0.7 * _C, 0.5 * _C), phase=1.0, angular_frequency=2.0),
    }
    model = paper_model()
    runs = [simulate(model, motion, duration=motion.period, samples=241) for motion in motions.values()]
    path = np.stack([run.data["centre_of_pressure"] for run in runs]) / model.column.radius
    return xr.Dataset(
        {"path": (("motion", "time", "axis"), path)}, coords={"motion": list(motions), "axis": ["x", "y"]}
    )


def _sign_of_forces() -> Finding:
    push = Harmonic.straight(acceleration=1.2 * _C, angular_frequency=0.1)
    run = simulate(paper_model(), push, duration=0.5)
    lean = float(run.data["tilt"].sel(axis="x")[-1])
    return Finding(
        "before (1)",
        "The generalised forces are +m Q0i √(h² + r²) cos(γ − αi) cos θ0t (in the paper's letters).",
        "In the frame of the base the force is −m times its acceleration, as in the paper's own (1), with arm h in the "
        f"small-angle model. With the sign of (1) a base that accelerates along +x at 1.2c makes the column lean to "
        f"{lean:+.4f} rad, against the acceleration, as it must. The results of the paper rest on (1), which is right.",
        judged(lean < 0.0, ClaimStatus.ERRATUM),
    )


def _stays() -> Finding:
    model = paper_model()
    count, moved = 0, 0
    for nu in (0.3, 1.0, 1.4, 3.0, 10.0):
        for share in (0.2, 0.9, 1.0):
            for motion in (
                Harmonic.circular(acceleration=share * _C, angular_frequency=nu, start_phase=0.7),
                Harmonic.straight(acceleration=share * _C, angular_frequency=nu, direction=0.4),
            ):
                run = simulate(model, motion, duration=50.0)
                count += 1
                moved += int(run.outcome is not Outcome.AT_REST or bool(np.any(run.data["tilt"])))
    above = Harmonic.straight(acceleration=1.001 * _C, angular_frequency=1.0, start_phase=-1.0)
    release = simulate(model, above, duration=5.0).events[0].time
    expected = 1.0 - math.acos(1.0 / 1.001)
    return Finding(
        "conclusion 1",
        "With a0 < c or a1 < c and from rest the column never moves; only the pressure under it shifts.",
        f"{count} runs with amplitudes up to c itself: {moved} moved. At 1.001c it uplifts, within "
        f"{abs(release - expected):.0e} of the instant at which |a| = c. The centre of pressure runs at the distance "
        "h|a|/g from the axis and reaches the rim at |a| = c.",
        judged(moved == 0 and abs(release - expected) < 1e-9),  # noqa: PLR2004  the root finder's tolerance
    )


def _overturns() -> Finding:
    model = paper_model()
    weak = Harmonic.circular(acceleration=0.2 * _C, angular_frequency=1.0)
    strong = Harmonic.circular(acceleration=1.5 * _C, angular_frequency=1.0)
    pushed = simulate(model, weak, tilt=(0.9 * _C, 0.0), tilt_rate=(0.05 * _C, 0.0), duration=100.0)
    shaken = simulate(model, strong, duration=100.0)
    fell = [run.outcome is Outcome.OVERTURNED for run in (pushed, shaken)]
    return Finding(
        "conclusion 2",
        "From other initial states, or for a > c, the column can overturn.",
        f"a0 = 0.2c from a tilt of 0.9c: overturned at τ = {pushed.decided_at:.2f}; a0 = 1.5c from rest: at "
        f"τ = {shaken.decided_at:.2f}. Both proved by the criterion θ > c + sup|a|, θ̇ ≥ 0.",
        judged(all(fell)),
    )
