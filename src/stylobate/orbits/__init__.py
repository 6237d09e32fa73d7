"""Exact periodic orbits: shooting, continuation over parameters, and bifurcations.

The public names, imported when they are first used, are those of `__init__.pyi`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
