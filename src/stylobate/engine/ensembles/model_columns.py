"""Columns of the table of a batch that describe the model of each run."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.parameters import changed_model, split
from stylobate.models import Model

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ModelColumns:
    """Arrays over the runs of shape (n,), except `slope`, (n, 3), `states`, (n, number of states), and `parameters`.

    `length` is the height of the centre of mass [m].
    """

    time_scale: Floats
    gravity: Floats
    length: Floats
    slenderness: Floats
    capacity: Floats
    comes_to_rest: npt.NDArray[np.bool_]
    loss_tilt: Floats
    slope: Floats
    states: Floats
    parameters: Floats
    kinds: "Kinds"

    @classmethod
    def of(
        cls, model: Model, values: Mapping[str, Floats], tilt: Floats, tilt_rate: Floats, spin: Floats
    ) -> "ModelColumns":
        """Return the columns for runs with these initial values, `tilt` and `tilt_rate` of shape (n, 2), and `values`.

        Raises
        ------
        ParameterError
            If a value is out of range.
        """
        count = len(tilt)
        own, _ = split(model, values)
        numbers = np.empty((6, count))
        comes_to_rest, slope = np.empty(count, dtype=bool), np.empty((count, 3))
        states = np.empty((count, len(model.state_names)))
        parameters = np.empty((count, len(model.parameters)))
        kinds = _distinct(model, own, count)
        for changed, runs in kinds:
            column = changed.column
            numbers[:, runs] = np.array(
                [
                    changed.time_scale,
                    column.gravity,
                    column.mass_height,
                    column.slenderness,
                    changed.rest_capacity,
                    changed.loss_tilt,
                ]
            )[:, np.newaxis]
            slope[runs] = changed.slope
            comes_to_rest[runs] = changed.comes_to_rest
            parameters[runs] = changed.parameters
            vectors = (*tilt[runs].T, *tilt_rate[runs].T)
            start = changed.start((vectors[0], vectors[1]), (vectors[2], vectors[3]))
            for j, part in enumerate(start):
                states[runs, j] = part
            if model.spin_state is not None:
                states[runs, model.spin_state] = spin[runs] * changed.time_scale
        time_scale, gravity, length, slenderness, capacity, loss_tilt = numbers
        lengths = (length, slenderness)
        return cls(time_scale, gravity, *lengths, capacity, comes_to_rest, loss_tilt, slope, states, parameters, kinds)


Kinds = list[tuple[Model, slice | npt.NDArray[np.int64]]]


def _distinct(model: Model, values: Mapping[str, Floats], count: int) -> Kinds:
    """Return the distinct models, each with its runs."""
    if not values or count == 0:
        return [(model, slice(None))]
    table = np.stack(list(values.values()), axis=1)
    kinds, which = np.unique(table, axis=0, return_inverse=True)
    order = np.argsort(which.ravel(), kind="stable")
    ends = np.cumsum(np.bincount(which.ravel(), minlength=len(kinds)))
    runs = np.split(order, ends[:-1])
    return [
        (changed_model(model, dict(zip(values, kind.tolist(), strict=True))), chosen)
        for kind, chosen in zip(kinds, runs, strict=True)
    ]
