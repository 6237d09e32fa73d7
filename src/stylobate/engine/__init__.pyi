from .ensemble import simulate_ensemble
from .parameters import with_parameters
from .single import simulate

__all__ = [
    "simulate",
    "simulate_ensemble",
    "with_parameters",
]
