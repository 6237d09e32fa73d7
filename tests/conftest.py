"""What all tests share: equations (1) written out once more, and settings of hypothesis, linear algebra and Ctrl-C."""

import os
import signal
import sys
import time

# Shells let their background jobs ignore Ctrl-C, which tests send.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
# Read when NumPy is first imported. Processes that test side by side would wait for each other's threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import pytest
from hypothesis import settings
from scipy.integrate import solve_ivp

settings.register_profile("stylobate", deadline=None, derandomize=True)
settings.load_profile("stylobate")


def pytest_collection_modifyitems(items):
    if sys.platform == "win32":
        for item in items:
            if item.get_closest_marker("posix"):
                item.add_marker(pytest.mark.skip(reason="needs POSIX"))


def _no_acceleration(tau):
    del tau
    return 0.0, 0.0, 0.0


def _integrate_equations_1(
    state, span, *, c, eta=0.0, acceleration=_no_acceleration, rtol=1e-12, atol=None, max_step=np.inf, events=None
):
    """Integrate (1) from `state` (α1, α2, α̇1, α̇2), independently of the package; accelerations in g."""

    def rates(tau, y):
        tilt, rate = y[:2], y[2:]
        *horizontal, vertical = acceleration(tau)
        lean = tilt / np.hypot(*tilt)
        return np.concatenate([rate, (1.0 + vertical) * (tilt - c * lean) - eta * rate - np.array(horizontal)])

    atol = 1e-13 * c if atol is None else atol
    return solve_ivp(
        rates, span, state, method="DOP853", rtol=rtol, atol=atol, max_step=max_step, dense_output=True, events=events
    )


@pytest.fixture(scope="session")
def integrate_equations_1():
    return _integrate_equations_1


def _slowness():
    """Return the elapsed time of a computation, in units of its processor time: others compute at the same time."""
    since, used = time.perf_counter(), time.process_time()
    while time.process_time() - used < 0.1:
        pass
    return (time.perf_counter() - since) / (time.process_time() - used)


@pytest.fixture(scope="session")
def slowness():
    return _slowness
