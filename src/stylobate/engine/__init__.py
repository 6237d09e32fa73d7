"""Integration: single runs with dense output and events, and many runs at once."""

from stylobate.engine.ensemble import simulate_ensemble
from stylobate.engine.parameters import with_parameters
from stylobate.engine.single import simulate

__all__ = ["simulate", "simulate_ensemble", "with_parameters"]
