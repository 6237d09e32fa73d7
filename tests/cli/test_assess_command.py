"""`stylobate assess`: a study in, a report out; interrupted, shown again, refused."""

import hashlib
import json
import sys

import numpy as np
import pytest
from filelock import FileLock

from stylobate import earthquakes
from stylobate.cli.main import run
from stylobate.earthquakes.assessment.report import document
from stylobate.earthquakes.assessment.report.figures import report_pictures
from stylobate.plots import page
from stylobate.results.assessment import Assessment

STUDY = """
title = "One column"
friction_coefficient = 0.6
scales = [1.0]
variations = 8
contact_laws = false
planar = false
contact = false
tail = 1.0

[columns.tank]
shape = "solid"
radius = 0.2
height = 2.0
density = 2700.0

[model]
kind = "slender"

[dissipation]
low = {damping = 0.01}
central = {damping = 0.05}
high = {damping = 0.1}

[records]
source = "quakes/*.txt"
units = "g"
step = 0.02

[margin]
from = 0.5
to = 2.0
number = 3
"""


@pytest.fixture
def study(tmp_path):
    quakes = tmp_path / "quakes"
    quakes.mkdir()
    time = 0.02 * np.arange(101)
    for name, peak in (("strong", 0.9), ("weak", 0.02)):
        along = peak * np.sin(np.pi * time) * np.sin(np.pi * time / 2.0)
        for component, share in (("NS", along), ("EW", 0.1 * along[::-1])):
            np.savetxt(quakes / f"{name}_{component}.txt", share)
    path = tmp_path / "study.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


