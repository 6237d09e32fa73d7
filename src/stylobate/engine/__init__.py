"""Integration: single runs with dense output and events."""

from stylobate.engine.single import simulate
from stylobate.engine.verdict import OutcomeRules

__all__ = ["OutcomeRules", "simulate"]
