from .ensemble import simulate_ensemble
from .known_orbits import KnownOrbit
from .parameters import with_parameters
from .single import simulate
from .user_events import EventFunction

__all__ = [
    "EventFunction",
    "KnownOrbit",
    "simulate",
    "simulate_ensemble",
    "with_parameters",
]
