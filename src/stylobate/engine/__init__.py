"""Integration: single runs with dense output and events."""

from stylobate.engine.single import simulate

__all__ = ["simulate"]
