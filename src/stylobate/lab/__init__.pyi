from .app import create_app
from .limits import Limits
from .serving import serve

__all__ = [
    "Limits",
    "create_app",
    "serve",
]
