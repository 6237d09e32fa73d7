"""Animations: the motion of a column as numbers, GIF, MP4 or self-contained web page.

`__init__.pyi` lists the public names, which are imported on first use: numbers need no imaging library.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
