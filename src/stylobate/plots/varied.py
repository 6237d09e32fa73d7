"""What varies between runs: a name for each run from the inputs that differ."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from stylobate.base_motions.declared import motion_quantities
from stylobate.models.declared import column_quantities, model_quantities
from stylobate.results import Response

_MOST_NAMES = 2
# Inputs that follow from others, or that no reader would name a run by.
_SILENT = (
    "version",
    "column.transverse_inertia",
    "column.axial_inertia",
    "column.mass",
    "rules",
    "recheck",
    "samples",
    "atol",
)


def what_varies(runs: Sequence[Response]) -> list[str]:
    """Return a name for each of several runs: the values of up to two inputs that differ; else the outcome.

    Inputs are compared as the provenance of the runs states them.
    """
    outcomes = [run.outcome.label for run in runs]
    inputs = [dict(_flat(run.provenance)) for run in runs]
    names = [name for name in inputs[0] if all(name in one for one in inputs) and not name.startswith(_SILENT)]
    varied = [name for name in names if len({repr(one.get(name)) for one in inputs}) > 1]
    if any(name.startswith("column.") for name in varied):
        sizes = [run.data.attrs["slenderness"] for run in runs]
        own = [name for name in varied if not name.startswith("column.")]
        if len(set(sizes)) > 1:
            for one, c in zip(inputs, sizes, strict=True):
                one["slenderness"] = float(c)
            varied = ["slenderness", *own]
    # What decides differs between all runs; of two such inputs, the first stated is the cause.
    varied.sort(key=lambda name: -len({repr(one.get(name)) for one in inputs}))
    shown = varied[:_MOST_NAMES]
    texts = [", ".join(_written(name, one.get(name)) for name in shown if one.get(name) is not None) for one in inputs]
    return [text or outcome for text, outcome in zip(texts, outcomes, strict=True)] if shown else outcomes


def _flat(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def _written(name: str, value: Any) -> str:
    last = name.rpartition(".")[2]
    if last == "kind":
        return str(value).replace("_", " ")
    declared = {**motion_quantities(), **column_quantities(), **model_quantities()}
    quantity = declared.get(last)
    label = quantity.symbol if quantity is not None and quantity.symbol else last.replace("_", " ")
    if isinstance(value, list | tuple):
        value = next((one for one in value if one), 0.0) if sum(map(bool, value)) <= 1 else [*value]
    number = f"{value:.4g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value)
    unit = "" if quantity is None or not quantity.unit else f" {quantity.unit}"
    return f"{label} {'= ' if quantity is not None and quantity.symbol else ''}{number}{unit}"
