"""The programs by which a page computes runs without Python: modules of WebAssembly, and the layout of their numbers.

A module holds the kernels of a class of models under one kind of base motion, and the functions of `runs` for it.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from itertools import chain, combinations
from typing import Any

import numpy as np

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.base_motions.declared import MOTIONS
from stylobate.base_motions.harmonic import Harmonic
from stylobate.base_motions.pulses import Pulse
from stylobate.base_motions.record import Record
from stylobate.base_motions.sweeps import SineSweep
from stylobate.column import Column
from stylobate.column.shapes import SHAPES
from stylobate.compiler import mathematics
from stylobate.compiler.machine import WEB, Machine
from stylobate.compiler.sources import CompileError, written_module
from stylobate.compiler.unit import ArrayArgument, Unit
from stylobate.compiler.values import NumberKind
from stylobate.compiler.web import module_of
from stylobate.engine.cost import EVERY
from stylobate.engine.ensembles.batch import Plan
from stylobate.engine.ensembles.beginnings import number_of_looks
from stylobate.engine.ensembles.late import LATE_COLUMNS, Late
from stylobate.engine.ensembles.polynomials import DEGREE
from stylobate.engine.ensembles.run_columns import MotionPlan
from stylobate.engine.kernel.columns import LOG, NOTE, PAIRS, STATE, Log, Piece, Setup, Trace
from stylobate.engine.kernel.driver.events import RunStatus, TraceKind
from stylobate.engine.kernel.kernels import kernel_of
from stylobate.engine.standalone import demands, runs
from stylobate.engine.standalone.bases import AXES, AtRest, Polynomials, Table, Waves
from stylobate.engine.standalone.demands import Demand
from stylobate.engine.standalone.runs import Accuracy, Given, Layout, Sample, Verdict
from stylobate.engine.standalone.tables import (
    record_table,
    smooth_table,
    steady_of_pulse,
    steady_of_sweep,
    steady_of_wave,
)
from stylobate.models import Model
from stylobate.quantities import Parameter, parameters_of
from stylobate.run_arguments import checked_options

COLUMN = tuple(name for name in parameters_of(Column) if name != "height")
"""Numbers of the column in those of a run; the numbers of model, motion, start and accuracy follow."""

HARMONIC = tuple(
    f"{name}_{axis}" if one.quantity.components > 1 else name
    for name, one in parameters_of(Harmonic).items()
    for axis in "xyz"[: one.quantity.components]
    if name != "ramp"
)
"""Numbers of a harmonic motion without a ramp."""


class Shaking(StrEnum):
    """Kinds of base motion with programs of their own."""

    REST = "rest"
    HARMONIC = "harmonic"
    LINEAR = "linear"
    """Tabulated, with an acceleration that is linear between breaks: a record."""
    SMOOTH = "smooth"
    """Tabulated by polynomials of a higher degree: a pulse."""

    @property
    def example(self) -> BaseMotion:
        """A motion of this kind."""
        if self is Shaking.REST:
            return BASE_AT_REST
        if self is Shaking.HARMONIC:
            return Harmonic(amplitude=(1.0, 1.0, 1.0), angular_frequency=1.0)
        if self is Shaking.LINEAR:
            return Record(samples=np.ones((2, AXES)), step=1.0)
        return Pulse.one_sine(acceleration=1.0, angular_frequency=1.0, vertical=1.0)

    @property
    def numbers(self) -> tuple[str, ...]:
        """Names of the numbers of a motion of this kind."""
        return {Shaking.REST: (), Shaking.HARMONIC: HARMONIC}.get(self, Table._fields)

    @property
    def piece(self) -> int:
        """Numbers in the row of a polynomial; 0 for motions without a table."""
        degree = {Shaking.LINEAR: 1, Shaking.SMOOTH: DEGREE}.get(self)
        return 0 if degree is None else len(Piece) + AXES * (degree + 1)


@dataclass(frozen=True)
class RunProgram:
    """The program for runs of a class of models under a kind of base motion.

    Parameters
    ----------
    kind
        Class of models.
    shaking
        Kind of base motion.
    """

    kind: type[Model]
    shaking: Shaking

    @property
    def model_numbers(self) -> Mapping[str, Parameter]:
        """The declared numbers of the model, and its choices between words, by name."""
        return {name: one for name, one in parameters_of(self.kind).items() if name != "column"}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the numbers of a run, in their order: NaN for one that is None, and for words their index."""
        return (*COLUMN, *self.model_numbers, *self.shaking.numbers, *Given._fields, *Accuracy._fields)

    @property
    def plan(self) -> Plan:
        """The plan of the runs, with a trace."""
        make: Any = self.kind
        model = make(_EXAMPLE)
        motion = MotionPlan.of(self.shaking.example, {}, np.array([1.0]))
        plan = Plan(model, motion, checked_options({"strobes": 0}))
        return Plan(model, motion, plan.options, traces=EVERY + plan.layout.trace_room)

    @property
    def layout(self) -> Layout:
        """Layout of the rows."""
        shape = self.plan.layout
        return Layout(shape.parameters_at, shape.motion_at, shape.breaks_at)

    def described(self) -> dict[str, Any]:
        """Return the names, the layout and the sizes that a page needs for the program, for JSON."""
        plan, shape = self.plan, self.plan.layout
        kernel = kernel_of(self.kind, shape)
        looks = number_of_looks(plan.rules)
        return {
            "names": self.names,
            "choices": {name: one.choices for name, one in self.model_numbers.items() if one.choices},
            "optional": [name for name, one in self.model_numbers.items() if one.optional],
            "layout": self.layout._asdict(),
            "traces": plan.traces,
            "trace_width": shape.trace_width,
            "row": shape.breaks_at + NOTE * (looks + PAIRS) + plan.traces * shape.trace_width,
            "buffer": kernel.buffer().size,
            "piece": self.shaking.piece,
            "planes": self.kind.planar_rates is not None,
            "switches": bool(self.kind.guards),
        }

    def unit(self, machine: Machine) -> Unit:
        """Return the compiled unit of the program."""
        plan, unit = self.plan, None
        for planar, name in ((False, "advance"), (True, "advance_in_plane")):
            if planar and self.kind.planar_rates is None:
                continue
            compiled = kernel_of(self.kind, plan.shape(planar=planar)).compiled
            if unit is None:
                unit = Unit(lanes=machine.lanes, exact=True, trusted=True, traps=True)
            unit.export(getattr(compiled.module, compiled.name), name, compiled.arguments)
        assert unit is not None
        module = written_module(f"{self.kind.__name__}_{self.shaking}", self.text, self._names_in_text)
        row, numbers = ArrayArgument((None,)), ArrayArgument((len(self.names),))
        pieces = ArrayArgument((None, max(self.shaking.piece, 1)))
        entries = ArrayArgument((None, plan.layout.trace_width))
        for name, arguments in {
            "begin": (row,),
            "judge": (row, NumberKind.FLOAT, ArrayArgument((len(Verdict) + LATE_COLUMNS,))),
            "to_plane": (row,),
            "sampled": (entries, row, ArrayArgument((None, len(Sample)))),
            "demands": (entries, row, NumberKind.FLOAT, ArrayArgument((len(Demand),))),
        }.items():
            unit.export(getattr(module, name), name, (numbers, pieces, *arguments))
        return unit

    def exports(self) -> list[str]:
        """Return the names of the functions of the module."""
        planes = ["advance_in_plane"] if self.kind.planar_rates is not None else []
        return ["advance", *planes, "begin", "judge", "to_plane", "sampled", "demands"]

    def module(self) -> bytes:
        """Return the module of WebAssembly."""
        return module_of(WEB.object_code(self.unit(WEB).module.text("nounwind")), self.exports())

    @property
    def text(self) -> str:
        """Text of the functions with the numbers of a run in place of model and motion."""
        return "\n".join(
            [
                *self._function("begin", "row", "begun(row, {model}, base, given, accuracy, LAYOUT)"),
                *self._function("judge", "row, planar, out", "judged(row, {model}, base, planar, LAYOUT, out)"),
                *self._function("to_plane", "row", "turned(row, {model})"),
                *self._function("sampled", "entries, row, out", "sampling(entries, {model}, base, row, given, out)"),
                *self._function(
                    "demands", "entries, row, friction, out", "demanded(entries, {model}, base, row, friction, out)"
                ),
                "def begun(row, model, base, given, accuracy, layout):",
                "    planar, looks = beginning(row, model, base, given, accuracy, layout)",
                "    return (1 if planar else 0) + (2 if looks else 0)",
            ]
        )

    @property
    def _names_in_text(self) -> dict[str, Any]:
        return {
            "Column": Column,
            "Model": self.kind,
            "Harmonic": Harmonic,
            "Given": Given,
            "Accuracy": Accuracy,
            "LAYOUT": self.layout,
            "AtRest": AtRest,
            "Waves": Waves,
            "Polynomials": Polynomials,
            "Table": Table,
            "beginning": runs.begin,
            "judged": runs.judge,
            "turned": runs.to_plane,
            "sampling": runs.sampled,
            "demanded": demands.demands,
            "isnan": math.isnan,
        }

    def _function(self, name: str, arguments: str, call: str) -> Iterator[str]:
        place = self.names.index
        column = ", ".join(f"{one}=numbers[{place(one)}]" for one in COLUMN)
        yield f"def {name}(numbers, pieces, {arguments}):"
        yield f"    column = Column({column})"
        yield f"    base = {self._base}"
        given, accuracy = place(Given._fields[0]), place(Accuracy._fields[0])
        yield f"    given = Given(*numbers[{given}:{accuracy}])"
        yield f"    accuracy = Accuracy(*numbers[{accuracy}:{accuracy + len(Accuracy._fields)}])"
        yield from _branches(list(self.model_numbers.values()), place, "    ", call, ())

    @property
    def _base(self) -> str:
        """Expression of the base motion."""
        if self.shaking is Shaking.REST:
            return "AtRest()"
        numbers = [f"numbers[{self.names.index(name)}]" for name in self.shaking.numbers]
        if self.shaking is not Shaking.HARMONIC:
            return f"Polynomials(Table({', '.join(numbers)}), pieces)"
        amplitude, phase = (", ".join(numbers[part : part + AXES]) for part in (0, AXES))
        frequency, start_phase = numbers[2 * AXES :]
        return (
            f"Waves(Harmonic(amplitude=({amplitude}), phase=({phase}), angular_frequency={frequency}, "
            f"start_phase={start_phase}, ramp=0.0))"
        )

    def __hash__(self) -> int:
        return hash((self.kind, self.shaking))


