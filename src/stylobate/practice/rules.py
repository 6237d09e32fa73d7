"""The rules: what hand formulas and standards say of a free-standing column, each with its clause and source.

Each rule compares a demand of the base motion with a capacity of the column. Several clauses could not be read in
their own text; `RuleAnswer.checked` is False for these. Such a rule is derived here from mechanics, and its constants
are those of secondary sources: check them before you rely on the clause.

The rocking spectrum of N. Makris is not repeated here: `stylobate.earthquakes.rocking_spectrum` computes it.
"""

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from stylobate.base_motions import BaseMotion
from stylobate.column import Column
from stylobate.errors import ParameterError, require_not_negative, require_positive
from stylobate.practice.shaking import PERIODS, Shaking

_ROCKING_ANGLES = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class RuleAnswer:
    """The answer of one rule for a column and a base motion.

    Parameters
    ----------
    rule
        Name of the rule.
    demand, capacity
        The two numbers that the rule compares, in `unit`. The capacity is the number to reach.
    unit
        Their unit.
    clause
        Place of the rule in its source.
    source
        The source.
    assumptions
        Choices and limits of the rule as it is computed here.
    checked
        Whether the clause was compared with the text of its source.
    """

    rule: str
    demand: float
    capacity: float
    unit: str
    clause: str
    source: str
    assumptions: tuple[str, ...] = ()
    checked: bool = False

    @property
    def ratio(self) -> float:
        """Demand over capacity."""
        return self.demand / self.capacity

    @property
    def safe(self) -> bool:
        """Whether the rule calls the column safe: the demand is below the capacity."""
        return self.demand < self.capacity


def overturning_velocity(column: Column) -> float:
    """Compute the sudden horizontal base velocity that just overturns a column at rest [m/s].

    Notes
    -----
    The moment of momentum m h v about the rim becomes K ω, and the energy ½Kω² just lifts the centre of mass over the
    rim, by R − h:

        v = √[2 g K (R − h)/m]/h.

    A slender column has v = c √(g h C_I) with C_I = K/(m h²): at equal shape v grows as the square root of the size,
    and for slender columns as r/√h. Derived here; `tests/test_practice.py` compares it with runs.

    Examples
    --------
    >>> round(overturning_velocity(Column.solid(radius=0.2, height=2.0, density=2700.0)), 3)
    0.733
    """
    lift = column.rim_distance - column.mass_height
    return math.sqrt(2.0 * column.gravity * column.rim_inertia * lift / column.mass) / column.mass_height


def west(column: Column, shaking: Shaking) -> RuleAnswer:
    """Compare the peak acceleration with c g, at which a column starts to rock (West).

    No column overturns below c g without a vertical component. Above it most columns stand: the rule is a bound.
    Exact for rigid bodies; the attribution is that of the literature and was not looked up.
    """
    return RuleAnswer(
        rule="West",
        demand=shaking.peak_acceleration,
        capacity=column.slenderness * column.gravity,
        unit="m/s²",
        clause="a = (b/h) g",
        source="West's formula, as cited by J. Milne (1885)",
        assumptions=("static", "no vertical acceleration"),
    )


def ishiyama_velocity(column: Column, shaking: Shaking) -> RuleAnswer:
    """Compare the peak velocity with 0.4 times the overturning velocity, a lower limit of overturning (Ishiyama).

    For a block the capacity is 0.4 √[(8/3) g R (1 − cos α)/cos²α], about 10 B/√H cm/s with breadth B and height H in
    cm. The factor 0.4 is from memory: of the paper only the summary could be read, which says that acceleration and
    velocity are both criteria.
    """
    return RuleAnswer(
        rule="Ishiyama, velocity",
        demand=shaking.peak_velocity,
        capacity=0.4 * overturning_velocity(column),
        unit="m/s",
        clause="v = 0.4 √[2 g K (R − h)/m]/h",
        source="Y. Ishiyama, Earthquake Engineering and Structural Dynamics 10 (1982)",
        assumptions=("factor 0.4 unchecked", "inertia of the column, not of a block"),
    )


