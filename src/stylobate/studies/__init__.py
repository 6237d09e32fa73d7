"""Studies of many runs: maps and basins, responses and their stability, model hierarchies, sweeps.

`__init__.pyi` lists the public names, which are imported on first use.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

GRIDS = ("overturning_map", "basins")
"""Names of the studies whose result is a grid of classes: jobs of the laboratory, and tabs of its page."""