_EXAMPLE = Column.solid(radius=0.3, height=3.0, density=2500.0)


def _branches(numbers: Sequence[Parameter], place: Any, indent: str, call: str, made: tuple[str, ...]) -> Iterator[str]:
    """Yield the lines that make a model, one branch for each word and for each number that may be None."""
    if not numbers:
        model = f"Model(column, {', '.join(made)})"
        yield f"{indent}return {call.format(model=model)}"
        return
    one, *rest = numbers
    at = f"numbers[{place(one.name)}]"
    if one.choices:
        for index, word in enumerate(one.choices[1:], start=1):
            yield f"{indent}if {at} == {float(index)!r}:"
            yield from _branches(rest, place, indent + "    ", call, (*made, f"{one.name}={word!r}"))
        yield from _branches(rest, place, indent, call, (*made, f"{one.name}={one.choices[0]!r}"))
        return
    if one.optional:
        yield f"{indent}if isnan({at}):"
        yield from _branches(rest, place, indent + "    ", call, (*made, f"{one.name}=None"))
    yield from _branches(rest, place, indent, call, (*made, f"{one.name}={at}"))


@dataclass(frozen=True)
class CaseProgram:
    """The program for the numbers of columns and harmonic motions: their named constructors.

    Parameters
    ----------
    derived
        Names of the properties of a column that follow its own numbers in the result.
    functions
        Further functions of an array of numbers and one of results, by name, with the lengths of both.
    """

    derived: tuple[str, ...]
    functions: Mapping[str, tuple[Callable[..., Any], int, int]] = field(default_factory=dict)

    @cached_property
    def variants(self) -> Mapping[str, "Variant"]:
        """The constructors, one function for each choice of their optional numbers, by name."""
        columns = {f"column_{shape}": make for shape, make in SHAPES.items()}
        harmonic = {f"motion_{kind}": MOTIONS[kind] for kind in MOTIONS if _makes_harmonic(MOTIONS[kind])}
        return _variants(columns | harmonic, lambda name: (*COLUMN, *self.derived) if name in columns else _OF_HARMONIC)

    def described(self) -> list[dict[str, Any]]:
        """Return the functions with their arguments in the order of their numbers, for JSON."""
        return [one.described() for one in self.variants.values()]

    def unit(self, machine: Machine) -> Unit:
        """Return the compiled unit of the program."""
        unit = Unit(lanes=machine.lanes, exact=True, trusted=True, traps=True)
        for variant in self.variants.values():
            variant.export(unit)
        for name, (function, *lengths) in self.functions.items():
            unit.export(function, name, [ArrayArgument((length,)) for length in lengths])
        return unit

    def module(self) -> bytes:
        """Return the module of WebAssembly."""
        return module_of(WEB.object_code(self.unit(WEB).module.text("nounwind")), [*self.variants, *self.functions])


