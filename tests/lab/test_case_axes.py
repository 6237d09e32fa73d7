"""Maps over the numbers that describe a case: each cell is a run of the case with its numbers."""

import math
from typing import Unpack

import numpy as np
import pytest

import stylobate as sb
from stylobate.config import SimulationConfig
from stylobate.config.study import Classes, Study
from stylobate.errors import Outcome
from stylobate.lab.grids import grid
from stylobate.lab.messages import Found
from stylobate.lab.tasks import task
from stylobate.results.tables import ResultTable
from stylobate.studies.study import StudyArguments, described, study

BOTTLE = {
    "column": {"shape": "solid", "radius": 0.03, "height": 0.2, "density": 1000.0},
    "model": {"kind": "slender", "damping": 0.1},
}
ORBIT = {"kind": "orbit", "diameter": 0.012, "rpm": 200.0}
PULSE = {"kind": "type_a", "velocity": 0.2, "angular_frequency": 12.0}


def axis(name, low, high, number):
    return {"name": name, "from": low, "to": high, "number": number}


def cells_of(values):
    """Return the axes and the outcome of each cell, as they are sent while the map fills in."""
    found = []
    task("map")(values, found.append)
    sent = [one.value.model_dump() for one in found if isinstance(one, Found)]
    cells = {(x, y): code for one in sent if "cells" in one for x, y, code in one["cells"]}
    return sent[0]["axes"], cells


@pytest.mark.parametrize(
    ("motion", "part", "x", "y"),
    [
        (ORBIT, "motion", axis("rpm", 100.0, 400.0, 4), axis("diameter", 0.005, 0.03, 3)),
        (PULSE, "motion", axis("velocity", 0.05, 0.4, 4), axis("angular_frequency", 5.0, 20.0, 3)),
        ({**ORBIT, "diameter": 0.04}, "column", axis("radius", 0.01, 0.06, 4), axis("height", 0.1, 0.4, 3)),
    ],
)
def test_a_cell_is_the_run_of_the_case_with_its_numbers(motion, part, x, y):
    case = {**BOTTLE, "motion": motion, "duration": 1.5}
    axes, cells = cells_of({**case, "map": {"x": x, "y": y}})
    assert len(cells) == x["number"] * y["number"]
    outcomes = set()
    for (ix, iy), code in cells.items():
        numbers = {x["name"]: axes["x"]["values"][ix], y["name"]: axes["y"]["values"][iy]}
        setup = SimulationConfig.parse({**case, part: {**case[part], **numbers}}).build()
        run = sb.simulate(setup.model, setup.motion, **setup.options)
        assert code == run.outcome, numbers
        outcomes.add(run.outcome)
    assert Outcome.OVERTURNED in outcomes
    assert len(outcomes) > 1


def test_axes_tell_their_units_and_another_axis_may_be_one_of_a_sweep():
    x, y = axis("rpm", 100.0, 400.0, 3), axis("damping", 0.05, 0.2, 2)
    axes, cells = cells_of({**BOTTLE, "motion": ORBIT, "periods": 3.0, "map": {"x": x, "y": y}})
    assert (axes["x"]["units"], axes["y"]["units"]) == ("min-1", "1")
    assert len(cells) == 6
    assert np.allclose(axes["x"]["values"], [100.0, 250.0, 400.0])


def test_a_number_that_cannot_be_is_refused_by_name():
    x, y = axis("radius", -0.01, 0.02, 3), axis("acceleration", 0.1, 1.0, 2)
    motion = {"kind": "circular", "acceleration": 1.0, "angular_frequency": 2.0 * math.pi}
    with pytest.raises((sb.errors.ParameterError, sb.errors.ConfigError), match="radius must be positive"):
        cells_of({**BOTTLE, "motion": motion, "duration": 1.0, "map": {"x": x, "y": y}})


def labelled_by_tilt(runs):
    high = (runs["peak_tilt"] > 0.1).astype("int8")
    share = [1.0 - float(high.mean()), float(high.mean())]
    return runs.assign(tilt_class=high, tilt_name=("class", ["low", "high"]), share=("class", share))


@study(
    "peaks",
    Study(
        name="peaks",
        source="a saved result",
        help="Compute peak tilts.",
        axes=("x", "y"),
        classes=(Classes("tilt_class", "tilt_name"),),
        completed=lambda saved, *_: labelled_by_tilt(saved),
        table=lambda _: ResultTable("", (), ()),
        summary=lambda _: {},
    ),
)
def peak_tilts(model, motion=None, *, over, **run: Unpack[StudyArguments]):
    """Compute peak tilts."""
    return sb.studies.Sweep.grid(model, motion, over=over, **described(run)), labelled_by_tilt


@pytest.mark.parametrize(
    ("x", "y"),
    [
        (axis("rpm", 100.0, 400.0, 3), axis("diameter", 0.005, 0.03, 2)),
        (axis("damping", 0.05, 0.2, 3), axis("slenderness", 0.1, 0.2, 2)),
    ],
)
def test_the_job_of_a_new_study_follows_from_its_declaration(x, y):
    found = grid(peak_tilts, {**BOTTLE, "motion": ORBIT, "duration": 1.0, "peaks": {"x": x, "y": y}}, lambda _: None)
    codes = np.array(found.codes)
    assert codes.shape == (3, 2)
    assert [one.name for one in found.classes] == ["low", "high"]
    assert [one.share for one in found.classes] == pytest.approx([(codes == code).mean() for code in (0, 1)])
