"""What varies between runs: a name for each run from the inputs that differ."""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from stylobate.base_motions.declared import motion_quantities
from stylobate.models.declared import column_quantities, model_quantities
from stylobate.quantities import Quantity
from stylobate.results import Response
from stylobate.run_arguments import run_numbers

_MOST_NAMES = 2
# Inputs that follow from changes of a motion.
_OF_CHANGES = ("motion.digest", "motion.repr")
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
    inputs = [dict(_flat(one)) for one in _with_named_motions([run.provenance for run in runs])]
    names = [name for name in inputs[0] if all(name in one for one in inputs) and not name.startswith(_SILENT)]
    varied = [name for name in names if len({repr(one.get(name)) for one in inputs}) > 1]
    if "motion.changes" in varied:
        varied = [name for name in varied if name not in _OF_CHANGES]
    # Without a duration of its own, a run's duration follows from the other inputs.
    varied = [name for name in varied if name != "duration"] or varied
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


def _with_named_motions(inputs: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the inputs with base motions as their origin and, in words, the changes that not all runs share."""
    motions = [_origin(one.get("motion") or {}) for one in inputs]
    steps = [changes for _, changes in motions]
    shared = 0
    while all(len(one) > shared and one[shared] == steps[0][shared] for one in steps):
        shared += 1
    changed = any(len(one) > shared for one in steps)
    return [
        {**one, "motion": {**origin, "changes": _in_words(origin, changes[shared:]) if changed else ""}}
        for one, (origin, changes) in zip(inputs, motions, strict=True)
    ]


def _origin(motion: Mapping[str, Any]) -> tuple[dict[str, Any], list[Any]]:
    """Return the motion that was changed, and the changes in their order."""
    changes: list[Any] = []
    while "motion" in motion:
        own = {name: value for name, value in motion.items() if name not in ("kind", "motion")}
        changes.insert(0, {"method": motion["kind"], **own})
        motion = motion["motion"]
    origin = {name: value for name, value in motion.items() if name != "processing"}
    return origin, [*motion.get("processing", ()), *changes]


def _in_words(origin: Mapping[str, Any], changes: Sequence[Any]) -> str:
    """Write changes of a motion, such as "0.5 × El Centro 1940" or "rotated by 0.3 rad"."""
    factors = [one for one in changes if isinstance(one, Mapping) and one["method"] == "scaled"]
    words = [_change(one) for one in changes if one not in factors]
    if factors or not words:
        path = origin.get("path") or ""
        file = Path(path if isinstance(path, str) else path[0]).stem
        name = origin.get("record") or str(origin.get("sample") or "").title() or file
        name = name or str(origin.get("kind", "")).replace("_", " ")
        factor = math.prod(one["factor"] for one in factors)
        vertical = math.prod(one["factor"] if one.get("vertical") is None else one["vertical"] for one in factors)
        words.insert(0, f"{factor:.4g} × {name}" if factors else name)
        if vertical != factor:
            words.insert(1, f"vertical {vertical:.4g} ×")
    return ", ".join(words)


def _change(step: Any) -> str:
    """Write a change other than a factor, such as "rotated by 0.3 rad"; records of samples state theirs in words."""
    if not isinstance(step, Mapping):
        return str(step)
    values = {name: value for name, value in step.items() if name != "method" and value is not None}
    written = [_written(f"motion.{name}", value) for name, value in values.items()]
    if len(values) == 1:
        (name,) = values
        written = [f"by {motion_quantities()[name].shown(values[name])}"] if name in motion_quantities() else written
    return " ".join([str(step["method"]).replace("_", " "), ", ".join(written)]).rstrip()


def _written(name: str, value: Any) -> str:
    room, _, last = name.rpartition(".")
    if name == "motion.changes":
        return str(value)
    if last == "kind":
        return str(value).replace("_", " ")
    quantity = _declared(room).get(last)
    label = quantity.symbol if quantity is not None and quantity.symbol else last.replace("_", " ")
    if isinstance(value, list | tuple):
        value = next((one for one in value if one), 0.0) if sum(map(bool, value)) <= 1 else tuple(value)
    number = f"{value:.4g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value)
    unit = "" if quantity is None or not quantity.unit else f" {quantity.unit}"
    return f"{label} {'= ' if quantity is not None and quantity.symbol else ''}{number}{unit}"


def _declared(room: str) -> Mapping[str, Quantity]:
    """Return the declared quantities of a part of the inputs: column, model, motion, or else the run."""
    parts = {"motion": motion_quantities, "column": column_quantities, "model": model_quantities}
    if (read := parts.get(room.partition(".")[0])) is not None:
        return read()
    return {**{name: one.quantity for name, one in run_numbers().items()}, **column_quantities()}
