"""Models whose numbers are arrays have the same bits as one object for each run."""

import warnings
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.ensembles.model_columns import ModelColumns, RunModels
from stylobate.engine.verdict import energy_over_balance
from stylobate.errors import ParameterError, UnlikelyInputWarning
from stylobate.models.declared import MODELS
from stylobate.quantities import Quantity, parameters_of

COLUMN = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
COUNT = 200


def draws(model: type, seed: int) -> dict[str, np.ndarray]:
    """Draw all numbers of a class of models that an ensemble can vary, and of its column."""
    rng = np.random.default_rng(seed)
    near = {name: getattr(COLUMN, name) * rng.uniform(0.999, 1.001, COUNT) for name in ("mass", "gravity")}
    own = {
        name: rng.uniform(*(one.quantity.slider or (0.0, 0.1)), COUNT)
        for name, one in parameters_of(model).items()
        if not one.choices
    }
    if "static_friction_coefficient" in own:
        own["static_friction_coefficient"] = own["friction_coefficient"] + own["static_friction_coefficient"]
    return near | {"slenderness": rng.uniform(0.05, 0.3, COUNT), "size": rng.uniform(0.2, 5.0, COUNT)} | own


@pytest.mark.parametrize("kind", MODELS.values(), ids=lambda kind: kind.__name__)
def test_models_evaluated_at_once_have_the_bits_of_objects(kind: type, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(0)
    values = draws(kind, 1)
    starts = rng.uniform(-0.05, 0.05, (COUNT, 2)), rng.uniform(-0.1, 0.1, (COUNT, 2)), rng.uniform(-1.0, 1.0, COUNT)
    together = ModelColumns.of(kind(COLUMN), values, COUNT)
    states = together.starts(*starts)
    made = []
    monkeypatch.setattr(RunModels, "_together", lambda *_: made.append(1))
    alone = ModelColumns.of(kind(COLUMN), values, COUNT)
    assert np.array_equal(states, alone.starts(*starts))
    assert made == [1, 1]
    for name in ModelColumns.__slots__[1:]:
        assert np.array_equal(getattr(together, name), getattr(alone, name)), name


@pytest.mark.parametrize("kind", MODELS.values(), ids=lambda kind: kind.__name__)
def test_only_two_objects_are_made_for_many_models(kind: type, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[int] = []
    objects = RunModels._new_objects
    monkeypatch.setattr(RunModels, "_new_objects", lambda self, runs: made.append(len(runs)) or objects(self, runs))
    columns = ModelColumns.of(kind(COLUMN), draws(kind, 2), COUNT)
    columns.starts(np.zeros((COUNT, 2)), np.zeros((COUNT, 2)), np.zeros(COUNT))
    assert made == [1, 1]


@pytest.mark.parametrize("kind", [one for one in MODELS.values() if one.__name__ != "Sliding"])
def test_the_energy_over_that_of_the_balance_is_evaluated_at_once(kind: type) -> None:
    rng = np.random.default_rng(3)
    models = RunModels(kind(COLUMN), draws(kind, 3), COUNT)
    states = rng.uniform(-0.05, 0.05, (len(kind.state_names), COUNT))

    def over(model: sb.Model, runs: object) -> dict[str, np.ndarray]:
        return {"over": energy_over_balance(model, states[:, runs], 0.01)}  # type: ignore[call-overload]

    assert models._together(over) is not None
    alone = np.concatenate([over(model, runs)["over"] for model, runs in models._objects(np.arange(COUNT))])
    found = models.evaluate(over)["over"]
    order = np.concatenate([runs for _, runs in models._objects(np.arange(COUNT))])  # type: ignore[arg-type]
    assert np.array_equal(found[order], alone)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("damping", -0.1, r"damping must be zero or positive, got -0\.1"),
        ("slenderness", -0.1, r"slenderness must be positive, got -0\.1"),
        ("size", 1e200, "size: too large to compute with"),
        ("axial_inertia", 1e9, "axial_inertia must be at most twice transverse_inertia"),
        ("mass_height", 4.0, "mass_height must lie inside the body"),
    ],
)
def test_a_refused_number_among_many_has_the_message_of_its_object(name: str, value: float, words: str) -> None:
    model = sb.Slender(COLUMN, damping=0.1)
    values = np.full(50, getattr(model if name == "damping" else COLUMN, name, 1.0))
    values[17] = value
    motion = sb.Harmonic.circular(acceleration=1.0, angular_frequency=3.0)
    with pytest.raises(ParameterError, match=words):
        sb.simulate_ensemble(model, motion, duration=1.0, parameters={name: values})


def test_an_unlikely_number_among_many_is_questioned() -> None:
    values = np.linspace(0.2, 0.4, 50)
    values[7] = 30.0
    with pytest.warns(UnlikelyInputWarning, match="radius: 30 m is unlikely"):
        ModelColumns.of(sb.Slender(COLUMN), {"radius": values}, 50)


@dataclass(frozen=True, slots=True)
class Capped(sb.Slender):
    """A slender column whose damping is never above a number; its property computes with single numbers only."""

    cap: Annotated[float, Quantity(ge=0.0, text="largest damping")] = 0.1

    @property
    def parameters(self) -> tuple[float, ...]:
        """c, the capped damping, and κ."""
        return self.column.slenderness, min(self.damping, self.cap), self.column.inertia_ratio


@dataclass(frozen=True, slots=True)
class Averaging(sb.Slender):
    """A slender column whose property is wrong for arrays without an error."""

    @property
    def parameters(self) -> tuple[float, ...]:
        """c, the damping, and κ."""
        return self.column.slenderness, float(np.mean(self.damping)), self.column.inertia_ratio


@dataclass(frozen=True, slots=True)
class Refusing(sb.Slender):
    """A slender column with a check of its own."""

    def validate(self) -> None:
        """Refuse a damping above 0.2."""
        if self.damping > 0.2:
            raise ParameterError("damping: above 0.2")


@pytest.mark.parametrize("kind", [Capped, Averaging])
def test_a_model_that_does_not_compute_with_arrays_has_objects(kind: type) -> None:
    damping = np.linspace(0.05, 0.2, 20)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = ModelColumns.of(kind(COLUMN), {"damping": damping}, 20)
    assert np.array_equal(found.parameters[:, 1], np.minimum(damping, 0.1) if kind is Capped else damping)


def test_a_check_of_a_users_model_sees_each_run() -> None:
    damping = np.full(20, 0.1)
    damping[9] = 0.3
    with pytest.raises(ParameterError, match=r"damping: above 0\.2"):
        ModelColumns.of(Refusing(COLUMN), {"damping": damping}, 20)
