"""Free-standing round columns on shaking bases: they stay, rock, roll round their rim, or overturn.

>>> import stylobate as sb
>>> column = sb.Column.dimensionless(slenderness=0.1)
>>> model = sb.Slender(column, damping=0.1)
>>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
>>> steady = sb.theory.steady_rolling(1.8, 0.065, c=0.1, eta=0.1).upper
>>> bool(steady.stable)
True

Public names are imported when they are first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stylobate import errors, motions, orbits, plots, results, spec, studies, theory
    from stylobate.column import Column
    from stylobate.engine import simulate, simulate_ensemble, with_parameters
    from stylobate.errors import Interrupted, Outcome
    from stylobate.models import Contact, Model, PlanarRocking, Rolling, Slender, SlenderRolling, Sliding, Wobbling
    from stylobate.motions import BaseMotion, Harmonic, OneOf, Pulse, Record, Sweep, records
    from stylobate.motions.records import read_record, read_records, sample_record
    from stylobate.plots import animate, plot
    from stylobate.quantities import Quantity
    from stylobate.results import Event, OutcomeRules, Response, load

__all__ = [
    "BaseMotion",
    "Column",
    "Contact",
    "Event",
    "Harmonic",
    "Interrupted",
    "Model",
    "OneOf",
    "Outcome",
    "OutcomeRules",
    "PlanarRocking",
    "Pulse",
    "Quantity",
    "Record",
    "Response",
    "Rolling",
    "Slender",
    "SlenderRolling",
    "Sliding",
    "Sweep",
    "Wobbling",
    "__version__",
    "animate",
    "errors",
    "load",
    "motions",
    "orbits",
    "plot",
    "plots",
    "read_record",
    "read_records",
    "records",
    "results",
    "sample_record",
    "simulate",
    "simulate_ensemble",
    "spec",
    "studies",
    "theory",
    "with_parameters",
]

_HOMES = {
    "BaseMotion": "motions",
    "Column": "column",
    "Contact": "models",
    "Event": "results",
    "Harmonic": "motions",
    "Interrupted": "errors",
    "Model": "models",
    "Outcome": "errors",
    "OutcomeRules": "results",
    "PlanarRocking": "models",
    "OneOf": "motions",
    "Pulse": "motions",
    "Quantity": "quantities",
    "Record": "motions",
    "Response": "results",
    "Rolling": "models",
    "Slender": "models",
    "SlenderRolling": "models",
    "Sliding": "models",
    "Sweep": "motions",
    "Wobbling": "models",
    "animate": "plots",
    "load": "results",
    "plot": "plots",
    "read_record": "motions.records",
    "read_records": "motions.records",
    "records": "motions",
    "sample_record": "motions.records",
    "simulate": "engine",
    "simulate_ensemble": "engine",
    "with_parameters": "engine",
}
_MODULES = ("errors", "motions", "orbits", "plots", "results", "spec", "studies", "theory")


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"stylobate.{_HOMES[name]}"), name)
    if name in _MODULES:
        return import_module(f"stylobate.{name}")
    if name == "__version__":
        from importlib.metadata import version  # noqa: PLC0415

        return version("stylobate")
    message = f"module 'stylobate' has no attribute {name!r}"
    raise AttributeError(message)


def __dir__() -> list[str]:
    return sorted(__all__)
