"""Kernels: the driver bound to a model and a kind of base motion."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Bound, Written
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import Element
from stylobate.engine import dop853, elementary, tolerances
from stylobate.engine.kernel import columns
from stylobate.engine.kernel import shape as shapes
from stylobate.engine.kernel.bound import Row, Table
from stylobate.engine.kernel.driver import (
    equations,
    events,
    guards,
    implicit_step,
    loop,
    motion,
    records,
    rest,
    smooth,
    stages,
    step,
    switching,
)
from stylobate.engine.kernel.expansion import expand_source
from stylobate.engine.kernel.shape import SERIES_ORDER, STAGES, Shape
from stylobate.models import Model

_GRAIN = 8
"""Lanes of a step: the maximum vector length of a processor."""

_EDGE = 8
"""Numbers in a cache line of the processor: a vector across two lines costs twice as much."""

_IN_LANES = ("rates", "tilt_of", "contact", "guards", "project")
"""Functions of a model that steps call for all lanes."""

_OPTIONAL = ("rest_energy", "no_return_tilt", "departure", "passage", "at_rest", "impact_map")
"""Functions that a model may lack."""

_COMMON = (events, equations, stages, motion, guards, step, records, rest, loop)
_SMOOTH = (smooth,)
_SWITCHING = (switching, implicit_step)
"""Modules of the driver: of all kernels, and for models without or with changes between kinds of contact."""

_USED_AS_THEY_ARE = (columns, dop853, elementary, shapes, tolerances)


@dataclass(frozen=True, slots=True)
class Kernel:
    """Compiled program that advances batches of runs of a model."""

    shape: Shape
    compiled: Compiled

    def buffer(self) -> Table:
        """Return a new buffer, in which no batch has begun."""
        rows, width = _size(self.shape)
        room: Row = np.full(rows * width + _EDGE, np.nan)
        return room[(-room.ctypes.data // room.itemsize) % _EDGE :][: rows * width].reshape(rows, width)

    def advance(
        self, table: Table, pieces: Table, halt: npt.NDArray[np.uint8], buffer: Table, *, plain: bool = False
    ) -> bool:
        """Run a batch to its end, or until `halt[0]` is set or a trace is full; return whether the batch has ended."""
        advance = self.compiled.plain if plain else self.compiled
        return bool(advance(table, pieces, halt, buffer))


def kernel_of(model: type[Model], shape: Shape) -> Kernel:
    """Return the kernel of a class of models, with its present functions, for this shape."""
    return _kernel(model, shape, tuple(_functions(model, shape).items()))


@cache
def _kernel(model: type[Model], shape: Shape, functions: tuple[tuple[str, Callable[..., Any]], ...]) -> Kernel:
    table = ArrayArgument((None, None))
    compiled = Compiled(
        name="advance",
        program=lambda: Bound(
            modules=_COMMON + (_SWITCHING if shape.guards else _SMOOTH),
            names={"R": _rows(shape), **_constants(model, shape)},
            written=Written(expand_source(model, shape)) if shape.series else None,
            imported=_USED_AS_THEY_ARE,
        ),
        functions=dict(functions),
        arguments=(table, table, ArrayArgument((1,), Element.SIGNAL), ArrayArgument(_size(shape))),
        model=model.name,
        description=_in_words(model, shape),
        fast=_IN_LANES,
    )
    return Kernel(shape, compiled)


def _size(shape: Shape) -> tuple[int, int]:
    """Return the shape of the buffer: one group of lanes after the other."""
    return len(shape.rows()) * len(shape.groups), shape.width


def _rows(shape: Shape) -> SimpleNamespace:
    """Return the indices of the buffer rows under their names in capitals, and of the first row of each block."""
    rows = shape.rows()
    blocks = {
        "STATE": "y0",
        "NEW": "new0",
        "LAST_STATE": "last0",
        "SLOPE": "k0_0",
        "SLOPE_NEW": f"k{STAGES}_0",
        "LAST_SLOPE": "last_slope0",
        "EXTRA": "extra0_0",
        "DENSE": "dense0_0",
        "STAGE": "stage0",
        "RATE": "rate0",
        "STEP": "step0",
        "SQUARE": "square0",
        "BEFORE": "before_tilt_change",
        "LATE": "late_tilt_change",
        "PARAMETER": "p0",
        "CONTACT": f"y{shape.order - 1}",
        "LOADS": "normal_now",
        "ORBIT": "orbit0",
        "END_PUSH": f"end_{shape.forcing.components[0]}",
    }
    # The compiler leaves out code that reads rows which a kernel lacks.
    first = {name: rows.get(row) for name, row in blocks.items()}
    return SimpleNamespace(**{name.upper(): rows[name] for name in rows}, **first)


def _constants(model: type[Model], shape: Shape) -> dict[str, Any]:
    """Return the other constants that the driver leaves open."""
    has = {name: getattr(model, name) is not None for name in _OPTIONAL}
    return {
        "WIDTH": shape.width,
        "GRAIN": shape.width if shape.guards else min(shape.width, _GRAIN),
        "ORDER": shape.order,
        "PARAMETERS": shape.parameters,
        "PLANAR": shape.planar,
        "COMPONENTS": len(shape.forcing.components),
        "VERTICAL": "az" in shape.forcing.components,
        "PARAMETERS_AT": shape.parameters_at,
        "MOTION_AT": shape.motion_at,
        "BREAKS_AT": shape.breaks_at,
        "TRACE_ROOM": shape.trace_room,
        "TRACE_STATES": max(shape.states, 2),
        "TRACE_WIDTH": shape.trace_width,
        "CAN_REST": has["rest_energy"],
        "CAN_DEPART": has["departure"],
        "CAN_PASS": has["passage"] and not shape.planar,
        "CAN_PROVE_NO_RETURN": has["no_return_tilt"],
        "CAN_GO_TO_PLANE": not shape.planar and model.planar_rates is not None,
        "CAN_LOSE": has["impact_map"],
        "KEEPS_AT_REST": has["at_rest"] and not shape.planar,
        "DEMANDS": shape.demands,
        # The multipliers of an orbit do not apply to planar motion, which excludes disturbances out of the plane.
        "ORBITS": 0 if shape.planar else shape.orbits,
        "ORBITS_AT": shape.orbits_at,
        "SPIN": -1 if model.spin_state is None else model.spin_state,
        "KEPT": shape.order + len(shape.changes),
        "ROWS": len(shape.rows()),
        "GROUPS": tuple(range(len(shape.groups))),
        "GROUP_KINDS": tuple(kind for kind, _ in shape.groups),
        "GROUP_MOVING": tuple(moving for _, moving in shape.groups),
        **shape.forcing.constants(shape.rows()),
        **_series_constants(shape),
        **_contact_constants(model, shape),
    }


def _series_constants(shape: Shape) -> dict[str, Any]:
    """Return the constants of steps by Taylor series: expanded states, degrees, and rows of the coefficients."""
    rows, states = shape.rows(), range(len(shape.series))
    rates_of = [next((m for m, integral in enumerate(shape.series) if integral == j != m), -1) for j in states]
    return {
        "SERIES": SERIES_ORDER if shape.series else 0,
        "INTEGRALS": shape.series,
        "RATES_OF": tuple(rates_of),
        "DEGREES": tuple(shape.degree(j) for j in states),
        "COEFFICIENTS": tuple(rows.get(f"c1_{j}") for j in states),
    }


def _contact_constants(model: type[Model], shape: Shape) -> dict[str, Any]:
    """Return the indices of guards and kinds of contact; −1 if absent. The tilt limit counts as a guard."""
    names, kinds = model.guard_names, model.contact_kinds
    places = {"FALLEN": "fallen", "FRICTION": "friction", "JAM": "jam"}
    states = ("footprint_x", "footprint_y", "twist") if shape.guards else ()
    return {
        "SWITCHING": shape.guards > 0,
        "GUARDS": shape.guards,
        "LAST": shape.guards - 1,
        "LIMIT": shape.guards,
        **{name: names.index(guard) if guard in names else -1 for name, guard in places.items()},
        **dict(zip(("SLIP_X", "SLIP_Y"), shape.slip or (-1, -1), strict=True)),
        "KEPT_STATES": shape.kept,
        "CHANGES": implicit_step.STAGES * shape.order,
        "WINDOW_ENDS": tuple(model.state_names.index(name) for name in states),
        **dict.fromkeys(("RESTING", "SLIDING", "ROLLING", "SLIPPING", "FLYING", "JAMMED"), -1),
        **{kind.name: kind.value for kind in kinds or ()},
    }


def _functions(model: type[Model], shape: Shape) -> dict[str, Callable[..., Any]]:
    """Return the functions of the model that a kernel of this shape uses, by name."""
    functions = {"rates": model.planar_rates if shape.planar else model.rates, "tilt_of": model.tilt_of}
    functions |= {name: getattr(model, name) for name in _OPTIONAL}
    if shape.demands:
        functions["contact"] = model.contact
    if shape.guards:
        functions |= {name: getattr(model, name) for name in ("guards", "reset_map", "project")}
    if shape.planar and (shape.demands or model.impact_map is not None):
        functions["from_plane"] = model.from_plane
    return {name: function for name, function in functions.items() if function is not None}


def _in_words(model: type[Model], shape: Shape) -> str:
    """Describe a kernel such that descriptions of different kernels of a model differ."""
    kind = f"{'plane' if shape.planar else 'space'} motion, {shape.forcing.tag}, {shape.width} lanes"
    options = (
        ", by Taylor series" if shape.series else "",
        ", with contact demands" if shape.demands else "",
        f", with known orbits: {shape.orbits}" if shape.orbits else "",
    )
    return f"{model.name}, {kind}{''.join(options)}"
