"""Check that the members of a model agree with each other and with its equations."""

from stylobate.models.consistency.check import CheckReport, check, check_once

__all__ = ["CheckReport", "check", "check_once"]
