"""The kernels of the page as static files: programs of WebAssembly, records, and a description of them for the page."""

from collections.abc import Mapping
from enum import auto
from typing import Any

import numpy as np

from stylobate.base_motions import Harmonic, Record
from stylobate.config.description import WANTED
from stylobate.engine.ensembles.run_columns import term_of
from stylobate.engine.history import demand_texts
from stylobate.engine.kernel.bound import FromZero
from stylobate.engine.kernel.columns import LAGS
from stylobate.engine.single import reason_texts
from stylobate.engine.standalone import programs
from stylobate.engine.standalone.programs import CaseProgram, RunProgram, Shaking, TableProgram
from stylobate.engine.starts import NO_SPIN, OUT_OF_PLANE, SPIN_UPRIGHT
from stylobate.engine.verdict import (
    FALLEN,
    FINER_PASSAGE,
    FINER_REST,
    MOST_PERIODS,
    other_tolerance,
    steady_periods,
)
from stylobate.errors import Outcome
from stylobate.lab.answers import OF_ANY_COLUMN
from stylobate.lab.limits import Limits
from stylobate.lab.tasks import SAMPLES
from stylobate.models.declared import MODELS
from stylobate.parameter_quantities import attributes_of, known_names
from stylobate.records.joining import sample_names, sample_record
from stylobate.results import OutcomeRules
from stylobate.results.run import REPEATING
from stylobate.results.run_rows import DEMAND_ROWS, NO_BOUND
from stylobate.run_arguments import FREE_TAIL, SingleRun, arguments_of
from stylobate.theory.rolling import critical_of, rolling_point


def slender_start(numbers: Any, out: Any) -> None:
    """Set tilt vector [rad] and rate [rad/s] of steady rolling of a slender column, as `studies.steady_start` does.

    Parameters
    ----------
    numbers
        Slenderness, damping, gravity [m/s²], unit of time [s], 1 for the upper branch or 0; then the numbers of the
        harmonic motion.
    out
        Tilt vector, its rate, and the smaller of the circular components of the motion over the larger.
    """
    c, eta, gravity, scale, upper = numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]
    ax, ay, _, px, py, _, frequency, phase = numbers[5:13]
    motion = Harmonic(amplitude=(ax, ay, 0.0), phase=(px, py, 0.0), angular_frequency=frequency, start_phase=phase)
    term = term_of(motion)
    (x_re, x_im), (y_re, y_im), _ = term.amplitude
    forward, backward = 0.5 * np.hypot(x_re - y_im, x_im + y_re), 0.5 * np.hypot(x_re + y_im, y_re - x_im)
    ahead, behind = term.azimuths()
    sense = 1.0 if forward >= backward else -1.0
    nu, drive = frequency * scale, max(forward, backward) / gravity
    ratio, psi, _ = rolling_point(nu, drive / c, eta, upper=upper > 0.0)
    azimuth, tilt = sense * psi + (ahead if forward >= backward else behind), c * ratio
    across = sense * nu * tilt / scale
    out[0], out[1] = tilt * np.cos(azimuth), tilt * np.sin(azimuth)
    out[2], out[3] = -across * np.sin(azimuth), across * np.cos(azimuth)
    out[4] = min(forward, backward) / max(forward, backward)


class CurvePoint(FromZero):
    """Results of `slender_curves` for one sense of rolling: those of the upper branch, then those of the lower one."""

    SIZE = auto()
    """Circular component of the motion [m/s²]."""
    CRITICAL = auto()
    """Critical frequency over ω0; NaN if there is none."""
    UPPER_TILT = auto()
    UPPER_PHASE = auto()
    UPPER_STABLE = auto()
    LOWER_TILT = auto()
    LOWER_PHASE = auto()
    LOWER_STABLE = auto()


def slender_curves(numbers: Any, out: Any) -> None:
    """Set the response of a slender column at one frequency, as `studies.response_curves` computes it.

    Parameters
    ----------
    numbers
        Slenderness, damping, gravity [m/s²], frequency over ω0, amplitudes and phases of the motion along x and y.
    out
        The backbone [rad], and the columns of `CurvePoint` for anticlockwise and clockwise rolling.
    """
    c, eta, gravity, nu, ax, ay, px, py = numbers
    apart = py - px
    x, y_re, y_im = ax, ay * np.cos(apart), ay * np.sin(apart)
    out[0] = c / (1.0 + nu * nu)  # (5)
    for place, sense in ((1, 1.0), (1 + len(CurvePoint), -1.0)):
        size = 0.5 * np.hypot(x - sense * y_im, y_re)
        ratio = size / gravity / c
        out[place + CurvePoint.SIZE], out[place + CurvePoint.CRITICAL] = size, critical_of(ratio, eta)
        for at, upper in ((CurvePoint.UPPER_TILT, True), (CurvePoint.LOWER_TILT, False)):
            tilt, phase, stable = rolling_point(nu, ratio, eta, upper=upper)
            out[place + at], out[place + at + 1], out[place + at + 2] = c * tilt, phase, stable


CASE = CaseProgram(
    (*OF_ANY_COLUMN, "consistent"),
    {"slender_start": (slender_start, 13, 5), "slender_curves": (slender_curves, 8, 1 + 2 * len(CurvePoint))},
)