@pytest.fixture
def one_figure():
    """Leave out the other figures, which the tests of the report draw: they take most of the time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(document, "report_pictures", lambda found: {"margins-1": report_pictures(found)["margins-1"]})
        yield


@pytest.mark.long
@pytest.mark.usefixtures("one_figure")
def test_a_study_gives_a_report_that_is_kept_and_shown_again(study, tmp_path, capsys, monkeypatch):
    folder = tmp_path / "out"
    assert run(["assess", str(study), "--folder", str(folder)]) == 0
    told = capsys.readouterr()
    assert "tank: NOT shown safe. Overturned at the recorded level under 1 of 2 records (strong)." in told.out
    assert f"study.toml, SHA-256 {hashlib.sha256(study.read_bytes()).hexdigest()}" in told.out
    assert "tank: verdicts" in told.err
    assert "stylobate: drawing figures" in told.err
    for name in ("report.html", "summary.txt", "assessment.nc", "tables/verdicts.csv", "figures/margins-1.png"):
        assert (folder / name).stat().st_size > 0
    drawn = (folder / "report.html").read_text(encoding="utf-8")
    assert all(name in drawn for name in ("strong", "weak", "SHA-256"))
    monkeypatch.setattr(earthquakes, "assess", None)  # nothing is computed to show it again
    assert run(["assess", str(folder / "assessment.nc"), "--folder", str(tmp_path / "again"), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)["summary"]
    assert summary[0]["overturned it"] == "1"
    assert (tmp_path / "again" / "report.html").read_text(encoding="utf-8") == drawn
    # A damaged assessment is written again from the parts kept, a study of another title does not overwrite it.
    saved, whole = Assessment.load(folder / "assessment.nc"), (folder / "assessment.nc").read_bytes()
    (folder / "assessment.nc").write_bytes(whole[: len(whole) // 2])
    monkeypatch.undo()
    assert run(["assess", str(study), "--folder", str(folder)]) == 0
    assert f"stylobate: 7 of 7 parts were read from {folder / 'store'} and not computed" in capsys.readouterr().err
    again = Assessment.load(folder / "assessment.nc")
    assert again.setting == saved.setting
    assert all(data.identical(saved.data[name]) for name, data in again.data.items())
    assert (folder / "report.html").read_text(encoding="utf-8") == drawn
    study.write_text(STUDY.replace("One column", "Another"), encoding="utf-8")
    assert run(["assess", str(study), "--folder", str(folder)]) == 2
    assert "holds the assessment 'One column'; name another folder" in capsys.readouterr().err
    assert (folder / "report.html").read_text(encoding="utf-8") == drawn


def test_a_pdf_is_written_on_demand_and_refused_before_the_work_without_its_library(study, monkeypatch, capsys):
    folder = study.with_name("study-assessment")
    monkeypatch.setattr(page, "pdf_of", lambda html: b"%PDF of " + html[:15].encode())
    monkeypatch.setattr(page, "require_pdf", lambda: None)
    monkeypatch.setattr(document, "pdf_of", page.pdf_of)
    monkeypatch.setattr(document, "report_pictures", lambda _: {})
    assert run(["assess", str(study), "--pdf"]) == 0
    assert (folder / "report.pdf").read_bytes() == b"%PDF of <!DOCTYPE html>"
    monkeypatch.undo()
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    monkeypatch.setattr(earthquakes, "assess", None)  # nothing is computed
    capsys.readouterr()
    assert run(["assess", str(study), "--pdf"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert 'pip install "stylobate[pdf]"' in line


@pytest.mark.usefixtures("one_figure")
def test_a_table_of_objects_and_a_folder_of_records_need_no_study(study, tmp_path, monkeypatch, capsys):
    table = tmp_path / "objects.csv"
    table.write_text("name,radius,height,Dichte,damping,friction_coefficient,room\ntank,0.2,2,2700,,0.6,12\n")
    given = []

    def computed(columns, records, **options):
        given.append((columns, records, options))
        raise KeyboardInterrupt

    monkeypatch.setattr(earthquakes, "assess", computed)
    monkeypatch.chdir(tmp_path)
    more = ["--units", "g", "--step", "0.02", "--title", "Room 12", "--store", "kept"]
    more += ["--default", "damping=0.1"]
    assert run(["assess", "objects.csv", "--records", "quakes", *more]) == 130
    ((columns, records, options),) = given
    assert (set(columns), set(records), options["title"]) == ({"tank"}, {"strong", "weak"}, "Room 12")
    assert str(options["store"]) == "kept"
    details = options["details"]
    assert (
        details.command == "stylobate assess objects.csv --records quakes --units g --step 0.02 --default damping=0.1"
    )
    assert options["dissipation"]["tank"]["central"] == {"damping": 0.1}
    assert details.table_sha256 == hashlib.sha256(table.read_bytes()).hexdigest()
    assert details.about_columns == {"tank": "room 12"}
    assert "stylobate: objects.csv: read 'Dichte' as density" in capsys.readouterr().err


def test_an_interrupted_assessment_says_how_to_go_on(study, tmp_path, capsys, monkeypatch):
    def stop(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(earthquakes, "assess", stop)
    assert run(["assess", str(study), "--folder", str(tmp_path / "out")]) == 130
    assert "the same command continues from them" in capsys.readouterr().err


def test_the_report_lies_beside_the_study_and_the_first_line_says_where(study, tmp_path, capsys, monkeypatch):
    def stop(*_, **__):
        raise KeyboardInterrupt

    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    monkeypatch.setattr(earthquakes, "assess", stop)
    assert run(["assess", "../study.toml"]) == 130
    assert capsys.readouterr().err.startswith("stylobate: writing into ../study-assessment\n")
    assert (tmp_path / "study-assessment" / "store").is_dir()
    assert not list(elsewhere.iterdir())


@pytest.mark.parametrize("held", ["out", "out/store"])
def test_a_second_assessment_in_a_folder_is_refused_before_its_work(held, study, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(earthquakes, "assess", None)
    (tmp_path / held).mkdir(parents=True)
    with FileLock(tmp_path / held / ".lock"):
        assert run(["assess", str(study), "--folder", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err.splitlines()
    assert told[1:] == [
        f"stylobate: {tmp_path / held}: another assessment writes into it. Wait until it ends, or name another folder."
    ]


def test_how_to_compute_is_refused_where_nothing_is_computed(tmp_path, capsys):
    saved = tmp_path / "assessment.nc"
    saved.touch()
    assert run(["assess", str(saved), "--threads", "2"]) == 2
    assert capsys.readouterr().err == (
        f"stylobate: --threads: assess does not use it to show {saved}, for which it computes nothing (got 2). "
        "Remove it.\n"
    )


@pytest.mark.parametrize(
    ("gone", "told"),
    [
        ("[dissipation]", "dissipation is missing: it decides the outcome"),
        ("friction_coefficient", "friction_coefficient is missing"),
        ("units", "the file names no unit"),
    ],
)
def test_what_must_be_stated_is_asked_for(gone, told, study, capsys):
    lines = STUDY.splitlines()
    cut = [line for line in lines if not line.startswith(gone)]
    if gone.startswith("["):
        cut = [line for line in cut if not line.startswith(("low", "central", "high"))]
    study.write_text("\n".join(cut), encoding="utf-8")
    assert run(["assess", str(study)]) == 2
    problems = capsys.readouterr().err.splitlines()
    assert told in problems[0]
    assert len(problems) == (2 if gone == "units" else 1)  # one for each file


def test_a_missing_study_is_one_line(capsys):
    assert run(["assess", "none.toml"]) == 2
    assert capsys.readouterr().err == "stylobate: cannot read none.toml: No such file or directory\n"