@dataclass(frozen=True)
class TableProgram:
    """The program for the tables of base motions: of records, and of the named constructors that compile."""

    @cached_property
    def variants(self) -> Mapping[str, "Variant"]:
        """The constructors, one function for each choice of their optional numbers, by name."""
        return _variants({f"motion_{kind}": make for kind, make in MOTIONS.items()}, lambda _: None)

    def described(self) -> dict[str, Any]:
        """Return the functions with their arguments in the order of their numbers, and sizes, for JSON.

        Those for harmonic motions are left out: they are named as those of `CaseProgram`, and have the same arguments.
        """
        variants = [one.described() for one in self.variants.values() if not _makes_harmonic(one.make)]
        return {"variants": variants, "numbers": Table._fields, "pieces": {one.value: one.piece for one in Shaking}}

    def unit(self, machine: Machine) -> Unit:
        """Return the compiled unit of the program."""
        unit = Unit(lanes=machine.lanes, exact=True, trusted=True, traps=True)
        for variant in self.variants.values():
            variant.export(unit)
        step, scale, rotation = (NumberKind.FLOAT,) * 3
        arrays = (ArrayArgument((None, AXES)), step, scale, rotation, _ROWS[Shaking.LINEAR], _OF_TABLE)
        unit.export(record_table, RECORD, arrays)
        return unit

    def module(self) -> bytes:
        """Return the module of WebAssembly."""
        return module_of(WEB.object_code(self.unit(WEB).module.text("nounwind")), [*self.variants, RECORD])


