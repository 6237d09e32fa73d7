"""Equations of motion, one file for each level of the ladder of models."""

from stylobate.models.model import Model, Output, Push
from stylobate.models.slender import Slender
from stylobate.models.slender_rolling import SlenderRolling

__all__ = ["Model", "Output", "Push", "Slender", "SlenderRolling"]
