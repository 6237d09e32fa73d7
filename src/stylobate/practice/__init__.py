"""Rules of practice: what hand formulas and standards say of a free-standing column under a base motion.

The rules do not simulate; `stylobate.earthquakes.compare_rules` counts how often simulations contradict them.
`__init__.pyi` lists the public names; each is imported at its first use.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