TABLES = TableProgram()

ALWAYS = ("mathematics", "case")
"""Modules that each run needs, besides its own."""

OF_TABLES = "tables"
"""Module that each run under a tabulated base motion needs."""


def records() -> Mapping[str, Record]:
    """Return the records of the package, by the names of the files with their samples."""
    return {f"record-{number}.f64": sample_record(name) for number, name in enumerate(sample_names())}


def run_programs() -> dict[str, RunProgram]:
    """Return the programs for runs, by name; a model that can slip is left out."""
    models: dict[str, Any] = {kind: MODELS[kind] for kind in MODELS}
    return {
        f"{kind}_{shaking}": RunProgram(model, shaking)
        for kind, model in models.items()
        for shaking in Shaking
        if not model.guards
    }


def program_of(values: Mapping[str, Any]) -> str | None:
    """Return the name of the program by which the page computes the run that these plain values describe, if any.

    The page decides it in `web/src/kernels/case.ts`.
    """
    model, motion = values["model"], values.get("motion", {"kind": "rest"})
    if any(isinstance(value, str) for name, value in model.items() if name != "kind"):
        return None
    shaking = _shaking_of(motion)
    name = f"{model['kind']}_{shaking}"
    return name if name in run_programs() else None


def _shaking_of(motion: Mapping[str, Any]) -> Shaking | None:
    of = f"motion_{motion['kind']}"
    if motion["kind"] == "rest":
        return Shaking.REST
    if motion["kind"] == "record":
        return Shaking.LINEAR
    if of in {variant.of for variant in CASE.variants.values()} and not motion.get("ramp"):
        return Shaking.HARMONIC
    return Shaking.SMOOTH if of in {variant.of for variant in TABLES.variants.values()} else None


def files_of(values: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of the files that the page loads for the run that these plain values describe."""
    program = program_of(values)
    if program is None:
        return ()
    motion = values.get("motion", {"kind": "rest"})
    own = (OF_TABLES,) if _shaking_of(motion) in (Shaking.LINEAR, Shaking.SMOOTH) else ()
    samples = dict(zip(sample_names(), records(), strict=True)).get(motion.get("sample"))
    modules = (f"{name}.wasm" for name in (*ALWAYS, program, *own))
    return (*modules, *([] if samples is None else [samples]))


def described() -> dict[str, Any]:
    """Return the description by which the page asks the programs and reads their results, for JSON."""
    rules = OutcomeRules()
    return {
        "common": programs.described(),
        "case": CASE.described(),
        "tables": TABLES.described(),
        "records": [
            {"sample": sample, "name": name, "step": record.step}
            for sample, (name, record) in zip(sample_names(), records().items(), strict=True)
        ],
        "curve": {one.name.lower(): int(one) for one in CurvePoint},
        "derived": [*programs.COLUMN, *CASE.derived],
        "programs": {name: _of_program(program) for name, program in run_programs().items()},
        "axes": {name: attributes_of(name) for name in sorted(known_names()) if "." not in name},
        "outcomes": [{"name": one.name, "label": one.label} for one in Outcome],
        "fallen": [int(one) for one in FALLEN],
        "repeating": REPEATING,
        "demand_rows": [list(row) for row in DEMAND_ROWS],
        "no_bound": NO_BOUND,
        "refusals": {"no_spin": NO_SPIN, "spin_upright": SPIN_UPRIGHT, "out_of_plane": OUT_OF_PLANE},
        "texts": {**reason_texts(), **demand_texts(), "no_duration": f"duration is missing{WANTED['duration']}"},
        "rules": {"n": rules.periods, "short": rules.periods + 1, "steady": steady_periods(rules), "most": LAGS},
        "free_tail": FREE_TAIL,
        "most_periods": MOST_PERIODS,
        "most_steps": Limits().steps,
        "samples": SAMPLES._asdict(),
        "rtol": arguments_of(SingleRun)["rtol"].default,
        "finer": {
            "rest_share": FINER_REST,
            "passage_share": FINER_PASSAGE,
            "rtol": other_tolerance(arguments_of(SingleRun)["rtol"].default),
        },
    }


def _of_program(program: RunProgram) -> dict[str, Any]:
    kind = program.kind
    return {
        **program.described(),
        "numbers": [{**programs.declared(one), "default": one.default} for one in program.model_numbers.values()],
        "planar_only": kind.planar_only,
        "proves": kind.no_return_tilt is not None,
        "carries": bool(kind.carried_names),
        "spins": kind.spin_state is not None,
        "loses": kind.impact_map is not None,
        "contact": kind.contact is not None,
    }


def files() -> Mapping[str, bytes]:
    """Return the modules of WebAssembly, and the samples of the records, by the names of their files."""
    runs = {name: program.module() for name, program in run_programs().items()}
    always = dict(zip(ALWAYS, (programs.mathematics_module(), CASE.module()), strict=True))
    modules = {**always, OF_TABLES: TABLES.module(), **runs}
    samples = {name: record.samples.astype("<f8").tobytes() for name, record in records().items()}
    return {f"{name}.wasm": module for name, module in modules.items()} | samples
