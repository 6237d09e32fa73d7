"""Functions compiled by themselves, called with arrays."""

import ctypes

import numpy as np

from stylobate.compiler import machine
from stylobate.compiler.unit import ArrayArgument, Unit
from stylobate.compiler.values import Element


def text_of(function, *arrays, lanes=8, fast=()):
    """Return the text of a function of a program, which takes these arrays, their shapes told at the call."""
    unit = Unit(lanes=lanes, fast=fast, trusted=True)
    unit.export(function, "exported", [_argument(array) for array in arrays])
    return unit.module.text(machine.native().attributes)


def call_compiled(function, *arrays, lanes=8):
    """Compile a function, call it with these arrays and return what it returns."""
    engine = machine.linked(machine.native().object_code(text_of(function, *arrays, lanes=lanes)))
    passed = [value for array in arrays for value in (array.ctypes.data, *array.shape)]
    kinds = [kind for array in arrays for kind in (ctypes.c_void_p, *[ctypes.c_int64] * array.ndim)]
    return ctypes.CFUNCTYPE(ctypes.c_int64, *kinds)(engine.get_function_address("exported"))(*passed)


def both_ways(function, *arrays, lanes=8):
    """Return what a function makes of these arrays when compiled, and as plain Python; the results last."""
    outcomes = []
    for call in (lambda *copies: call_compiled(function, *copies, lanes=lanes), function):
        copies = [array.copy() for array in arrays]
        with np.errstate(all="ignore"):
            returned = call(*copies)
        outcomes.append((copies, 0 if returned is None else int(returned)))
    return outcomes


def _argument(array):
    return ArrayArgument((None,) * array.ndim, Element.SIGNAL if array.dtype == np.uint8 else Element.FLOAT)
