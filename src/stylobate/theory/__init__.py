"""Closed forms of slender and rigid columns: steady motions, their stability, impacts and blocks on vibrating planes.

All quantities are dimensionless as in the equations (1) to (11): angles in rad, the time τ = ω0 t, frequencies in units
of ω0, accelerations in g. θ is the tilt, ν = Ω/ω0 the frequency ratio of the base motion, c = tan α_c the slenderness
with the tipping angle α_c, and η the damping. Arguments are numbers or arrays that broadcast. Numbers give
numbers; arrays give arrays of the broadcast shape, with NaN (False in a truth value) where there is no solution.
"""

from stylobate.liquids import TankLiquid
from stylobate.theory.averaging import AveragedRolling, HighFrequencyRolling, averaged_rolling, high_frequency_rolling
from stylobate.theory.block_motion import BlockPhase, BlockSegment
from stylobate.theory.conveying import BlockCycle, block_cycle, hopping_speed, mean_block_speed
from stylobate.theory.finite_tilt import FiniteTiltRolling, full_rolling
from stylobate.theory.free_motion import FreeMotion, angle_of_turn, free_motion, required_friction
from stylobate.theory.free_twist import (
    FreeTwistRolling,
    RollingFriction,
    free_twist_critical_frequency,
    free_twist_rolling,
    free_twist_upper_frequency,
    rolling_required_friction,
)
from stylobate.theory.impact import (
    block_restitution,
    equivalent_viscous_damping,
    half_sine_overturning,
    housner_restitution,
    one_sine_overturning_after_impact,
    one_sine_overturning_without_impact,
)
from stylobate.theory.lyapunov import first_lyapunov_coefficient
from stylobate.theory.modulated import ModulatedRolling, modulated_rolling
from stylobate.theory.planar import (
    PlanarForcedResponse,
    PlanarOrbit,
    planar_backbone,
    planar_forced_response,
    planar_free_motion,
    planar_free_period,
)
from stylobate.theory.rigid_body import FreeRolling, free_rolling, free_rolling_spin
from stylobate.theory.rolling import (
    RollingBranch,
    SteadyRolling,
    critical_amplitude,
    critical_frequency,
    crossing_frequency,
    rolling_backbone,
    rolling_gap,
    steady_rolling,
    undamped_critical_frequency,
)
from stylobate.theory.sliding_block import HorizontalSliding, SlidingRegime, horizontal_sliding, sliding_amplitude
from stylobate.theory.slipping_rolling import SlippingRolling, slipping_rolling
from stylobate.theory.starting import (
    FirstMotion,
    StartOfMotion,
    bounce_time,
    first_motion,
    flight_throw_number,
    start_of_motion,
    throw_number,
)
from stylobate.theory.wobbling import wobbling_rolling

__all__ = [
    "AveragedRolling",
    "BlockCycle",
    "BlockPhase",
    "BlockSegment",
    "FiniteTiltRolling",
    "FirstMotion",
    "FreeMotion",
    "FreeRolling",
    "FreeTwistRolling",
    "HighFrequencyRolling",
    "HorizontalSliding",
    "ModulatedRolling",
    "PlanarForcedResponse",
    "PlanarOrbit",
    "RollingBranch",
    "RollingFriction",
    "SlidingRegime",
    "SlippingRolling",
    "StartOfMotion",
    "SteadyRolling",
    "TankLiquid",
    "angle_of_turn",
    "averaged_rolling",
    "block_cycle",
    "block_restitution",
    "bounce_time",
    "critical_amplitude",
    "critical_frequency",
    "crossing_frequency",
    "equivalent_viscous_damping",
    "first_lyapunov_coefficient",
    "first_motion",
    "flight_throw_number",
    "free_motion",
    "free_rolling",
    "free_rolling_spin",
    "free_twist_critical_frequency",
    "free_twist_rolling",
    "free_twist_upper_frequency",
    "full_rolling",
    "half_sine_overturning",
    "high_frequency_rolling",
    "hopping_speed",
    "horizontal_sliding",
    "housner_restitution",
    "mean_block_speed",
    "modulated_rolling",
    "one_sine_overturning_after_impact",
    "one_sine_overturning_without_impact",
    "planar_backbone",
    "planar_forced_response",
    "planar_free_motion",
    "planar_free_period",
    "required_friction",
    "rolling_backbone",
    "rolling_gap",
    "rolling_required_friction",
    "sliding_amplitude",
    "slipping_rolling",
    "start_of_motion",
    "steady_rolling",
    "throw_number",
    "undamped_critical_frequency",
    "wobbling_rolling",
]
