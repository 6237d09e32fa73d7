"""A lane of a kernel in plain Python, for tests of the functions of the driver one by one."""

import math

import numpy as np

from stylobate.engine.kernel.kernels import kernel_of

FAR = 99.0
"""Where nothing is near: events and limits."""

_FAR = dict.fromkeys(("no_return", "tilt_limit", "stop", "longest_step", "end"), FAR)
_NEVER = {f"{stop}_at": math.inf for stop in ("breaks", "lifts", "looks", "pairs", "samples", "strobes")}


class Lane:
    """The first lane of a kernel's buffer, its rows by their names, and the functions of the driver."""

    def __init__(self, plan, model, *, planar=False, **given):
        self.shape = plan.shape(planar=planar)
        kernel = kernel_of(type(model), self.shape)
        self.driver, self._rows = kernel.compiled.module, self.shape.rows()
        self.buffer = np.zeros_like(kernel.buffer())
        self.table, self.pieces = np.zeros((1, 400)), np.zeros((1, 40))
        usual = _FAR | _NEVER | {"leg_ends": math.inf, "most_steps": 1e9}
        parameters = {f"p{j}": number for j, number in enumerate(model.parameters)}
        for name, value in (usual | parameters | given).items():
            self[name] = value

    def __getitem__(self, name):
        return float(self.buffer[self.row(name), 0])

    def __setitem__(self, name, value):
        self.buffer[self.row(name), 0] = value

    def row(self, name):
        """Return the number of a row, given by its name or number."""
        return self._rows[name] if isinstance(name, str) else name

    def do(self, name, *arguments):
        """Call a function of the driver for this lane."""
        return getattr(self.driver, name)(self.buffer, 0, *arguments)

    def scope(self, name):
        """Return the names that a function of the driver uses; a test can replace functions among them."""
        return getattr(self.driver, name).__globals__
