"""Integration: single runs with dense output and events, and many runs at once.

`__init__.pyi` lists the public names; they are imported at their first use.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
