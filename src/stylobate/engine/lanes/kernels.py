"""Kernels: written for a model and a kind of base motion."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import Element
from stylobate.engine import elementary
from stylobate.engine.lanes import linear_equations, pattern, roots
from stylobate.engine.lanes.columns import LOOKS, Status, Trace, TraceKind, Window
from stylobate.engine.lanes.dense_source import dense_source
from stylobate.engine.lanes.head_source import OPTIONAL, SWITCHING, constants_source, model_source
from stylobate.engine.lanes.implicit_source import implicit_source
from stylobate.engine.lanes.layout import Row, Table
from stylobate.engine.lanes.margin_source import margins_source, reaction_source, window_source
from stylobate.engine.lanes.observation_source import observation_source
from stylobate.engine.lanes.shape import DEMANDS, STAGES, Shape
from stylobate.engine.lanes.stability_source import stability_source
from stylobate.engine.lanes.step_source import accelerations_source, rates_source, step_source
from stylobate.models import Model

_MARK = "# --- the kernel's text begins here ---"
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
        text=kernel_source(model, shape),
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
        imported=(elementary, linear_equations, roots),
        fast=_IN_LANES,
    )
    return Kernel(shape, compiled)


def kernel_source(model: type[Model], shape: Shape) -> str:
    """Return the source of the module of a kernel."""
    has = {name: getattr(model, name) is not None for name in OPTIONAL}
    to_plane = not shape.planar and model.planar_rates is not None
    text = "\n\n".join(
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
            _driver_text(shape),
        ]
    )
    return _with_numbers(text, shape)


_IMPORTS = """\
import math

import numpy as np
import numpy.typing as npt

from stylobate.compiler.marks import fast, flat, lanes
from stylobate.engine.elementary import cos_turns, turning_point, winding
from stylobate.engine.lanes.layout import Row, Table
from stylobate.engine.lanes.linear_equations import NewtonRoom, factor, solve
from stylobate.engine.lanes.roots import cubic, first_growth_past, first_return, nearest_turn, quintic, turns_of
from stylobate.models.model import Push
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


def _driver_text(shape: Shape) -> str:
    folder = Path(pattern.__file__).parent
    order = pattern.SWITCHING_ORDER if shape.guards else pattern.ORDER
    texts = ((folder / f"{name}.py").read_text(encoding="utf-8") for name in order)
    return "".join(text.split(_MARK, 1)[1] for text in texts)


def _with_numbers(text: str, shape: Shape) -> str:
    """Return `text` with names of columns and rows replaced by their numbers."""
    rows = shape.rows()
    special = {
        "STATE": rows["y0"],
        "NEW": rows["new0"],
        "LAST_STATE": rows["last0"],
        "BEFORE": rows["before_tilt_change"],
        "LATE": rows["late_tilt_change"],
        "LOOK": rows["look0"],
        "PARAMETER": rows["p0"] if shape.parameters else 0,
        "COUNT": len(rows),
    }

    slopes = {"SLOPE": "k0_0", "SLOPE_NEW": f"k{STAGES}_0", "LAST_SLOPE": "last_slope0"}
    # Steps by series have no slopes; what reads them is left out by the compiler, as what is not followed.
    slopes["DENSE"] = "dense0_0"
    special |= {name: 0 if shape.series else rows[row] for name, row in slopes.items()}
    if shape.guards:
        special |= {"CONTACT": rows[f"y{shape.order - 1}"]}
    special |= {f"{name.upper()}_NOW": rows[f"{name}_now"] if shape.demands else 0 for name in DEMANDS}

    def number(match: re.Match[str]) -> str:
        table, name = match.groups()
        if table == "R":
            return str(special[name] if name in special else rows[name.lower()])
        return str(int(_NAMED[table][name]))

    numbered = re.sub(rf"\b(R|{'|'.join(_NAMED)})\.([A-Z_]+)\b", number, text)
    return re.sub(r"\bLOOKS\b", str(LOOKS), numbered).replace("len(Trace)", str(len(Trace)))


_NAMED = {"Window": Window, "Status": Status, "Trace": Trace, "TraceKind": TraceKind}


def _kind(shape: Shape) -> str:
    return f"{'plane' if shape.planar else 'space'} motion, {shape.forcing.tag}, {shape.width} lanes"


def _in_words(model: type[Model], shape: Shape) -> str:
    """Describe a kernel so that its description differs from those of the other kernels of a model."""
    options = (", by Taylor series" if shape.series else "", ", with contact demands" if shape.demands else "")
    return f"{model.name}, {_kind(shape)}{''.join(options)}"