def housner_velocity(column: Column, shaking: Shaking, *, damping: float = 0.05) -> RuleAnswer:
    """Compare the spectral velocity with the overturning velocity, at which half of the columns overturn (Housner).

    Housner's slender form is α = (S_v/√(gR)) √(m R²/K) for a constant velocity spectrum S_v. Here S_v is the mean
    pseudo-velocity from 0.1 s to 2.5 s, his spectrum intensity over 2.4 s. The formula follows from the impulse of
    `overturning_velocity`; that overturning has the probability 50 % there was not compared with the paper.

    Parameters
    ----------
    column, shaking
        Column and base motion.
    damping
        Damping ratio of the spectrum.
    """
    period = np.linspace(0.1, 2.5, 97)
    velocity = shaking.at(period, damping) * period / (2.0 * math.pi)
    return RuleAnswer(
        rule="Housner, velocity spectrum",
        demand=float(np.trapezoid(velocity, period)) / float(np.ptp(period)),
        capacity=overturning_velocity(column),
        unit="m/s",
        clause="α = S_v √(m R/(g K))",
        source="G. W. Housner, Bulletin of the Seismological Society of America 53 (1963)",
        assumptions=(
            f"{100.0 * damping:g} % damping",
            "mean pseudo-velocity, 0.1 s to 2.5 s",
            "even odds at the limit",
        ),
    )


def housner_half_sine(column: Column, *, acceleration: float, angular_frequency: float) -> RuleAnswer:
    """Compare a half-sine pulse with Housner's overturning formula c g √(1 + ω²/p²).

    The formula asks for the unstable balance at the end of the pulse, and is unconservative:
    `stylobate.theory.half_sine_overturning` has the exact threshold of slender columns, 1.80072 in place of 2.23607 at
    ω/p = 2. The formula is from memory.

    Parameters
    ----------
    column
        The column.
    acceleration
        Amplitude of the pulse [m/s²].
    angular_frequency
        ω of the pulse, which lasts π/ω [rad/s].
    """
    ratio = require_positive("angular_frequency", angular_frequency, "rad/s") / column.frequency_parameter
    return RuleAnswer(
        rule="Housner, half sine",
        demand=require_positive("acceleration", acceleration, "m/s²"),
        capacity=column.slenderness * column.gravity * math.hypot(1.0, ratio),
        unit="m/s²",
        clause="a = α g √(1 + ω²/p²)",
        source="G. W. Housner, Bulletin of the Seismological Society of America 53 (1963)",
        assumptions=("slender", "balance reached as the pulse ends: wrong"),
    )


def asce_sliding(column: Column, shaking: Shaking, *, friction: float, clearance: float = math.inf) -> RuleAnswer:
    """Compute the sliding distance of ASCE 43-05, A.1, and compare it with a clearance.

    Parameters
    ----------
    column, shaking
        Column and base motion.
    friction
        Coefficient of sliding friction μ.
    clearance
        Free distance around the column [m].

    Notes
    -----
    μ_e = μ (1 − 0.4 A_V/g), (A-1); c_s = 2 μ_e g, (A-2); δ = c_s/(2π f)², where f is the lowest frequency at which the
    10 % damped horizontal vector spectral acceleration equals c_s. (A-1), (A-2) and the meaning of f were read in a
    scan. δ, (A-3), and the vector combination were illegible: δ is the displacement of an oscillator of frequency f,
    and the maximum over all directions takes the place of the vector.
    """
    effective = require_not_negative("friction", friction) * (1.0 - 0.4 * shaking.peak_vertical / column.gravity)
    strength = 2.0 * max(effective, 0.0) * column.gravity  # c_s
    period = _longest(shaking, 0.1, strength)
    return RuleAnswer(
        rule="ASCE 43-05, sliding",
        demand=strength * (period / (2.0 * math.pi)) ** 2,
        capacity=clearance,
        unit="m",
        clause="A.1, (A-1) to (A-3)",
        source="ASCE/SEI 43-05, appendix A",
        assumptions=(
            "(A-3) unchecked",
            "vector spectrum: maximum over all directions",
            f"periods up to {PERIODS[-1]:g} s",
        ),
    )


