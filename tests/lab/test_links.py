"""Links that open a case in the page."""

import re
from pathlib import Path

import pytest

import stylobate as sb
from stylobate.config import SimulationConfig
from stylobate.errors import ParameterError
from stylobate.lab.links import (
    case_of_objects,
    case_of_provenance,
    is_answered_in_the_page,
    link_to,
    link_to_listed,
    shortest,
)
from stylobate.lab.options import lessons, presets
from stylobate.provenance import provenance_of_run

COLUMN = {"shape": "dimensionless", "slenderness": 0.1}
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)


@pytest.mark.parametrize(
    ("motion", "text"),
    [
        ({"kind": "rest"}, "rest"),
        ({"kind": "circular", "acceleration": 1e-7, "sense": -1}, "circular,acceleration:1e-07,sense:-1"),
        ({"kind": "elliptic", "amplitude": [0.08, 0.0], "phase": None}, "elliptic,amplitude:0.08/0"),
        ({"kind": "record", "sample": "el centro 1940"}, "record,sample:el%20centro%201940"),
        ({"kind": "record", "sample": "1940", "one_component": True}, "record,sample:'1940,one_component:true"),
        ({"kind": "record", "path": ["a.at2"]}, "record,path:a.at2/"),
        ({"kind": "sum", "motions": [{"kind": "rest"}]}, "sum,motions:~%5B%7B%22kind%22%3A%22rest%22%7D%5D"),
    ],
)  # fmt: skip
def test_parts_are_written_as_the_page_writes_them(motion, text):
    values = {"column": COLUMN, "model": {"kind": "slender", "damping": 0.1}, "motion": motion, "tilt": [0.05, 0.0]}
    expected = f"column=dimensionless,slenderness:0.1&model=slender,damping:0.1&motion={text}&tilt=0.05,0"
    assert link_to({**values, "duration": None}) == expected


def test_the_case_of_a_run_is_as_short_as_its_declaration():
    column = sb.Column.dimensionless(slenderness=0.1)
    run = sb.simulate(sb.Slender(column, damping=0.1), CIRCLE, tilt=(0.03, 0.01), duration=2.0, rtol=1e-7)
    case = case_of_provenance(run.provenance)
    assert case == {
        "column": COLUMN,
        "model": {"kind": "slender", "damping": 0.1},
        "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
        "tilt": [0.03, 0.01],
        "duration": 2.0,
    }
    again = SimulationConfig.parse(case).build()
    assert again.motion == CIRCLE
    assert again.model.column.radius == pytest.approx(column.radius, rel=1e-15)


@pytest.mark.parametrize(
    ("column", "case"),
    [
        (sb.Column.solid(radius=0.3, height=3.0, density=2700.0), {"radius": 0.3, "height": 3.0, "density": 2700.0}),
        (sb.Column.dimensionless(0.25, inertia_ratio=0.7), {"slenderness": 0.25, "inertia_ratio": 0.7}),
    ],
)
def test_a_column_keeps_the_numbers_of_its_shape(column, case):
    found = case_of_provenance(provenance_of_run(sb.Slender(column), CIRCLE, duration=1.0))["column"]
    assert {name: value for name, value in found.items() if name != "shape"} == case


def test_a_scaled_record_has_its_scale():
    model = sb.Slender(sb.Column.solid(radius=0.3, height=3.0, density=2700.0))
    quake = sb.sample_record("el centro 1940")
    motion = case_of_provenance(provenance_of_run(model, quake.scaled(0.9)))["motion"]
    assert motion == {"kind": "record", "sample": "el centro 1940", "scale": 0.9}
    assert is_answered_in_the_page(case_of_provenance(provenance_of_run(model, quake)))
    turned = case_of_provenance(provenance_of_run(model, quake.scaled(0.9).rotated(0.5)))
    assert not is_answered_in_the_page(turned)


def test_a_column_of_another_shape_is_described_by_mass_and_inertia():
    column = sb.Column.hollow(radius=0.3, inner_radius=0.2, height=2.0, density=2e3)
    found = case_of_provenance(provenance_of_run(sb.Slender(column), CIRCLE, duration=1.0))["column"]
    assert found["shape"] == "given"
    assert SimulationConfig.parse({"column": found, "duration": 1.0}).column.build() == column


def test_the_only_model_and_motion_are_a_case_that_starts_on_the_branch_of_its_rolling():
    slender = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    case = case_of_objects([1.0, slender, "text", CIRCLE])
    assert case is not None
    assert is_answered_in_the_page(case)
    assert link_to(case).endswith("&motion=circular,acceleration:0.065,angular_frequency:1.8&start=upper")
    other = case_of_objects([sb.Wobbling(slender.column), CIRCLE])
    assert other is not None
    assert "start" not in other  # the page starts only the slender model on a branch
    assert case_of_objects([slender]) is case_of_objects([slender, CIRCLE, CIRCLE.scaled(2.0)]) is None


@pytest.mark.parametrize(
    ("change", "answered"),
    [
        ({}, True),
        ({"motion": {"kind": "rest"}}, True),
        ({"model": {"kind": "sliding", "friction_coefficient": 0.3}}, False),
        ({"model": {"kind": "slender", "damping": "housner"}}, False),
        ({"friction_coefficient": 0.2}, False),
        ({"motion": {"kind": "record", "sample": "el centro 1940", "scale": 2.0}}, True),
        ({"motion": {"kind": "record", "sample": "el centro 1940", "directions": ["x"]}}, False),
    ],
)
def test_a_case_that_the_page_cannot_compute_is_known(change, answered):
    motion = {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8}
    values = {"column": COLUMN, "model": {"kind": "slender"}, "motion": motion, "duration": 9.0, **change}
    assert is_answered_in_the_page(shortest(SimulationConfig.parse(values))) == answered


def test_presets_and_lessons_have_links_with_their_titles():
    for group, listed in (("case", presets()), ("lesson", lessons())):
        for one in listed:
            assert link_to_listed(group, one.identity) == (f"{group}={one.identity}", one.title)
    with pytest.raises(ParameterError, match="did you mean temple"):
        link_to_listed("case", "tempel")


DOCS = Path(__file__).parents[2] / "docs"
SOURCES = [path for path in DOCS.rglob("*") if path.suffix in (".md", ".rst") and "_build" not in path.parts]
NO_CODE = re.compile(r"^(`{3,}|~{3,}|:{3,}).*?^\1|`[^`\n]+`", re.DOTALL | re.MULTILINE)


@pytest.mark.skipif(not SOURCES, reason="the documentation is not here")
def test_no_page_of_the_documentation_links_a_server_of_its_reader():
    texts = {path: NO_CODE.sub("", path.read_text(encoding="utf-8")) for path in SOURCES}
    assert [path.name for path, text in texts.items() if re.search(r"127\.0\.0\.1|localhost", text)] == []


@pytest.mark.skipif(not SOURCES, reason="the documentation is not here")
def test_the_worksheet_links_every_lesson_in_its_order():
    text = (DOCS / "how-to/worksheet.md").read_text(encoding="utf-8")
    found = re.findall(r"^\| \[(\d) (.*?)\]\(laboratory:(\w+)=(\w+)\)", text, re.MULTILINE)
    wanted = [(str(place), one.title) for place, one in enumerate(lessons(), 1)]
    assert [(place, title) for place, title, *_ in found] == wanted
    assert [link_to_listed(group, identity)[1] for *_, group, identity in found] == [title for _, title in wanted]
