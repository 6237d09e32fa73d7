"""One implicit step of a kernel, in plain Python, on linear problems of which the result is known."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.elementary import NewtonRoom
from stylobate.engine.ensembles.batch import Plan
from stylobate.engine.ensembles.run_columns import MotionPlan
from stylobate.engine.kernel.driver import implicit_step
from stylobate.engine.kernel.kernels import kernel_of
from stylobate.run_arguments import checked_options

RTOL = 1e-13


class Linear:
    """The rates of a kernel replaced by those of a linear problem for all but the kind of contact."""

    def __init__(self, monkeypatch, matrix):
        model = sb.Sliding(sb.Column.solid(radius=0.5, height=3.0, density=2700.0))
        motion = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)
        options = checked_options({"rtol": RTOL, "max_steps": 1000})
        kernel = kernel_of(sb.Sliding, Plan(model, MotionPlan.of(motion, {}, np.ones(1)), options).shape(planar=False))
        self.module, self.rows = kernel.compiled.module, kernel.shape.rows()
        self.order = order = kernel.shape.order
        self.matrix = np.zeros((order, order))
        self.matrix[: len(matrix), : len(matrix)] = matrix
        scope = self.module.set_jacobian.__globals__
        monkeypatch.setitem(scope, "rates_at", lambda buf, i, t, state: tuple(self.matrix @ np.array(state)))
        self.buf = np.zeros((len(self.rows), kernel.shape.width))
        self.buf[self.rows["rtol"]] = RTOL
        self.buf[self.rows["atol_now"]] = 1e-3 * RTOL
        changes = implicit_step.STAGES * order
        self.room = NewtonRoom(
            change=np.zeros(changes),
            correction=np.zeros(changes),
            jacobian=np.zeros((order, order)),
            coupled=np.zeros(order),
            single=np.zeros((order, order)),
            single_pivots=np.zeros(order),
            double=np.zeros((2 * order, 2 * order)),
            double_pivots=np.zeros(2 * order),
            real=np.zeros(order),
            turned=np.zeros(2 * order),
        )

    def state(self, name):
        first = self.rows[f"{name}0"]
        return self.buf[first : first + self.order, 0]

    def step(self, h, start):
        """Make a step from this state; return the number of iterations."""
        self.state("y")[:] = start
        self.state("k0_")[:] = self.matrix @ self.state("y")
        self.number = self.module.set_jacobian(self.buf, 0, 0, self.room)
        self.room.change[:] = 0.0
        return self.module.solve_step(self.buf, 0, h, self.number, self.room)

    @property
    def jacobian(self):
        """The Jacobian with a column for each state."""
        whole = np.zeros((self.order, self.order))
        whole[:, self.room.coupled[: self.number].astype(int)] = self.room.jacobian[:, : self.number]
        return whole

    @property
    def end(self):
        return self.state("y") + self.room.change[2 * self.order :]

    def error(self, h):
        slopes = tuple(self.state("k0_"))
        return self.module.error_of_changes(self.buf, 0, h, slopes, self.number, self.room)


def growth(z):
    """Return by how much a solution of y' = λy grows in a step, z = hλ: the stability function, of order 5."""
    return (1.0 + 0.4 * z + 0.05 * z * z) / (1.0 - 0.6 * z + 0.15 * z * z - z**3 / 60.0)


@pytest.mark.parametrize("rate", [1e-2, 1.0, 1e3, 1e8])
def test_a_step_of_a_linear_problem_is_that_of_its_stability_function(monkeypatch, rate):
    problem = Linear(monkeypatch, -rate * np.eye(15))
    assert problem.step(0.7, np.linspace(0.1, 1.0, 16)) > 0
    expected = growth(-0.7 * rate) * np.linspace(0.1, 1.0, 16)[:15]
    np.testing.assert_allclose(problem.end[:15], expected, rtol=1e-10, atol=1e-12)


def test_a_step_of_an_oscillation_is_that_of_its_stability_function(monkeypatch):
    problem = Linear(monkeypatch, np.kron(np.eye(7), [[0.0, 3.0], [-3.0, 0.0]]))
    start = np.zeros(16)
    start[:14:2] = 1.0
    assert problem.step(0.4, start) > 0
    # y₁ + i y₂ turns clockwise.
    np.testing.assert_allclose(problem.end[0:14:2], growth(-1.2j).real, rtol=1e-11)
    np.testing.assert_allclose(problem.end[1:14:2], growth(-1.2j).imag, rtol=1e-11)


