"""Results of computations, saved and loaded with everything needed to repeat them.

The public names, imported when they are first used, are those of `__init__.pyi`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
