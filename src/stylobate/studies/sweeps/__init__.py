"""Sweeps: one description of many runs, divided into chunks, computed locally or on a cluster, stored and resumed.

The public names, imported when they are first used, are those of `__init__.pyi`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
