"""Objects of dataclasses in compiled code: columns, models and motions have the numbers that Python gives them."""

import ctypes
from dataclasses import dataclass, replace

import numpy as np
import pytest

import stylobate as sb
from stylobate.compiler.machine import linked, native
from stylobate.compiler.marks import stands_for
from stylobate.compiler.sources import CompileError, written_module
from stylobate.compiler.unit import ArrayArgument, Unit
from stylobate.models.declared import MODELS

RNG = np.random.default_rng(3)
DERIVED = (
    *("mass", "mass_height", "transverse_inertia", "axial_inertia", "gravity", "slenderness", "base_inertia"),
    *("frequency_scale", "tipping_angle", "housner_restitution", "consistent"),
)


def compiled(name, text, names, lengths, *, traps=True):
    """Return the machine code of a function of arrays of these lengths, as a function that returns the last one."""
    module = written_module(f"objects_{name}", text, names)
    unit = Unit(lanes=0, exact=True, trusted=True, traps=traps)
    unit.export(getattr(module, name), name, [ArrayArgument((length,)) for length in lengths])
    engine = linked(native().object_code(unit.module.text("nounwind")))
    function = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_void_p] * len(lengths))(engine.get_function_address(name))

    def call(*arrays):
        given = [np.array(one, dtype=float) for one in arrays]
        out = np.zeros(lengths[-1])
        function(*(ctypes.c_void_p(one.ctypes.data) for one in (*given, out)))
        return out

    vars(call)["engine"] = engine
    return call


@pytest.mark.parametrize(
    ("make", "names", "low", "high"),
    [
        (sb.Column.solid, ("radius", "height", "density"), (0.1, 1.0, 500.0), (1.0, 9.0, 3000.0)),
        (sb.Column.solid, ("radius", "height", "mass"), (0.1, 1.0, 500.0), (1.0, 9.0, 3000.0)),
        (sb.Column.hollow, ("radius", "inner_radius", "height", "density"), (0.5, 0.1, 2, 900), (0.9, 0.4, 5, 2000)),
        (sb.Column.frustum, ("radius", "top_radius", "height", "density"), (0.3, 0.1, 2, 900), (0.9, 0.9, 5, 2000)),
        (sb.Column.dimensionless, ("slenderness", "inertia_ratio", "axial_ratio"), (0.05, 0.5, 0.2), (0.3, 0.8, 0.5)),
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)
def test_columns_have_the_bits_of_python(make, names, low, high):
    arguments = ", ".join(f"{name}=given[{k}]" for k, name in enumerate(names))
    lines = [f"    out[{k}] = made.{name}" for k, name in enumerate(DERIVED)]
    text = "\n".join(["def column(given, out):", f"    made = make({arguments})", *lines])
    function = compiled("column", text, {"make": make}, (len(names), len(DERIVED)))
    for _ in range(50):
        values = RNG.uniform(low, high)
        column = make(**dict(zip(names, values.tolist(), strict=True)))
        assert function(values).tolist() == [float(getattr(column, name)) for name in DERIVED]


@pytest.mark.parametrize("kind", MODELS)
def test_models_have_the_bits_of_python(kind):
    model = MODELS[kind](sb.Column.solid(radius=0.3, height=3.0, density=2500.0))
    count = len(model.parameters)
    text = f"""
def model(given, out):
    made = make(Column(
        radius=given[0], mass_height=given[1], mass=given[2], transverse_inertia=given[3], axial_inertia=given[4]
    ))
    out[0], out[1], out[2], out[3] = made.time_scale, made.rest_capacity, made.comes_to_rest, made.loss_tilt
    numbers, states = made.parameters, made.start((0.01, 0.02), (0.3, given[5]))
    for k in range({count}):
        out[4 + k] = numbers[k]
    for k in range({len(model.state_names)}):
        out[{4 + count} + k] = states[k]
"""
    length = 4 + count + len(model.state_names)
    function = compiled("model", text, {"make": MODELS[kind], "Column": sb.Column}, (6, length))
    column = model.column
    given = [column.radius, column.mass_height, column.mass, column.transverse_inertia, column.axial_inertia, 0.4]
    known = [model.time_scale, model.rest_capacity, model.comes_to_rest, model.loss_tilt, *model.parameters]
    known += model.start((0.01, 0.02), (0.3, 0.4))
    # the columns differ in their height, which no model uses
    assert function(given).tolist() == [float(one) for one in known]


@dataclass(frozen=True)
class Box:
    """A box with a default, a property, methods and a class method."""

    width: float
    height: float = 2.0
    name: str | None = None

    @property
    def area(self):
        """Its area."""
        return self.width * self.height

    def scaled(self, factor, *, upwards=False):
        """Scale it."""
        if upwards:
            return replace(self, height=factor * self.height)
        return Box(factor * self.width, factor * self.height, self.name)

    @classmethod
    def square(cls, width):
        """Make a square."""
        return cls(width, height=width, name="square")

    @classmethod
    def checked(cls, width):
        """Make a square of a width that is not negative."""
        if width < 0.0:
            raise ValueError(width)
        return cls.square(width)


def smaller(first, second):
    return first if first.area < second.area else second


def boxes(given, out):
    box = Box.square(given[0])
    out[0] = box.area
    out[1] = box.scaled(3.0).area
    out[2] = box.scaled(3.0, upwards=True).height
    chosen = smaller(box, Box.square(given[1]))
    out[3] = chosen.width
    out[4] = Box(given[1]).area
    first, *others, last = box.width, 1.0, 2.0, box.height
    out[5] = sum(others) + first - last
    out[6] = 1.0 if (box.width > 1.0) & ~(box.height > 5.0) else 0.0
    out[7] = len((0.0,) * 3)


def test_objects_are_passed_chosen_changed_and_returned():
    names = {"Box": Box, "smaller": smaller, "boxes": boxes}
    function = compiled("run", "def run(given, out):\n    boxes(given, out)\n", names, (2, 8))
    for widths in RNG.uniform(0.5, 7.0, (20, 2)):
        known = np.zeros(8)
        boxes(widths, known)
        assert function(widths).tolist() == known.tolist()


def test_what_may_raise_is_compiled_only_where_errors_end_the_program():
    text = "def run(given, out):\n    out[0] = Box.checked(given[0]).area\n"
    assert compiled("run", text, {"Box": Box}, (1, 1))([3.0]).tolist() == [9.0]
    with pytest.raises(CompileError, match="Raise is not compiled"):
        compiled("run", text, {"Box": Box}, (1, 1), traps=False)


def test_another_function_can_stand_for_one():
    def plainly(x):
        return 2.0 * x

    def decorated(*values):
        return plainly(*values)

    text = "def run(given, out):\n    out[0] = function(given[0])\n"
    function = compiled("run", text, {"function": stands_for(decorated, plainly)}, (1, 1))
    assert function([4.0]).tolist() == [8.0]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("Box(height=1.0).area", "Box needs width"),
        ("Box(1.0, depth=given[0]).area", "Box has no depth"),
        ("Box(given[0]).volume", "Box has no volume"),
        ("replace(given[0], width=1.0).area", "replace needs an object"),
    ],
)
def test_wrong_uses_of_objects_are_refused(line, words):
    text = f"def run(given, out):\n    out[0] = {line}\n"
    with pytest.raises(CompileError, match=words):
        compiled("run", text, {"Box": Box, "replace": replace}, (1, 1))
