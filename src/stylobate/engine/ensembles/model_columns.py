"""Columns of the table of a batch that describe the models of the runs.

Models whose numbers differ from run to run are evaluated at once: their properties compute with arrays in place of
numbers. A run whose numbers are refused or questioned, and a user's model that computes otherwise, has its own object.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.engine.cost import LOG
from stylobate.engine.ensembles.beginnings import Body
from stylobate.engine.parameters import COLUMN_NAMES, changed_model, split
from stylobate.models import Model
from stylobate.models.model import owner_of
from stylobate.quantities import Declared, parameters_of, unchecked

Floats = npt.NDArray[np.float64]
Arrays = npt.NDArray[Any]
Runs = slice | npt.NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class RunModels:
    """The models of `count` runs: one model with its numbers `values` that differ between the runs, shape (count,)."""

    model: Model
    values: Mapping[str, Floats]
    count: int
    _made: dict[object, Any] = field(default_factory=dict, repr=False, compare=False)
    """Objects that were made, by their runs, and the model whose numbers are arrays."""

    def of(self, runs: npt.NDArray[np.intp]) -> "RunModels":
        """Return the models of these runs."""
        return RunModels(self.model, {name: values[runs] for name, values in self.values.items()}, len(runs))

    def each(self) -> list[tuple[Model, Runs]]:
        """Return the distinct models, each with its runs.

        Raises
        ------
        ParameterError
            If a value is out of range.
        """
        if not self.values or self.count == 0:
            return [(self.model, slice(None))]
        return self._objects(np.arange(self.count))

    def _objects(self, runs: npt.NDArray[np.intp]) -> list[tuple[Model, Runs]]:
        key = runs.tobytes()
        if key not in self._made:
            self._made[key] = self._new_objects(runs)
        objects: list[tuple[Model, Runs]] = self._made[key]
        return objects

    def _new_objects(self, runs: npt.NDArray[np.intp]) -> list[tuple[Model, Runs]]:
        table = np.stack([values[runs] for values in self.values.values()], axis=1)
        kinds, which = np.unique(table, axis=0, return_inverse=True)
        order = np.argsort(which.ravel(), kind="stable")
        parts = np.split(runs[order], np.cumsum(np.bincount(which.ravel(), minlength=len(kinds)))[:-1])
        return [
            (changed_model(self.model, dict(zip(self.values, kind.tolist(), strict=True))), part)
            for kind, part in zip(kinds, parts, strict=True)
        ]

    def evaluate(self, numbers: Callable[[Model, Runs], Mapping[str, Arrays]]) -> dict[str, Arrays]:
        """Return `numbers` of the model of each run as arrays whose first axis is the runs.

        Parameters
        ----------
        numbers
            Function of a model, whose numbers may be arrays over its runs, and of these runs; it returns arrays over
            the runs.

        Raises
        ------
        ParameterError
            If a value is out of range.
        """
        together = self._together(numbers) if self.values and self.count > _FEWEST else None
        if together is None:
            if self.values and self.count > _MANY:
                _report_objects(type(self.model))
            return _assembled(self.count, [(numbers(model, runs), runs) for model, runs in self.each()])
        found, alone = together
        if not alone.size:
            return _assembled(self.count, [(found, slice(None))])
        objects = ((numbers(model, runs), runs) for model, runs in self._objects(alone))
        return _assembled(self.count, [(found, slice(None)), *objects])

    def _together(
        self, numbers: Callable[[Model, Runs], Mapping[str, Arrays]]
    ) -> tuple[Mapping[str, Arrays], npt.NDArray[np.intp]] | None:
        """Return the numbers of all runs, evaluated at once, and the runs that need objects; None if they cannot be.

        A few runs are compared with their objects, which is decisive for a user's model.
        """
        if not _checks_by_declaration(type(self.model)):
            return None
        try:
            with np.errstate(all="ignore"):
                model, plain = self._of_arrays()
                found = numbers(model, slice(None))
        except Exception:  # noqa: BLE001  a user's property can raise anything for an array
            return None
        places = np.flatnonzero(np.broadcast_to(plain, self.count))
        for k in places[[0, -1]] if places.size else ():
            ((model, run),) = self._objects(np.array([k]))
            alone = numbers(model, run)
            if not all(np.array_equal(alone[name], one[run], equal_nan=True) for name, one in found.items()):
                return None
        return found, np.flatnonzero(~np.broadcast_to(plain, self.count))

    def _of_arrays(self) -> tuple[Model, npt.NDArray[np.bool_]]:
        """Return the model whose numbers are arrays, and the runs whose numbers are accepted without a question."""
        if "arrays" not in self._made:
            model = _of_arrays(self.model, self.values)
            self._made["arrays"] = model, _plain(model.column) & _plain(model)
        model, plain = self._made["arrays"]
        return model, plain


# Runs from which on it pays to evaluate their models at once, and from which on it matters if they cannot be.
_FEWEST, _MANY = 4, 256


@cache
def _report_objects(kind: type[Model]) -> None:
    """Log once for a class of models that its runs wait for Python."""
    LOG.warning(
        "%s: an object is made for each run, one after the other, since its properties or its checks do not compute "
        "with arrays; see the page on own models",
        kind.__name__,
    )


def _checks_by_declaration(kind: type[Model]) -> bool:
    """Return whether the checks of a class of models are its declared numbers and what `consistent` says."""
    return owner_of(kind, "__post_init__") in (Model, Declared) and issubclass(
        owner_of(kind, "consistent"), owner_of(kind, "validate")
    )


def _of_arrays(model: Model, values: Mapping[str, Floats]) -> Model:
    """Return a model whose numbers are arrays, in the order of `changed_model`, without checks."""
    column = unchecked(model.column, **{name: one for name, one in values.items() if name in COLUMN_NAMES})
    if "slenderness" in values:
        column = unchecked(column, **column.numbers_at_slenderness(values["slenderness"]))
    if "size" in values:
        column = unchecked(column, **column.numbers_at_size(values["size"]))
    own = {name: one for name, one in values.items() if name not in COLUMN_NAMES}
    return unchecked(model, column=column, **own)


def _plain(made: Model | Column) -> npt.NDArray[np.bool_]:
    """Return for which runs the numbers of `made` are accepted without a question."""
    plain = np.asarray(made.consistent)
    kind: Any = type(made)
    for name, one in parameters_of(kind).items():
        values = getattr(made, name)
        if isinstance(values, np.ndarray):
            simple = not (one.choices or one.whole) and one.quantity.components == 1
            plain = plain & (one.quantity.plain(values) if simple else False)
    return plain


def _assembled(count: int, parts: list[tuple[Mapping[str, Arrays], Runs]]) -> dict[str, Arrays]:
    """Return the arrays of all runs; later parts replace the runs of earlier ones."""
    result = {name: np.empty((count, *one.shape[1:]), one.dtype) for name, one in parts[0][0].items()}
    for found, runs in parts:
        for name, one in found.items():
            result[name][runs] = one
    return result


@dataclass(frozen=True, slots=True)
class ModelColumns:
    """Arrays over the runs of shape (n,), except `slope`, (n, 3), and `parameters`.

    `length` is the height of the centre of mass [m].
    """

    models: RunModels
    time_scale: Floats
    gravity: Floats
    length: Floats
    slenderness: Floats
    capacity: Floats
    comes_to_rest: npt.NDArray[np.bool_]
    loss_tilt: Floats
    slope: Floats
    parameters: Floats

    @classmethod
    def of(cls, model: Model, values: Mapping[str, Floats], count: int) -> "ModelColumns":
        """Return the columns for `count` runs that change these `values`.

        Raises
        ------
        ParameterError
            If a value is out of range.
        """
        models = RunModels(model, split(model, values)[0], count)

        def numbers(changed: Model, runs: Runs) -> dict[str, Arrays]:
            column = changed.column
            flat = {
                "time_scale": changed.time_scale,
                "gravity": column.gravity,
                "length": column.mass_height,
                "slenderness": column.slenderness,
                "capacity": changed.rest_capacity,
                "comes_to_rest": changed.comes_to_rest,
                "loss_tilt": changed.loss_tilt,
            }
            rows = {"slope": changed.slope, "parameters": changed.parameters}
            size = _size(count, runs)
            return {name: np.broadcast_to(one, size) for name, one in flat.items()} | {
                name: _rows(parts, size) for name, parts in rows.items()
            }

        return cls(models, **models.evaluate(numbers))

    def starts(self, tilt: Floats, tilt_rate: Floats, spin: Floats) -> Floats:
        """Return the states, shape (n, number of states), with these tilts and rates, of shape (n, 2), and spins."""

        def numbers(changed: Model, runs: Runs) -> dict[str, Arrays]:
            vectors = (*tilt[runs].T, *tilt_rate[runs].T)
            states: list[Any] = [*changed.start((vectors[0], vectors[1]), (vectors[2], vectors[3]))]
            if changed.spin_state is not None:
                states[changed.spin_state] = spin[runs] * changed.time_scale
            return {"states": _rows(states, len(spin[runs]))}

        return self.models.evaluate(numbers)["states"]

    @property
    def body(self) -> Body:
        """The numbers on which rest depends."""
        return Body(
            self.time_scale, self.slenderness, self.capacity, self.comes_to_rest, self.loss_tilt, [*self.slope.T]
        )


def _size(count: int, runs: Runs) -> int:
    return len(range(count)[runs]) if isinstance(runs, slice) else len(runs)


def _rows(parts: Sequence[Any], count: int) -> Floats:
    return np.stack([np.broadcast_to(one, count) for one in parts], axis=1, dtype=float)