RECORD = "record"
"""Name of the function for records."""

_OF_TABLE = ArrayArgument((len(Table._fields),))
_ROWS = {one: ArrayArgument((None, one.piece)) for one in (Shaking.LINEAR, Shaking.SMOOTH)}


def _variants(
    makes: Mapping[str, Callable[..., Any]], results: Callable[[str], tuple[str, ...] | None]
) -> dict[str, "Variant"]:
    """Return the constructors that compile, one function for each choice of their optional numbers."""
    found = {}
    for name, make in makes.items():
        optional = [one.name for one in parameters_of(make).values() if one.optional]
        for given in chain.from_iterable(combinations(optional, size) for size in range(len(optional) + 1)):
            variant = Variant("_".join((name, *given)), name, make, given, results(name))
            if variant.compiles():
                found[variant.name] = variant
    return found


def _stands_for(make: Callable[..., Any]) -> Any:
    """Return the class of what a constructor makes."""
    return getattr(make, "__self__", make)


_TABLES: Mapping[Any, tuple[str, Callable[..., Any]]] = {
    Harmonic: ("(made.ramp,)", steady_of_wave),
    SineSweep: ("(made.start, made.duration)", steady_of_sweep),
    Pulse: ("(made.start, made.duration)", steady_of_pulse),
}
"""Breaks of the motions of a class, and the function that returns where their bases are."""


def _makes_harmonic(make: Callable[..., Any]) -> bool:
    return _stands_for(make) is Harmonic


_OF_HARMONIC = tuple(
    f"{name}[{k}]" if one.quantity.components > 1 else name
    for name, one in parameters_of(Harmonic).items()
    for k in range(one.quantity.components)
)
"""What is known of a harmonic motion: the numbers `HARMONIC`, and its ramp."""


def declared(one: Parameter) -> dict[str, Any]:
    """Return the declaration of a number, for JSON: a page refuses other values in the words of Python."""
    quantity = one.quantity
    bounds = {name: getattr(quantity, name) for name in ("ge", "gt", "le", "lt")}
    words = {"unit": quantity.unit, "demand": quantity.demand}
    return {"name": one.name, "components": quantity.components, "choices": one.choices, **bounds, **words}


