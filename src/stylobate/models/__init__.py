"""Equations of motion, one file for each model of the hierarchy."""

from stylobate.models.consistency import check
from stylobate.models.model import Balance, Model, Output
from stylobate.models.planar_rocking import PlanarRocking
from stylobate.models.rolling import Rolling
from stylobate.models.slender import Slender
from stylobate.models.slender_rolling import SlenderRolling
from stylobate.models.sliding import Contact, Sliding
from stylobate.models.wobbling import Wobbling

__all__ = [
    "Balance",
    "Contact",
    "Model",
    "Output",
    "PlanarRocking",
    "Rolling",
    "Slender",
    "SlenderRolling",
    "Sliding",
    "Wobbling",
    "check",
]
