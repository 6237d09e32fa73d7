"""Kernels: written for a model and a kind of base motion."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from types import SimpleNamespace
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Bound, Written
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import Element
from stylobate.engine import dop853, elementary, radau, tolerances
from stylobate.engine.kernel import columns, driver, linear_equations, roots
from stylobate.engine.kernel.dense_source import dense_source
from stylobate.engine.kernel.head_source import OPTIONAL, SWITCHING, constants_source, model_source
from stylobate.engine.kernel.implicit_source import implicit_source
from stylobate.engine.kernel.layout import Row, Table
from stylobate.engine.kernel.margin_source import margins_source, reaction_source, window_source
from stylobate.engine.kernel.observation_source import observation_source
from stylobate.engine.kernel.shape import STAGES, Shape
from stylobate.engine.kernel.stability_source import stability_source
from stylobate.engine.kernel.step_source import accelerations_source, rates_source, step_source
from stylobate.models import Model

_EDGE = 8
"""Numbers in a line of the processor's cache: a vector that lies across two lines costs twice."""

_IN_LANES = ("rates", "tilt_of", "contact", "guards", "project")
"""Functions of a model that steps call for all lanes."""


@dataclass(frozen=True, slots=True)
class Kernel:
    """What advances batches of runs of a model."""

    shape: Shape
    compiled: Compiled

    def buffer(self) -> Row:
        """Return a new buffer, in which no batch has begun."""
        size = len(self.shape.rows()) * self.shape.width
        room = np.full(size + _EDGE, np.nan)
        return room[(-room.ctypes.data // room.itemsize) % _EDGE :][:size]

    def advance(
        self, table: Table, pieces: Table, halt: npt.NDArray[np.uint8], buffer: Row, *, plain: bool = False
    ) -> bool:
        """Run a batch to its end, until `halt[0]` is set or a trace is full; return whether it is at its end."""
        advance = self.compiled.plain if plain else self.compiled
        return bool(advance(table, pieces, halt, buffer.reshape(-1, self.shape.width), buffer))


@cache
def kernel_of(model: type[Model], shape: Shape) -> Kernel:
    """Return the kernel of a class of models for this shape."""
    rows, width, table = len(shape.rows()), shape.width, ArrayArgument((None, None))
    compiled = Compiled(
        name="advance",
        program=Bound(
            modules=driver.modules(switching=bool(shape.guards)),
            names=_names(shape),
            written=Written(kernel_source(model, shape), (elementary,)),
            imported=(columns, dop853, linear_equations, radau, roots, tolerances),
        ),
        functions=_functions(model, shape),
        arguments=(
            table,
            table,
            ArrayArgument((1,), Element.SIGNAL),
            ArrayArgument((rows, width)),
            ArrayArgument((rows * width,)),
        ),
        model=model.name,
        description=_in_words(model, shape),
        fast=_IN_LANES,
    )
    return Kernel(shape, compiled)


def kernel_source(model: type[Model], shape: Shape) -> str:
    """Return the source of the module of a kernel."""
    has = {name: getattr(model, name) is not None for name in OPTIONAL}
    to_plane = not shape.planar and model.planar_rates is not None
    return "\n\n".join(
        [
            f'"""Written by stylobate {version("stylobate")}: {model.name}, {_kind(shape)}."""\n',
            _IMPORTS,
            constants_source(model, shape, has, to_plane=to_plane),
            accelerations_source(shape),
            rates_source(shape),
            model_source(shape, has),
            step_source(model, shape),
            observation_source(shape),
            *_contact_sources(shape),
            window_source(model, shape, shape.rows()),
        ]
    )


_IMPORTS = """\
import math

import numpy as np

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.elementary import cos_turns, turning_point, winding
"""


def _functions(model: type[Model], shape: Shape) -> dict[str, Callable[..., Any]]:
    """Return the model's functions as a kernel of this shape uses them, by name."""
    functions = {"rates": model.planar_rates if shape.planar else model.rates, "tilt_of": model.tilt_of}
    functions |= {name: getattr(model, name) for name in OPTIONAL}
    if shape.demands:
        functions["contact"] = model.contact
    if shape.guards:
        functions |= {name: getattr(model, name) for name in SWITCHING}
    if shape.planar and (shape.demands or model.impact_map is not None):
        functions["from_plane"] = model.from_plane
    return {name: function for name, function in functions.items() if function is not None}


def _contact_sources(shape: Shape) -> list[str]:
    """Return what the driver of a model that changes between kinds of contact calls."""
    rows, writers = shape.rows(), (margins_source, reaction_source, dense_source, stability_source, implicit_source)
    return [write(shape, rows) for write in writers] if shape.guards else [dense_source(shape, rows)]


def _names(shape: Shape) -> dict[str, Any]:
    """Return what the driver calls the rows of the buffer."""
    rows = shape.rows()
    special = {
        "STATE": "y0",
        "NEW": "new0",
        "LAST_STATE": "last0",
        "BEFORE": "before_tilt_change",
        "LATE": "late_tilt_change",
        "LOOK": "look0",
        "PARAMETER": "p0",
        "SLOPE": "k0_0",
        "SLOPE_NEW": f"k{STAGES}_0",
        "LAST_SLOPE": "last_slope0",
        "DENSE": "dense0_0",
        "CONTACT": f"y{shape.order - 1}",
    }
    # What reads rows that a kernel lacks is left out by the compiler.
    numbers = {name: rows.get(row) for name, row in special.items()}
    return {"R": SimpleNamespace(**{name.upper(): rows[name] for name in rows}, **numbers)}


def _kind(shape: Shape) -> str:
    return f"{'plane' if shape.planar else 'space'} motion, {shape.forcing.tag}, {shape.width} lanes"


def _in_words(model: type[Model], shape: Shape) -> str:
    """Describe a kernel so that its description differs from those of the other kernels of a model."""
    options = (", by Taylor series" if shape.series else "", ", with contact demands" if shape.demands else "")
    return f"{model.name}, {_kind(shape)}{''.join(options)}"
