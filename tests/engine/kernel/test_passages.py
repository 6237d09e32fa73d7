"""Single runs and ensembles agree on whether a passage of the upright loses energy."""

import numpy as np

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST


def test_both_drivers_agree_on_whether_a_passage_loses_energy(monkeypatch):
    monkeypatch.setenv("STYLOBATE_PLAIN", "1")  # in plain Python the kernel is the same
    model = sb.Wobbling(sb.Column.dimensionless(0.1), restitution=0.5, passage_tilt=0.03)
    # The tilt falls by these parts of its speed, and is least a moment later: 1e-6 and less is a passage just met.
    falling = np.geomspace(1e-8, 1e-3, 6) * 3.0
    starts = {"tilt": (0.02, 0.0), "duration": 0.05}
    rates = [(-0.3 * part, 0.3) for part in falling]
    many = sb.simulate_ensemble(model, BASE_AT_REST, **{**starts, "tilt": [starts["tilt"]] * 6}, tilt_rate=rates)
    one = [sb.simulate(model, BASE_AT_REST, tilt_rate=rate, **starts).data["amplitude"][-1] for rate in rates]
    # A loss changes the tilt at the end by a sixth, the tolerance of a run by about 1e-8 of it.
    np.testing.assert_allclose(one, np.hypot(*many["end_tilt"].values.T), rtol=1e-6)
    assert max(one) > 1.1 * min(one)
