"""A base motion written as one class works alone, in ensembles with its numbers varied, and in files by its place."""

import math
import pickle
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions.base import Acceleration, AngularFrequency
from stylobate.config import SimulationConfig, config_of, read_config, study_config
from stylobate.config.simulation import common_values
from stylobate.errors import ConfigError, ParameterError, UnsupportedError
from stylobate.studies import Sweep

Decay = Annotated[float, sb.Quantity(symbol="δ", unit="1/s", text="decay", ge=0.0)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Decaying(sb.BaseMotion):
    """The acceleration A exp(−δt) cos Ωt along x."""

    peak: Acceleration
    angular_frequency: AngularFrequency
    decay: Decay = 0.1

    def derivative(self, time, order):
        t = np.asarray(time, dtype=float)
        root = complex(-self.decay, self.angular_frequency)
        return np.real(self.peak * root ** (order - 2) * np.exp(root * t)), np.zeros_like(t), np.zeros_like(t)

    def peak_horizontal(self, since=0.0):
        return abs(self.peak) * math.exp(-self.decay * since)

    def vertical_range(self, since=0.0):
        del since
        return 0.0, 0.0

    def directions(self):
        return ((self.peak, 0.0),)

    @property
    def highest_frequency(self):
        return self.angular_frequency + 6.0 * self.decay


COLUMN = sb.Column.solid(radius=0.2, height=2.0, density=2700.0)
MODEL = sb.Slender(COLUMN, damping=0.05)
MOTION = Decaying(peak=2.0, angular_frequency=5.0)
TILT = (0.02, 0.01)
DECAYS, FREQUENCIES = [0.05, 0.4, 0.05, 1.5], [4.0, 4.0, 6.0, 9.0]


def expect_runs_as_alone(motion, parameters, model=MODEL, duration=4.0):
    runs = sb.simulate_ensemble(model, motion, tilt=TILT, duration=duration, parameters=parameters, rtol=1e-10)
    for index in range(runs.sizes["run"]):
        changes = {name: values[index] for name, values in parameters.items()}
        changed = sb.with_parameters(model, motion, **changes)
        alone = sb.simulate(*changed, tilt=TILT, duration=duration, rtol=1e-10, samples=2, recheck=False)
        assert sb.Outcome(int(runs["outcome"][index])) is alone.outcome
        end = np.asarray(alone.data["tilt"])[-1]
        if (
            alone.outcome is sb.Outcome.OVERTURNED
        ):  # it ends when that is certain, by the bounds of a table a little later
            continue
        np.testing.assert_allclose(runs["end_tilt"][index], end, rtol=0.0, atol=1e-6)
    different = np.unique(list(parameters.values()), axis=1).shape[1]
    assert len(np.unique(runs["end_tilt_rate"], axis=0)) == different


@pytest.mark.parametrize("moved", [MOTION, MOTION.rotated(0.3).delayed(0.2)], ids=["itself", "copy"])
@pytest.mark.parametrize(
    "parameters",
    [
        {"decay": DECAYS, "angular_frequency": FREQUENCIES},
        {"decay": DECAYS[1:], "damping": [0.01, 0.02, 0.3], "acceleration": [1.5, 2.5, 3.0]},
    ],
    ids=["its own numbers", "those of the model too"],
)
def test_its_declared_numbers_differ_between_runs(moved, parameters):
    expect_runs_as_alone(moved, parameters)


def test_any_declared_number_of_a_motion_of_the_package_differs_between_runs():
    pulse = sb.Pulse.sinusoidal(acceleration=1.5, angular_frequency=6.0, start=0.2)
    expect_runs_as_alone(pulse, {"cycles": [0.5, 1.0, 2.0], "motion.direction": [0.0, 0.4, 0.4]})
    gabor = sb.Pulse.gabor(velocity=0.6, frequency=1.0, oscillations=2.0)
    expect_runs_as_alone(gabor, {"oscillations": [1.0, 2.0], "angular_frequency": [5.0, 7.0]})
    sweep = sb.SineSweep.linear(acceleration=1.0, frequencies=(0.5, 2.0), length=5.0)
    expect_runs_as_alone(sweep, {"length": [3.0, 5.0], "start_phase": [0.1, 0.0]})
    shaking = sb.Harmonic.straight(acceleration=2.0, angular_frequency=5.0)
    expect_runs_as_alone(shaking.rotated(0.2), {"ramp": [0.0, 0.5, 2.0], "start_phase": [0.1, 0.0, 1.0]})


@dataclass(frozen=True, slots=True)
class Slow(sb.Slender):
    """A model with a number that has the name of one of the motion."""

    decay: Decay = 0.0


def test_a_number_of_the_motion_whose_name_the_model_has_is_named_with_its_part():
    _, changed = sb.with_parameters(Slow(COLUMN), MOTION, **{"decay": 0.3, "motion.decay": 0.7})
    assert changed.decay == 0.7
    expect_runs_as_alone(MOTION, {"motion.decay": [0.2, 0.9]}, model=Slow(COLUMN, damping=0.05))


def test_what_it_cannot_have_is_refused_from_its_declarations():
    with pytest.raises(ParameterError, match=r"decay must be zero or positive, got -0.1 1/s"):
        Decaying(peak=1.0, angular_frequency=2.0, decay=-0.1)
    with pytest.raises(ParameterError, match=r"decay must be zero or positive, got -0.2"):
        sb.simulate_ensemble(MODEL, MOTION, duration=1.0, parameters={"decay": [0.1, -0.2]})
    with pytest.raises(UnsupportedError, match=r"start_phase: .* Its numbers are peak, angular_frequency, decay"):
        sb.simulate_ensemble(MODEL, MOTION, duration=1.0, parameters={"start_phase": [0.1]})
    with pytest.raises(ParameterError, match=r"acceleration: a method of every base motion"):
        type("Wrong", (sb.BaseMotion,), {"__annotations__": {"acceleration": float}})


FILE = """
import math
from dataclasses import dataclass
from typing import Annotated
import numpy as np
import stylobate as sb
from stylobate.base_motions.base import Acceleration, AngularFrequency
{}

@dataclass(frozen=True, slots=True)
class Tethered(sb.Slender):
    tether: Annotated[float, sb.Quantity(symbol="k", text="stiffness of the tether", ge=0.0)] = 0.0
"""

STUDY = """
duration = 3.0
tilt = [0.01, 0.0]
column = {radius = 0.2, height = 2.0, density = 2700.0}
model = {kind = "own.py:Tethered", tether = 0.2}
motion = {kind = "scaled", factor = 0.5, motion = {kind = "own.py:Decaying", peak = 2.0, angular_frequency = 5.0}}
"""


@pytest.fixture
def study(tmp_path):
    lines = Path(__file__).read_text(encoding="utf-8")
    source = lines[lines.index("Decay = ") : lines.index("COLUMN = ")]
    (tmp_path / "own.py").write_text(FILE.replace("{}", source), encoding="utf-8")
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path / "study.toml"


def test_a_file_names_it_by_its_place_and_a_saved_result_repeats_it(study, monkeypatch, tmp_path):
    setup = SimulationConfig.parse(read_config(study)).build()
    assert setup.motion == type(setup.motion.motion)(peak=2.0, angular_frequency=5.0).scaled(0.5)
    run = sb.simulate(setup.model, setup.motion, **setup.options)
    run.save(tmp_path / "run.nc")
    kept = sb.load(tmp_path / "run.nc").provenance
    monkeypatch.chdir("/")
    assert kept["model"] == {"kind": f"{tmp_path / 'own.py'}:Tethered", "damping": 0.0, "tether": 0.2}
    again = config_of(kept).build()
    assert (again.model, again.motion) == (setup.model, setup.motion)
    axes = {"x": {"name": "decay", "values": [0.1, 0.2]}, "y": {"name": "tether", "values": [0.0, 0.2]}}
    assert study_config(sb.studies.overturning_map).parse({**read_config(study), "map": axes}).build().options["over"][
        "decay"
    ].tolist() == [0.1, 0.2]


def test_a_sweep_tells_apart_the_code_behind_a_place(study):
    setup = SimulationConfig.parse(read_config(study)).build()
    found = Sweep.points(setup.model, setup.motion, at={"decay": [0.1]}, duration=1.0).describe()
    assert all("source_sha256" in found[f"{part} code"] for part in ("model", "motion"))
    assert "code" not in " ".join(common_values(found))


def test_a_class_from_a_file_goes_to_another_process(study, tmp_path):
    setup = SimulationConfig.parse(read_config(study)).build()
    (tmp_path / "thing").write_bytes(pickle.dumps((setup.model, setup.motion)))
    program = f"import pickle; print(pickle.load(open({str(tmp_path / 'thing')!r}, 'rb')))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd="/")
    assert done.stdout.strip() == repr((setup.model, setup.motion))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"model": {"kind": "own.py:Tethered", "tether": -1.0}}, "model: tether must be zero or positive, got -1.0"),
        ({"model": {"kind": "own.py:Tethered", "teter": 1.0}}, "model.teter does not belong to model"),
        ({"model": {"kind": "own.py:Nothing"}}, "kind: cannot load .*Nothing"),
        ({"model": {"kind": "own.py:Decaying"}}, "model.kind: no model .* Name a subclass of Model"),
        ({"model": {"kind": "slendr"}}, "did you mean slender?"),
        ({"motion": {"kind": "none.py:Nothing"}}, "kind: cannot load .*none.py"),
        ({"motion": {"kind": "os:getcwd"}}, "motion.kind: no motion .* Name a subclass of BaseMotion"),
        ({"motion": {"kind": "circullar"}}, "did you mean circular?"),
    ],
)
def test_a_mistake_in_a_file_is_told_in_a_line(study, change, told):
    lines = [line for line in STUDY.splitlines() if line.partition(" ")[0] not in change]
    tables = [f"[{part}]\n" + "\n".join(f"{n} = {v!r}" for n, v in one.items()) for part, one in change.items()]
    study.write_text("\n".join([*lines, *tables]), encoding="utf-8")
    with pytest.raises(ParameterError, match=told):
        SimulationConfig.parse(read_config(study)).build()


def test_values_that_no_file_of_the_users_holds_load_nothing(study):
    values = read_config(study)
    for kind in ("os:system", f"{study.parent / 'own.py'}:Decaying"):
        with pytest.raises(ConfigError, match="from a TOML file or a saved result only"):
            SimulationConfig.parse({**values, "motion": {"kind": kind}})
