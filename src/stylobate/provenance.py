"""Provenance of runs: column, model, base motion and arguments as plain values, from which a run is repeated.

The values are those of the objects' own declared numbers; `stylobate.config` reads them again, as it reads files.
"""

from collections.abc import Callable, Mapping
from dataclasses import asdict
from enum import Enum
from functools import cache
from typing import Any

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.declared import MOTIONS
from stylobate.column import Column
from stylobate.errors import UnsupportedError
from stylobate.models import Model
from stylobate.models.declared import MODELS
from stylobate.quantities import exact_repr, is_declared, parameters_of


def provenance_of_run(model: Model, motion: BaseMotion, **options: Any) -> dict[str, Any]:
    """Return the provenance of a run as plain values: version, column, model, motion and the arguments `options`.

    Of a model or a base motion that no description can repeat, it has the `repr`.
    """
    return {
        "version": _version(),
        "column": values_of_column(model.column),
        "model": _or_other(values_of_model, model),
        "motion": _or_other(values_of_motion, motion),
        **{name: list(value) if isinstance(value, tuple) else value for name, value in options.items()},
    }


def values_of_column(column: Column) -> dict[str, Any]:
    """Return a column by its mass and inertia, with its profile if it has one."""
    own = column.profile
    profile = {} if own is None else {"profile": _plain(asdict(own))}
    return {"shape": "given", **_plain({name: getattr(column, name) for name in parameters_of(Column)}), **profile}


def values_of_model(model: Model) -> dict[str, Any]:
    """Return a model without its column.

    Raises
    ------
    UnsupportedError
        If the model is of a class that cannot be loaded from its place, or has numbers that are not declared.
    """
    make = type(model)
    kind = MODELS.name_of(make)
    if kind and is_declared(make, "column"):
        return {"kind": kind, **_plain({name: getattr(model, name) for name in parameters_of(make)})}
    raise UnsupportedError(f"a model of class {make.__name__} has no description; results keep its repr only")


def values_of_motion(motion: BaseMotion) -> dict[str, Any]:
    """Return a base motion: its kind, and the arguments of its class or constructor.

    Raises
    ------
    UnsupportedError
        If the motion is of a class that cannot be loaded from its place, has numbers that are not declared, or is a
        record that was made from samples.
    """
    if isinstance(motion, Record):
        return _values_of_record(motion)
    own = "made_by" not in vars(type(motion))  # a subclass is another motion
    make, arguments = BaseMotion.made_by(motion) if own else motion.made_by()
    kind = MOTIONS.name_of(make)
    if own and is_declared(make, "motion") and hasattr(motion, "motion"):
        arguments = {"motion": motion.motion, **arguments}
    if not kind or (kind not in MOTIONS and not is_declared(make, *arguments)):
        raise UnsupportedError(
            f"a motion of class {type(motion).__name__} has no description; results keep its repr only"
        )
    defaults = {name: one.default for name, one in parameters_of(make).items() if not one.required}
    return {"kind": kind, **_plain({**defaults, **arguments})}


def _values_of_record(record: Record) -> dict[str, Any]:
    if record.origin is None:
        raise UnsupportedError(f"the record {record.name!r} was not read from files; results keep its repr only")
    reading = {name: value for name, value in record.origin.reading.items() if name != "kind"}
    return {"kind": "record", **_plain({**reading, "processing": record.origin.processing})}


def _plain(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values that JSON and TOML have: lists for tuples, the values of enumerations, and nothing for None."""
    return {str(name): _plain_value(value) for name, value in values.items() if value is not None}


def _plain_value(value: Any) -> Any:
    if isinstance(value, BaseMotion):
        return values_of_motion(value)
    if isinstance(value, Mapping):
        return _plain(value)
    if isinstance(value, list | tuple):
        return [_plain_value(one) for one in value]
    return value.value if isinstance(value, Enum) else value


def _or_other(describe: Callable[[Any], dict[str, Any]], thing: object) -> dict[str, Any]:
    try:
        return describe(thing)
    except UnsupportedError:
        return {"kind": "other", "repr": exact_repr(thing), **_identity_of_record(thing)}


def _identity_of_record(thing: object) -> dict[str, Any]:
    """Return name, digest and processing of a record that was made from samples."""
    if not isinstance(thing, Record):
        return {}
    return {"record": thing.name, "digest": thing.digest, "processing": list(thing.provenance)}


@cache
def _version() -> str:
    from importlib.metadata import version

    return version("stylobate")