def _longest(shaking: Shaking, damping: float, level: float) -> float:
    """Return the longest period at which the spectrum reaches `level` [s], 0 if none does."""
    periods = np.geomspace(PERIODS[0], PERIODS[-1], 4 * PERIODS.size)
    reached = np.flatnonzero(shaking.at(periods, damping) >= level)
    if not reached.size or reached[-1] == periods.size - 1:
        return float(periods[-1]) if reached.size else 0.0
    low, high = periods[reached[-1]], periods[reached[-1] + 1]
    above, below = (float(shaking.at(one, damping)) - level for one in (low, high))
    return float(low * (high / low) ** (above / (above - below)))


def asce_rocking(column: Column, shaking: Shaking, *, vertical_factor: float = 1.0) -> RuleAnswer:
    """Compute the rocking angle in the manner of ASCE 43-05, A.2, and compare it with the tipping angle.

    Parameters
    ----------
    column, shaking
        Column and base motion.
    vertical_factor
        F_V ≥ 1, which reduces the capacity for vertical motion. The standard computes it from the ratio of vertical to
        horizontal spectral acceleration; that formula was illegible, so the factor is an argument.

    Notes
    -----
    With a = r/h, f1 = cos θ + a sin θ and C_I = K/(m h²), the energy of the tilt θ gives the secant oscillator

        SAH_CAP = 2 g (f1 − 1)/(F_V θ),   f_e = √[2 g (f1 − 1)/(C_I h θ²)]/2π,
        C_R = 1 − 2a²/C_I,  γ = −2 ln C_R,  β_e = γ/√(4π² + γ²).

    C_I and C_R are those of the column, 4/3 (1 + a²) for a block. The rocking angle is the largest at which the
    spectral acceleration at f_e and β_e reaches SAH_CAP; a column that reaches it at the tipping angle is unsafe.
    Derived here; of the clause the scheme was read, its formulas were illegible. F_H, which corrects for a lateral mass
    other than the vertical mass, is 1.
    """
    if not vertical_factor >= 1.0:
        raise ParameterError(f"vertical_factor: must be at least 1 (got {vertical_factor!r}). Pass 1 to leave it out.")
    a, h, g = column.slenderness, column.mass_height, column.gravity
    inertia = column.rim_inertia / (column.mass * h * h)  # C_I
    decrement = -2.0 * math.log(max(column.housner_restitution, 1e-9))  # γ
    damping = decrement / math.hypot(2.0 * math.pi, decrement)
    tilt = column.tipping_angle * np.arange(1, _ROCKING_ANGLES + 1) / _ROCKING_ANGLES
    energy = a * np.sin(tilt) - 2.0 * np.sin(0.5 * tilt) ** 2  # f1 − 1
    period = 2.0 * math.pi * tilt * np.sqrt(inertia * h / (2.0 * g * energy))
    reached = np.flatnonzero(shaking.at(period, damping) >= 2.0 * g * energy / (vertical_factor * tilt))
    return RuleAnswer(
        rule="ASCE 43-05, rocking",
        demand=float(tilt[reached[-1]]) if reached.size else 0.0,
        capacity=column.tipping_angle,
        unit="rad",
        clause="A.2",
        source="ASCE/SEI 43-05, appendix A",
        assumptions=("formulas derived by energy", f"F_H = 1, F_V = {vertical_factor:g}: unchecked", "largest angle"),
    )


class KinematicLimit(Enum):
    """Share of the displacement at overturning that the Italian circular allows; from memory, unchecked."""

    LIFE_SAFETY = 0.4
    COLLAPSE = 0.6


