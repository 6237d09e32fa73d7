"""Free-standing round columns on shaking bases: they stay, rock, roll round their rim, or overturn.

>>> import stylobate as sb
>>> column = sb.Column.dimensionless(slenderness=0.1)
>>> model = sb.Slender(column, damping=0.1)
>>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
>>> steady = sb.theory.steady_rolling(1.8, 0.065, c=0.1, eta=0.1).upper
>>> bool(steady.stable)
True

The public names, imported when they are first used, are those of `__init__.pyi`.
"""

from typing import Any

import lazy_loader

_import_name, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("stylobate")
    if name not in __all__:
        from stylobate.text import did_you_mean

        raise AttributeError(
            f"module {__name__!r} has no attribute {name!r}; {did_you_mean(name, __all__)}".rstrip("; ")
        )
    return _import_name(name)