def test_states_on_which_no_rate_depends_follow_from_the_others(monkeypatch):
    # Two states turn and decay fast; a third is the integral of their sum, a fourth does not change.
    matrix = np.array([[-2e3, 3.0, 0.0, 0.0], [-3.0, -1.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]])
    problem = Linear(monkeypatch, matrix)
    start = np.array([1.0, 0.5, 0.2, 0.1, *np.zeros(12)])
    assert problem.step(0.1, start) > 0
    assert problem.room.coupled[: problem.number].tolist() == [0.0, 1.0]
    # All states at once: (I − h A ⊗ J) changes = h A ⊗ J start, with the stages of SciPy's method.
    stages = np.linalg.inv(implicit_step.SLOPES)
    whole = np.eye(12) - 0.1 * np.kron(stages, matrix)
    changes = np.linalg.solve(whole, 0.1 * np.kron(stages.sum(axis=1), matrix @ start[:4]))
    found = problem.room.change.reshape(3, 16)[:, :4]
    np.testing.assert_allclose(found, changes.reshape(3, 4), rtol=1e-10, atol=1e-12)


def test_the_estimate_of_the_error_is_of_order_three_and_damped_where_it_is_stiff(monkeypatch):
    problem = Linear(monkeypatch, -np.eye(15))
    errors = []
    for h in (0.02, 0.01):
        problem.step(h, np.ones(16))
        errors.append(problem.error(h))
    assert errors[0] / errors[1] == pytest.approx(2.0**4, rel=0.03)
    stiff = Linear(monkeypatch, -1e9 * np.eye(15))
    stiff.step(1.0, np.ones(16))
    raw = stiff.error(1.0)
    # What has faded is all of the error, and once corrected nothing is left of it.
    assert raw == pytest.approx(1.0 / RTOL, rel=0.1)
    assert stiff.module.damped_error(stiff.buf, 0, 1.0, stiff.number, stiff.room) < 1e-6 * raw


def test_the_dense_output_passes_through_the_changes_at_the_nodes(monkeypatch):
    problem = Linear(monkeypatch, -2.0 * np.eye(15))
    problem.step(0.3, np.ones(16))
    problem.module.set_cubic(problem.buf, 0, problem.room.change)
    for stage, node in enumerate(implicit_step.NODES):
        change = problem.room.change[stage * problem.order : (stage + 1) * problem.order]
        np.testing.assert_allclose(problem.module.dense_state(problem.buf, 0, node), 1.0 + change, rtol=1e-14)


def test_the_fastest_rate_is_the_largest_eigenvalue(monkeypatch):
    problem = Linear(monkeypatch, np.diag([-3.0, -5e4, *(-1.0,) * 13]))
    problem.step(1e-3, np.ones(16))
    np.testing.assert_allclose(problem.jacobian, problem.matrix, rtol=1e-6, atol=1e-4)
    assert problem.module.fastest_rate(problem.number, problem.room) == pytest.approx(5e4, rel=1e-6)


@pytest.mark.parametrize("slip", [(2e-6, 0.0), (0.0, 2e-6), (-1e-6, 3e-6)])
def test_the_jacobian_follows_the_direction_of_slip_however_slow(monkeypatch, slip):
    problem = Linear(monkeypatch, np.zeros((15, 15)))
    first = problem.rows["y8"] - problem.rows["y0"]

    def friction(_buf, _i, _t, state):
        force, speed = np.zeros(16), np.hypot(*state[first : first + 2])
        force[first : first + 2] = -np.array(state[first : first + 2]) / speed
        return tuple(force)

    monkeypatch.setitem(problem.module.set_jacobian.__globals__, "rates_at", friction)
    problem.state("y")[first : first + 2] = slip
    problem.state("k0_")[:] = friction(None, 0, 0.0, problem.state("y"))
    problem.number = problem.module.set_jacobian(problem.buf, 0, 0, problem.room)
    speed = np.hypot(*slip)
    expected = (np.outer(slip, slip) / speed**2 - np.eye(2)) / speed
    # Differences of a thousandth of the slip velocity.
    found = problem.jacobian[first : first + 2, first : first + 2]
    np.testing.assert_allclose(found, expected, rtol=3e-3, atol=3e-3 / speed)
