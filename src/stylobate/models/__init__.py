"""Equations of motion, one file for each level of the ladder of models."""

from stylobate.models.model import Model, Output, Push
from stylobate.models.slender import Slender

__all__ = ["Model", "Output", "Push", "Slender"]