@dataclass(frozen=True, slots=True)
class Variant:
    """A constructor with some of its optional numbers.

    Parameters
    ----------
    name
        Name of the function.
    of
        Name of the constructor.
    make
        The constructor.
    given
        Names of the optional numbers that are given; the others are None.
    results
        Properties of what it makes, as expressions; None for the table of a base motion.
    """

    name: str
    of: str
    make: Callable[..., Any]
    given: tuple[str, ...]
    results: tuple[str, ...] | None

    @property
    def arguments(self) -> list[Parameter]:
        """The numbers of the function, in their order."""
        return [one for one in parameters_of(self.make).values() if not one.optional or one.name in self.given]

    def described(self) -> dict[str, Any]:
        """Return the arguments of the function, for JSON."""
        arguments = [
            {**declared(one), "default": None if one.required or one.optional else one.default}
            for one in self.arguments
        ]
        return {"name": self.name, "of": self.of, "given": self.given, "arguments": arguments}

    def export(self, unit: Unit) -> None:
        """Add the function to a unit."""
        module = written_module(f"case_{self.name}", self._text, {"make": self.make})
        numbers = ArrayArgument((sum(one.quantity.components for one in self.arguments),))
        arguments: tuple[Any, ...] = (numbers, ArrayArgument((len(self.results or ()),)))
        if self.results is None:
            vars(module).update({"table": smooth_table, "steady": self._of_table[1]})
            arguments = (numbers, NumberKind.FLOAT, _ROWS[Shaking.SMOOTH], _OF_TABLE)
        unit.export(getattr(module, self.name), self.name, arguments)

    def compiles(self) -> bool:
        """Return whether the constructor accepts this choice of numbers, whatever their values."""
        try:
            self.export(Unit(lanes=0, exact=True, trusted=True, traps=True))
        except CompileError:
            return False
        return True

    @property
    def _of_table(self) -> tuple[str, Callable[..., Any]]:
        return _TABLES.get(_stands_for(self.make), _TABLES[Pulse])

    @property
    def _text(self) -> str:
        keywords, place = [], 0
        for one in self.arguments:
            numbers = ", ".join(f"numbers[{place + k}]" for k in range(one.quantity.components))
            place += one.quantity.components
            keywords.append(f"{one.name}=({numbers})" if one.quantity.components > 1 else f"{one.name}={numbers}")
        made = f"    made = make({', '.join(keywords)})"
        if self.results is None:
            breaks, _ = self._of_table
            table = f"    return table(made, {breaks}, steady(made), end, rows, out)"
            return "\n".join([f"def {self.name}(numbers, end, rows, out):", made, table])
        results = (f"    out[{k}] = made.{one}" for k, one in enumerate(self.results))
        return "\n".join([f"def {self.name}(numbers, out):", made, *results])


def described() -> dict[str, Any]:
    """Return the columns and sizes of rows, and the codes, of all programs, for JSON."""
    verdict = {one.name.lower(): int(one) for one in Verdict}
    late = {one.name.lower(): len(Verdict) + int(one) for one in Late}
    return {
        "columns": {
            "setup": {one.name.lower(): int(one) for one in Setup},
            "log": {one.name.lower(): LOG + int(one) for one in Log} | {"state": STATE},
            "trace": {one.name.lower(): int(one) for one in Trace},
            "sample": {one.name.lower(): int(one) for one in Sample},
            "verdict": verdict | late,
            "demand": {one.name.lower(): int(one) for one in Demand},
        },
        "given": [name for name in Given._fields if name != "duration"],
        "sizes": {"trace": len(Trace), "sample": len(Sample), "verdict": len(Verdict) + LATE_COLUMNS},
        "codes": {
            **{one.name.lower(): int(one) for one in (RunStatus.RESTED, RunStatus.STEP_LIMIT, RunStatus.UNSEEN)},
            "to_plane": int(RunStatus.TO_PLANE),
            "first_event": int(TraceKind.RELEASE),
            "step": int(TraceKind.STEP),
            "plane_step": int(TraceKind.PLANE_STEP),
        },
    }


def mathematics_module() -> bytes:
    """Return the module of the mathematical functions that the programs import."""
    return module_of(mathematics.object_code(WEB), list(mathematics.FUNCTIONS))