def italian_mechanism(
    column: Column,
    shaking: Shaking,
    *,
    limit: KinematicLimit = KinematicLimit.COLLAPSE,
    period_factor: float = 1.0,
) -> RuleAnswer:
    """Compare the spectral displacement at the secant period with a share of the displacement at overturning.

    Parameters
    ----------
    column, shaking
        Column and base motion.
    limit
        Share of the displacement at overturning.
    period_factor
        Factor of the secant period. The circular of 2019 may state periods below the secant one (0.84 and 0.78 of it,
        from memory): pass these once you have checked them.

    Notes
    -----
    Of a rigid column about its rim the centre of mass moves horizontally by d0 = r until it overturns, and the
    capacity falls linearly: a = c g (1 − d/d0). At d = n d0 the secant period is 2π√(d/a) = 2π√[n h/((1 − n) g)],
    independent of the radius; rotational inertia does not enter. Spectra have 5 % damping. Clause and shares n are
    from memory; the mechanics is derived here.
    """
    share = limit.value
    allowed = share * column.radius
    secant = math.sqrt(allowed / (column.slenderness * column.gravity * (1.0 - share)))  # √(d/a)
    period = require_positive("period_factor", period_factor) * 2.0 * math.pi * secant
    return RuleAnswer(
        rule=f"Italian mechanism, {limit.name.lower().replace('_', ' ')}",
        demand=float(shaking.at(period, 0.05)) * (period / (2.0 * math.pi)) ** 2,
        capacity=allowed,
        unit="m",
        clause=f"C8.7.1.2, nonlinear kinematic analysis, {share:g} d0",
        source="Circolare 21 gennaio 2019 n. 7 to the Norme tecniche per le costruzioni 2018",
        assumptions=("shares and period unchecked", "5 % damping", "rotational inertia left out"),
    )


def fema_contents(column: Column, shaking: Shaking) -> RuleAnswer:
    """Compare the peak velocity with the median of FEMA P-58 for unanchored bookcases and filing cabinets.

    The capacity is 2.83 b^1.5/h m/s with depth b = 2r and height h of the body in m, a fit to the nine medians of the
    second edition (E.20.22.102a to 125a), seven of them within 2 %; the dispersion of its lognormal curve is 0.5.
    Sizes and medians were read; the formula is no clause. Mechanics of slender columns scales as b/√h instead. A column
    whose height is unknown has twice the height of its centre of mass.
    """
    height = 2.0 * column.mass_height if column.height is None else column.height
    return RuleAnswer(
        rule="FEMA P-58, contents",
        demand=shaking.peak_velocity,
        capacity=2.83 * (2.0 * column.radius) ** 1.5 / height,
        unit="m/s",
        clause="E.20.22.102a to 125a, peak floor velocity",
        source="FEMA P-58, second edition, as in the SimCenter damage and loss model library",
        assumptions=("fit to nine objects from 0.6 m to 2.1 m", "median, dispersion 0.5"),
        checked=True,
    )


def rules_of_practice(
    column: Column, motion: BaseMotion | Shaking, *, friction: float | None = None
) -> tuple[RuleAnswer, ...]:
    """Apply all rules of overturning to a column under a base motion.

    Parameters
    ----------
    column
        The column.
    motion
        A base motion that ends, or its `Shaking`.
    friction
        Coefficient of friction; with it the answer of ASCE's sliding rule is added, for unlimited clearance.

    Returns
    -------
    tuple of RuleAnswer
        West, Ishiyama, Housner's velocity spectrum, ASCE 43-05 rocking, the Italian mechanism at both limits and
        FEMA P-58.

    Raises
    ------
    ParameterError
        If `motion` is no base motion, or never ends.

    Examples
    --------
    >>> import stylobate as sb
    >>> column = sb.Column.solid(radius=0.2, height=2.0, density=2700.0)
    >>> pulse = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0)
    >>> for answer in rules_of_practice(column, pulse)[:2]:
    ...     print(f"{answer.rule}: {answer.demand:.2f}/{answer.capacity:.2f} {answer.unit}, safe: {answer.safe}")
    West: 3.00/1.96 m/s², safe: False
    Ishiyama, velocity: 1.00/0.29 m/s, safe: False
    """
    shaking = motion if isinstance(motion, Shaking) else Shaking.of(motion)
    overturning = (
        west(column, shaking),
        ishiyama_velocity(column, shaking),
        housner_velocity(column, shaking),
        asce_rocking(column, shaking),
        *(italian_mechanism(column, shaking, limit=limit) for limit in KinematicLimit),
        fema_contents(column, shaking),
    )
    return overturning if friction is None else (*overturning, asce_sliding(column, shaking, friction=friction))
