"""The laboratory: a page on this machine in which one sets column and base motion and sees what becomes of it.

Names are imported when they are first used: the processes that compute need no server.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stylobate.lab.app import create_app
    from stylobate.lab.limits import Limits
    from stylobate.lab.serving import serve

__all__ = ["Limits", "create_app", "serve"]

_HOMES = {"Limits": "limits", "create_app": "app", "serve": "serving"}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"stylobate.lab.{_HOMES[name]}"), name)
    message = f"module 'stylobate.lab' has no attribute {name!r}"
    raise AttributeError(message)
