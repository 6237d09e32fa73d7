"""Programs of runs for pages: Node computes the runs of `simulate`, and the numbers of the constructors of Python."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate.column.shapes import SHAPES
from stylobate.engine.standalone import programs
from stylobate.engine.standalone.programs import CaseProgram, RunProgram, Shaking
from stylobate.models.declared import MODELS
from stylobate.quantities import parameters_of

WEB = Path(sb.__file__).parent / "lab" / "web"
BUNDLER = WEB / "node_modules" / ".bin" / "esbuild"
COMMON = programs.described()
VERDICT, SAMPLE, LOG = (COMMON["columns"][name] for name in ("verdict", "sample", "log"))
SAMPLES = 301

pytestmark = [
    pytest.mark.system,
    pytest.mark.skipif(shutil.which("node") is None or not BUNDLER.exists(), reason="needs Node and esbuild"),
]


@pytest.fixture(scope="module")
def runner(tmp_path_factory):
    """Bundle the script that runs cases by a program."""
    made = tmp_path_factory.mktemp("runner") / "run-cases.mjs"
    script = WEB / "test" / "kernels" / "run-cases.ts"
    options = ["--bundle", "--platform=node", "--format=esm", "--log-level=error", f"--outfile={made}"]
    subprocess.run([str(BUNDLER), str(script), *options], check=True, timeout=60)
    return made


def case(kind, rng, program):
    """Return arguments of `simulate` for a random case, and the numbers of the program for it."""
    column = sb.Column.solid(radius=rng.uniform(0.15, 0.5), height=3.0, density=2500.0)
    own = {}
    for name, one in program.model_numbers.items():
        own[name] = rng.choice(one.choices).item() if one.choices else None if one.optional else rng.uniform(0.01, 0.2)
        if name == "restitution":
            own[name] = None if one.optional else rng.uniform(0.7, 1.0)
    model = MODELS[kind](column, **own)
    frequency = rng.uniform(1.5, 6.0)
    planar = kind == "planar_rocking" or rng.random() < 0.3
    size = rng.uniform(0.4, 1.6) * column.slenderness * column.gravity
    motion = sb.Harmonic(
        amplitude=(size, 0.0 if planar else size, 0.0),
        phase=(0.0, -np.pi / 2.0, 0.0),
        angular_frequency=frequency,
    )
    tilt = rng.uniform(0.0, 0.5) * column.slenderness * np.array([1.0, 0.0 if planar else 0.3])
    tilt = tilt * (rng.random() < 0.7)
    duration = rng.choice([10.0, 60.0 / frequency * np.pi, 220.0 / frequency * np.pi])
    numbers = {
        **{name: getattr(column, name) for name in programs.COLUMN},
        **{
            name: np.nan if own[name] is None else one.choices.index(own[name]) if one.choices else own[name]
            for name, one in program.model_numbers.items()
        },
        **dict(zip(programs.HARMONIC, (*motion.amplitude, *motion.phase, frequency, 0.0), strict=True)),
        **dict.fromkeys(programs.Given._fields, 0.0),
        "tilt_x": tilt[0],
        "tilt_y": tilt[1],
        "duration": duration,
        "rtol": 1e-8,
        "max_steps": 2e5,
        "traces": program.plan.traces,
        "rest_share": 1.0,
        "passage_share": 1.0,
    }
    start = {"tilt": tuple(tilt.tolist()), "duration": float(duration)}
    return (model, motion, start), [numbers[name] for name in program.names]


def in_node(runner, folder, program, rows):
    """Run the cases in Node; return a function that reads what it wrote."""
    (folder / "program.wasm").write_bytes(program.module())
    (folder / "mathematics.wasm").write_bytes(programs.mathematics_module())
    np.array(rows, dtype=float).tofile(folder / "numbers")
    asked = {"common": COMMON, "described": program.described(), "cases": len(rows), "samples": SAMPLES}
    (folder / "asked.json").write_text(json.dumps(asked))
    subprocess.run(["node", str(runner), str(folder)], check=True, timeout=600, capture_output=True)
    return lambda name, k: np.fromfile(folder / f"{name}{k}")


def compare(kind, count, runner, folder, seed=5):
    """Compare runs of Node with those of `simulate`.

    Kernels of this machine use fast arithmetic and the library of C: they differ by rounding, which chaotic motions
    amplify. Outcomes and most samples agree, nine in ten to 1e-7.
    """
    rng, program = np.random.default_rng(seed), RunProgram(MODELS[kind], Shaking.HARMONIC)
    cases = [case(kind, rng, program) for _ in range(count)]
    read = in_node(runner, folder, program, [row for _, row in cases])
    apart = []
    for k, ((model, motion, start), _) in enumerate(cases):
        run = sb.simulate(model, motion, **start, recheck=False, samples=SAMPLES)
        verdict, row = read("verdict", k), read("row", k)
        samples = read("samples", k).reshape(SAMPLES, -1)
        assert sb.Outcome(int(verdict[VERDICT["outcome"]])) is run.outcome, start
        assert bool(verdict[VERDICT["uncertain"]]) == run.uncertain
        assert row[LOG["peak_tilt"]] == pytest.approx(run.measures["peak_tilt"], rel=1e-4, abs=1e-12)
        known = {
            "tilt": run.data["tilt"],
            "acceleration": run.data["base_acceleration"],
            "base": run.data["base_displacement"],
            **{name: run.data[name] for name in ("twist", "footprint") if name in run.data},
        }
        for name, values in known.items():
            columns = [at for key, at in SAMPLE.items() if key in (name, *(f"{name}_{axis}" for axis in "xyz"))]
            if name == "tilt":
                columns = [SAMPLE["tilt_x"], SAMPLE["tilt_y"]]
            apart.append(np.abs(samples[:, columns] - values.to_numpy().reshape(SAMPLES, -1)).max())
    assert np.quantile(apart, 0.9) < 1e-7


def test_node_computes_the_runs_of_simulate(runner, tmp_path):
    compare("slender", 12, runner, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind for kind in MODELS if kind != "sliding"])
def test_node_computes_a_hundred_random_runs_of_each_model(kind, runner, tmp_path):
    compare(kind, 100, runner, tmp_path, seed=8)


def test_the_numbers_of_columns_and_motions_are_those_of_their_constructors():
    variants = CaseProgram(("slenderness",)).variants
    assert {one.of for one in variants.values()} >= {f"column_{shape}" for shape in SHAPES}
    assert {"column_solid_density", "column_solid_mass"} <= set(variants)
    assert "column_solid" not in variants  # it refuses any radius and height without density and mass
    for variant in variants.values():
        declared = parameters_of(variant.make)
        assert [one.name for one in variant.arguments] == [
            name for name, one in declared.items() if not one.optional or name in variant.given
        ]


def test_all_programs_import_known_functions_only():
    from stylobate.compiler.mathematics import FUNCTIONS
    from stylobate.compiler.web import imports_of

    for module in (CaseProgram(("slenderness",)).module(), RunProgram(MODELS["slender"], Shaking.REST).module()):
        assert set(imports_of(module)) <= set(FUNCTIONS)
