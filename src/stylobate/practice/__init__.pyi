from .rules import (
    KinematicLimit,
    RuleAnswer,
    asce_rocking,
    asce_sliding,
    fema_contents,
    housner_half_sine,
    housner_velocity,
    ishiyama_velocity,
    italian_mechanism,
    overturning_velocity,
    rules_of_practice,
    west,
)
from .shaking import Shaking

__all__ = [
    "KinematicLimit",
    "RuleAnswer",
    "Shaking",
    "asce_rocking",
    "asce_sliding",
    "fema_contents",
    "housner_half_sine",
    "housner_velocity",
    "ishiyama_velocity",
    "italian_mechanism",
    "overturning_velocity",
    "rules_of_practice",
    "west",
]
