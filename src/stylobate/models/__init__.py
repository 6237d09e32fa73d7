"""Equations of motion, one file for each model of the hierarchy."""

from stylobate.models.consistency import CheckReport, check
from stylobate.models.model import Balance, Model, Output, Push
from stylobate.models.planar_rocking import PlanarRocking
from stylobate.models.rolling import Rolling
from stylobate.models.slender import Slender
from stylobate.models.slender_rolling import SlenderRolling
from stylobate.models.sliding import Contact, Sliding
from stylobate.models.wobbling import Wobbling

__all__ = [
    "Balance",
    "CheckReport",
    "Contact",
    "Model",
    "Output",
    "PlanarRocking",
    "Push",
    "Rolling",
    "Slender",
    "SlenderRolling",
    "Sliding",
    "Wobbling",
    "check",
]
