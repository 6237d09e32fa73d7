"""Estimated moments of inertia are varied where small variations, samples and objects are."""

from types import SimpleNamespace

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes.assessment.report.sections import _estimated
from stylobate.earthquakes.config.fragility import FragilityConfig
from stylobate.earthquakes.fragility_study import FragilityStudy
from stylobate.earthquakes.inventories.export import notes_of, ranking_rows
from stylobate.earthquakes.inventories.objects import InventoryObject
from stylobate.earthquakes.inventories.table import read_inventory
from stylobate.engine.parameters import with_parameters
from stylobate.errors import ConfigError
from stylobate.provenance import provenance_of_run

AMPHORA = {"radius": 0.11, "height": 0.95, "mass_height": 0.52, "mass": 14.0, "profile": "amphora"}
PULSE = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=8.0)


@pytest.fixture(scope="module")
def model():
    column = sb.Column.estimated(**AMPHORA)
    return sb.Wobbling(column, damping=0.1)


@pytest.fixture(scope="module")
def found(model):
    return sb.verdict(model, PULSE, runs=60)


def test_a_verdict_varies_estimated_moments_by_their_spreads(model, found):
    values = found.data["value"]
    across, along = (values.sel(variation=name).to_numpy() for name in ("transverse_inertia", "axial_inertia"))
    # Standard deviation of 60 draws: within 3/√(2·60) of that of the distribution.
    assert across.std() / model.column.transverse_inertia == pytest.approx(0.10, rel=0.28)
    assert along.std() / model.column.axial_inertia == pytest.approx(0.35, rel=0.28)
    certain = sb.Wobbling(sb.Column.estimated(**AMPHORA, inertia_spread=0.0), damping=0.1)
    others = sb.verdict(certain, PULSE, runs=60).data["value"]
    assert "transverse_inertia" not in others["variation"]
    # A further variation changes no other.
    assert np.array_equal(others.sel(variation="size"), values.sel(variation="size"))


def test_a_verdict_repeats_with_its_variations_of_inertia(model, found):
    again = sb.earthquakes.repeat_verdict(found)
    assert again.data["value"].equals(found.data["value"])
    left_out = sb.verdict(model, PULSE, runs=4, variations={"axial_inertia": None})
    names = sb.earthquakes.repeat_verdict(left_out).data["variation"].to_numpy().tolist()
    assert "transverse_inertia" in names
    assert "axial_inertia" not in names


@pytest.mark.parametrize(("radius", "height", "centre"), [(0.5, 0.1, 0.05), (0.11, 0.95, 0.52), (0.3, 0.4, 0.02)])
@pytest.mark.filterwarnings("ignore::stylobate.errors.UnlikelyInputWarning")
def test_all_drawn_moments_are_those_of_a_body(radius, height, centre):
    column = sb.Column.estimated(radius=radius, height=height, mass_height=centre, mass=1.0, profile="cylinder")
    model = sb.Wobbling(column)
    spreads = sb.earthquakes.inertia_spreads(column)
    ends = {name: spread.draw(getattr(column, name), np.array([1e-9, 1.0 - 1e-9])) for name, spread in spreads.items()}
    for across in ends["transverse_inertia"]:
        for along in ends["axial_inertia"]:
            with_parameters(model, PULSE, transverse_inertia=across, axial_inertia=along)


TABLE = """name;radius;height;mass_height;mass;damping;friction_coefficient;profile;max_diameter [cm];inertia_spread
amphora;0.11;0.95;0.52;14;housner;0.5;amphora;;
vase;0.08;0.5;0.25;8;housner;0.5;vase;30;5 %
stele;0.3;1.2;0.6;400;housner;0.5;cylinder;;0
bell;;;;20;housner;0.5;bell.csv;;
"""


@pytest.fixture(scope="module")
def objects(tmp_path_factory):
    folder = tmp_path_factory.mktemp("objects")
    (folder / "bell.csv").write_text("height,radius,wall\n0,0.15,0.01\n0.6,0.02,0.01\n", encoding="utf-8")
    (folder / "objects.csv").write_text(TABLE, encoding="utf-8")
    return read_inventory(folder / "objects.csv")


