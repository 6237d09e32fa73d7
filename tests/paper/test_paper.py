"""The check of the source paper confirms every claim it makes, and its verdicts can fail."""

import numpy as np
import pytest

from stylobate import theory
from stylobate.paper.analyses import circular, free, modulated, planar, straight, twist
from stylobate.results.findings import ClaimStatus


@pytest.mark.parametrize(
    "check", [free.check_free, circular.check_circular, free.check_standing, planar.check_planar, twist.check_twist]
)
def test_every_finding_is_confirmed(check):
    section = check()
    assert section.findings
    assert [f for f in section.findings if f.verdict is ClaimStatus.NOT_CONFIRMED] == []


@pytest.mark.slow
@pytest.mark.parametrize("check", [straight.check_straight, modulated.check_modulated])
def test_every_slow_finding_is_confirmed(check):
    assert [f for f in check().findings if f.verdict is ClaimStatus.NOT_CONFIRMED] == []


def test_a_wrong_theory_is_not_confirmed(monkeypatch):
    monkeypatch.setattr(theory, "undamped_critical_frequency", lambda a0, *, c: np.asarray(a0) + c)
    assert circular._undamped_limit().verdict is ClaimStatus.NOT_CONFIRMED


@pytest.mark.parametrize("finding", [twist._stability, twist._weak_damping, twist._upper_frequency])
def test_boundaries_of_another_column_with_a_free_twist_are_not_confirmed(monkeypatch, finding):
    for name in ("free_twist_critical_frequency", "free_twist_upper_frequency"):
        right = getattr(theory, name)
        monkeypatch.setattr(theory, name, lambda a0, right=right, **column: 0.9 * right(a0, **column))
    assert finding().verdict is ClaimStatus.NOT_CONFIRMED


@pytest.fixture(scope="module")
def response():
    return circular.response_data()


def test_curves_of_figure_2_lie_on_their_sides_of_the_backbone(response):
    lower, upper = response["amplitude"].sel(branch="lower"), response["amplitude"].sel(branch="upper")
    assert bool(((lower < response["backbone"]) | lower.isnull()).all())
    assert bool(((upper > response["backbone"]) | upper.isnull()).all())


def test_stable_parts_of_figure_2_begin_at_the_critical_frequencies(response):
    spacing = float(np.diff(response["nu"])[0])
    for a0 in circular.CIRCULAR_AMPLITUDES:
        stable = response["stable"].sel(a0=a0, branch="upper")
        first = float(response["nu"][int(np.argmax(stable.to_numpy()))])
        assert abs(first - float(theory.critical_frequency(a0, c=0.1, eta=0.1))) <= spacing
        assert not bool(response["stable"].sel(a0=a0, branch="lower").any())


def test_curves_of_the_critical_frequency_meet_in_their_limits():
    data = twist.boundary_data()
    least = float(data["eta"][0])
    # Proportional to η there, by a factor below 20 (ζ = 1) and to 1/ζ for smaller ones.
    weak = data["by_damping"].isel(eta=0).sel(zeta=[1.0, 0.3, 0.1, 0.03])
    assert bool((abs(weak - data.attrs["weak_limit"]) < 20.0 * least / weak["zeta"]).all())
    strong = data["by_spin_damping"].isel(spin_damping=-1)
    assert bool((abs(strong - data.attrs["without"]) < 0.2 / float(data["spin_damping"][-1])).all())
    rising = data["by_amplitude"].diff("a0")
    assert bool(((rising > 0.0) | rising.isnull()).all())


def test_the_averaged_solution_fails_where_its_amplitude_is_large():
    # Averaged stable at ν = 1.5 and 2 for a1 = 0.13; the full motion started on it overturns.
    for nu in (1.5, 2.0):
        assert bool(theory.averaged_rolling(nu, 0.13, c=0.1, eta=0.1).forward.upper.stable)
        assert straight._from_averaged(nu, 0.13, 60).outcome.name == "OVERTURNED"


def test_the_sideways_kick_follows_the_logarithmic_law():
    kicks = planar.kick_data()
    slope = np.polyfit(np.log(kicks["offset"]), kicks["kick"], 1)[0]
    # Over the window of 4e-3 in τ the offset itself changes by parts of c/v × 4e-3, half a per cent.
    assert slope == pytest.approx(kicks.attrs["slope"], rel=1e-2)
