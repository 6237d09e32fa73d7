"""Maps and basins, shown progressively during their computation."""

import os
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from stylobate import config, studies
from stylobate.errors import Outcome, ParameterError
from stylobate.lab.case_axes import case_map, case_numbers, units_of
from stylobate.lab.json_values import number, numbers
from stylobate.lab.messages import Emit, Found, Progress
from stylobate.lab.progressive_executor import Cells, Refining
from stylobate.parameter_quantities import attributes_of


def overturning_plane(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Compute the map of outcomes over two quantities; for a sliding model, the map of kinds of contact."""
    study = studies.overturning_map
    setup = config.study_config(study).parse(values).build()
    if case_numbers(values, setup.options["over"]):
        found = _watched(partial(case_map, setup, values), setup, emit, keywords={}, flat=True)
    else:
        found = _watched(partial(study, setup.model, setup.motion), setup, emit, keywords=setup.options)
    if "contact_class" in found:
        return _finer(found, "contact_class", found["class_name"].to_numpy(), setup)
    return _counts(found, [outcome.label for outcome in Outcome])


def basin_plane(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Compute the attractor of each initial condition of a grid."""
    setup = config.study_config(studies.basins).parse(values).build()
    if "count" in setup.options:
        message = "basin.random: the laboratory computes grids only. Give basin.x and basin.y, or use the command line."
        raise ParameterError(message)
    study = partial(studies.basins, setup.model, setup.motion)
    found = _watched(study, setup, emit, keywords=setup.options)
    answer = _finer(found, "attractor", found["attractor_name"].to_numpy(), setup)
    answer["attractors"] = [_attractor(found.isel(attractor_index=i)) for i in range(found.sizes["attractor_index"])]
    return answer


def _attractor(one: xr.Dataset) -> dict[str, Any]:
    shares = ("fraction", "fraction_low", "fraction_high")
    return {
        "name": str(one["attractor_name"].item()),
        "kind": str(one["attractor_kind"].item()),
        "period": int(one["attractor_period"]),
        **{name: number(float(one[name])) for name in shares},
    }


def _watched(
    study: Callable[..., xr.Dataset],
    setup: config.Setup,
    emit: Emit,
    *,
    keywords: Mapping[str, Any],
    flat: bool = False,
) -> xr.Dataset:
    """Run `study` and emit the outcomes as soon as they are known; `flat` if the runs of the study form one row."""
    over = setup.options["over"]
    axes = {
        place: {"name": name, "values": numbers(values), **(attributes_of(name) or {"units": units_of(name)})}
        for place, (name, values) in zip("xy", over.items(), strict=True)
    }
    names = [[int(outcome), outcome.label] for outcome in Outcome]
    emit(Found({"axes": axes, "names": names}))

    def show(stride: int, places: Cells, outcomes: Cells) -> None:
        cells = np.column_stack([places, outcomes]).tolist()
        emit(Found({"stride": stride, "cells": cells}))

    shape = tuple(len(values) for values in over.values()) if flat else None
    executor = Refining(show, threads=max(1, (os.cpu_count() or 2) // 2), shape=shape)
    return study(
        **keywords,
        executor=executor,
        progress=lambda done, total: emit(Progress(done, total)),
    )


def _finer(found: xr.Dataset, variable: str, names: Any, setup: config.Setup) -> dict[str, Any]:
    """Return the cells with their final classes."""
    codes = found[variable].transpose(*found["outcome"].dims).to_numpy()
    codes = codes.reshape([len(values) for values in setup.options["over"].values()])
    listed = [[index, str(name)] for index, name in enumerate(names)]
    return {"codes": codes.tolist(), "names": listed, **_counts(found, None)}


def _counts(found: xr.Dataset, names: list[str] | None) -> dict[str, Any]:
    answer: dict[str, Any] = {"uncertain": int(found["uncertain"].sum()), "runs": int(found["outcome"].size)}
    if names is not None:
        answer["shares"] = dict(zip(names, numbers(found["share"]), strict=True))
    return answer