def test_a_table_of_objects_has_kinds_and_files_of_profiles(objects):
    prepared = [one.prepared("wobbling") for one in objects]
    assert [one.shape for one in prepared] == ["estimated", "estimated", "estimated", "profile"]
    vase = sb.Column.estimated(
        radius=0.08, height=0.5, mass_height=0.25, mass=8.0, profile="vase", max_radius=0.15, inertia_spread=0.05
    )
    assert prepared[1].model.column == vase
    assert [list(one.spreads) for one in prepared] == [["transverse_inertia", "axial_inertia"]] * 2 + [[]] * 2


def test_samples_of_an_object_vary_its_estimated_moments(objects):
    amphora = objects[0].prepared("wobbling")
    draws = amphora.draws(400, 0)
    assert np.log(draws["transverse_inertia"]).std() == pytest.approx(0.10, rel=0.12)
    column = amphora.model.column
    p = np.sqrt(column.mass * column.gravity * column.rim_distance / column.rim_inertia)
    assert np.corrcoef(draws["frequency_parameter"], draws["transverse_inertia"])[0, 1] < -0.9
    assert np.median(draws["frequency_parameter"]) == pytest.approx(p, rel=0.01)
    sized = InventoryObject(
        name="amphora",
        column=AMPHORA,
        model={"damping": 0.1},
        friction_coefficient=0.5,
        spreads={"mass": sb.earthquakes.LognormalSpread(0.2)},
    ).prepared("wobbling")
    both = sized.draws(400, 0)
    # The moments follow the mass, and their errors are independent of it: 0.2² + 0.1².
    assert np.log(both["transverse_inertia"]).std() == pytest.approx(np.hypot(0.2, 0.1), rel=0.12)


def test_the_ranking_names_estimated_moments(objects):
    found = sb.earthquakes.inventory(objects[:3:2], {"pulse": PULSE, "other": PULSE.scaled(1.2)}, samples=4)
    notes = dict(zip(found["object"].to_numpy().tolist(), notes_of(found), strict=True))
    assert "inertia estimated, ±10 %, about the axis ±35 % (amphora)" in notes["amphora"]
    assert "estimated" not in notes["stele"]
    header, rows = ranking_rows(found)
    assert {row[header.index("profile")] for row in rows} == {"amphora", "cylinder"}


def test_objects_without_moments_are_refused_with_the_remedy(tmp_path):
    path = tmp_path / "objects.csv"
    path.write_text(
        "name;radius;height;mass_height;mass;damping;friction_coefficient\namphora;0.11;0.95;0.52;14;housner;0.5\n",
        encoding="utf-8",
    )
    with pytest.raises(ConfigError) as caught:
        read_inventory(path)
    (line,) = caught.value.problems
    assert line.startswith("objects.csv, row 2: transverse_inertia and axial_inertia are missing. State profile (cyl")


def test_samples_of_a_fragility_need_no_other_spread():
    description = {
        "column": AMPHORA,
        "model": {"kind": "wobbling", "damping": 0.1},
        "records": {"source": "nowhere"},
        "fragility": {"scales": {"values": [1.0, 2.0]}, "samples": 3},
    }
    setup = FragilityConfig.parse(description).build(read=False)
    study = FragilityStudy(
        model=setup.model, records={"pulse": PULSE}, scales=setup.scales, spreads={}, samples=3, options={}
    )
    runs = study.runs(progress=False)
    assert runs.sizes["property_sample"] == 3
    assert len(set(runs["transverse_inertia"].to_numpy().tolist())) == 3
    certain = {**description, "column": {**AMPHORA, "inertia_spread": 0.0}}
    with pytest.raises(ConfigError, match=r"samples and fragility\.spreads need each other"):
        FragilityConfig.parse(certain).build(read=False)


def test_the_report_states_what_is_estimated(model):
    stele = sb.Wobbling(sb.Column.solid(radius=0.3, height=1.2, mass=400.0), damping=0.1)
    columns = {name: provenance_of_run(one, PULSE) for name, one in {"amphora": model, "stele": stele}.items()}
    (line,) = _estimated(SimpleNamespace(setting={"columns": columns, "variations": 200}))
    assert line == (
        "Moments of inertia: estimated from a kind of profile for amphora (profile amphora, ±10 %, about the axis "
        "±35 %); the small variations vary them."
    )
    assert not _estimated(SimpleNamespace(setting={"columns": {"stele": columns["stele"]}, "variations": 200}))
