from .ensemble import simulate_ensemble
from .parameters import with_parameters
from .single import simulate
from .trajectory import EventFunction

__all__ = [
    "EventFunction",
    "simulate",
    "simulate_ensemble",
    "with_parameters",
]
