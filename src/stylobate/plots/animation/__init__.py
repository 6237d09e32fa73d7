"""Pictures that move: the motion of a column as numbers, as GIF, as MP4, and as a page of its own.

The public names, imported when they are first used, are those of `__init__.pyi`: numbers need no pictures.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
