"""Response curves, from theory and from exact orbits, as plain values."""

from collections.abc import Mapping
from itertools import count
from typing import Any

import numpy as np
import xarray as xr

from stylobate import config, studies
from stylobate.lab.json_values import numbers
from stylobate.lab.pool import Emit, Note
from stylobate.orbits import StepControl
from stylobate.orbits.saving import SUPERCRITICAL_OF
from stylobate.text import plural

_ORBITS = 400
"""Maximum number of orbits of a family each way, enough for a plot; near the vertical, families have thousands."""


def response(values: Mapping[str, Any]) -> dict[str, Any]:
    """Compute the curves of theory that `values` describe, within milliseconds; numbers that overflow are None."""
    setup = config.ResponseConfig.parse(values).build()
    low, high = setup.options["range"]
    frequencies = np.linspace(low, high, setup.options["points"])
    with np.errstate(all="ignore"):
        return plain_curves(studies.response_curves(setup.model, setup.motion, angular_frequency=frequencies))


def plain_curves(curves: xr.Dataset) -> dict[str, Any]:
    """Return the curves of theory, one for each sense and branch."""
    return {
        "angular_frequency": numbers(curves["angular_frequency"]),
        "branches": [
            {
                "sense": str(sense),
                "branch": str(branch),
                **{
                    name: numbers(curves[name].sel(sense=sense, branch=branch))
                    for name in ("amplitude", "phase", "stable")
                },
            }
            for sense in curves["sense"].to_numpy()
            for branch in curves["branch"].to_numpy()
        ],
        "backbone": numbers(curves["backbone"]),
        "critical": [
            {"sense": str(sense), "angular_frequency": value}
            for sense, value in zip(curves["sense"].to_numpy(), numbers(curves["critical_frequency"]), strict=True)
        ],
        "averaged": bool(curves.attrs["averaged"]),
    }


def exact_curves(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Compute the exact orbits that `values` describe; progress states the number of orbits and the last frequency."""
    setup = config.ResponseConfig.parse(values).build()

    number = count(1)

    def reached(frequency: float) -> None:
        emit(Note(f"{plural(next(number), 'exact orbit')} found, the last at {frequency:.4g} rad/s"))

    low, high = setup.options["range"]
    control = StepControl(most=_ORBITS)
    found = studies.exact_response(
        setup.model, setup.motion, angular_frequency=(low, high), control=control, progress=reached
    )
    return plain_exact(found)


def plain_exact(found: xr.Dataset) -> dict[str, Any]:
    """Return families of exact orbits and their bifurcations."""
    names = ("angular_frequency", "mean_tilt", "minimum_tilt", "peak_tilt", "phase", "stable", "tilt", "tilt_rate")
    owner = found["branch"].to_numpy()
    families = [
        {"name": str(label), **{name: numbers(found[name].to_numpy()[owner == index]) for name in names}}
        for index, label in enumerate(found["branch_name"].to_numpy())
    ]
    bifurcations = [
        {
            "kind": str(kind),
            "angular_frequency": float(frequency),
            "mean_tilt": float(tilt),
            "supercritical": SUPERCRITICAL_OF[int(supercritical)],
        }
        for kind, frequency, tilt, supercritical in zip(
            *(
                found[f"bifurcation_{name}"].to_numpy()
                for name in ("kind", "angular_frequency", "mean_tilt", "supercritical")
            ),
            strict=True,
        )
    ]
    return {"families": families, "bifurcations": bifurcations}
