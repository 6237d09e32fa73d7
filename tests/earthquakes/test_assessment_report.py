"""The report of an assessment: it holds every number of its tables, names every record, and needs nothing else."""

import csv
import re
import sys
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.patches import Rectangle

import stylobate as sb
from stylobate.earthquakes import assess, assessment_report, assessment_tables
from stylobate.earthquakes.assessment.assess import summary_of
from stylobate.earthquakes.assessment.margins import demands_to_margin, states_at_scales
from stylobate.earthquakes.assessment.report import document
from stylobate.earthquakes.assessment.report.answers import (
    answer_table,
)
from stylobate.earthquakes.assessment.report.column_verdict import cases_of
from stylobate.earthquakes.assessment.report.figures import (
    history_figure,
    margins_figure,
    report_pictures,
    shares_figure,
    spectra_figure,
    tilts_figure,
)
from stylobate.earthquakes.assessment.report.findings import column_findings, summary_text, verdict_table
from stylobate.earthquakes.assessment.report.sections import document_table, first_page, not_covered, report_sections
from stylobate.earthquakes.assessment.report.sketch import objects_figure
from stylobate.earthquakes.assessment.report.tables import drifting
from stylobate.earthquakes.assessment.report.wording import at_least, at_most, intervals, least_scale
from stylobate.earthquakes.figures.overturning_intervals import UNDECIDED
from stylobate.plots.page import PageList, require_pdf
from stylobate.results import DesignSpectrum, ReportDetails

from .two_columns import BODIES, DISSIPATION, made_record, section

pytestmark = pytest.mark.long

DETAILS = ReportDetails(
    author="N. Author",
    project="site 7",
    date="2026-05-14",
    study_file="two.toml",
    study_sha256="ab12" * 16,
    about_records={"strong": "made earthquake, station 3"},
    design_spectrum=DesignSpectrum(period=(0.0, 0.5, 2.0), acceleration=(2.0, 5.0, 1.0), name="spectrum of the site"),
    spectral_period=0.8,
)


@pytest.fixture(scope="module")
def found():
    bare = assess(
        {name: sb.Slender(body) for name, body in BODIES.items()},
        [made_record("strong", 9.0), made_record("weak & quiet", 0.2)],
        dissipation=DISSIPATION,
        friction_coefficient=0.6,
        scales=[0.5, 1.0],
        margin_scales=np.geomspace(0.5, 3.0, 9),
        variations=20,
        planar=False,
        contact=False,
        tail=2.0,
        title="Two columns",
        notes=["the floor is dry"],
        details=DETAILS,
    )
    return with_contact(bare)


def with_contact(bare):
    """Return the assessment with demands on the contact and planar answers put in, as if they had been computed."""
    verdicts = bare.data["verdicts"]
    demands = xr_like(verdicts, 0.31)
    demands[{"column": 0, "scale": 1}] = 0.7123
    planar = verdicts["tilt_ratio"].sel(dissipation="central", vertical="with", drop=True) * 0.5
    answers = planar.rename("planar_tilt_ratio").to_dataset()
    few = planar.isel(record=0, drop=True)
    answers = answers.assign(log_ratio=planar * 0.1, bias=few * 0.0 + 0.123, standard_error=few * 0.0 + 0.0456)
    answers = answers.assign(
        {name: (few.dims, np.ones(few.shape, int)) for name in ("compared", "only_space", "only_planar")}
    )
    by_record = demands.max(("dissipation", "vertical"))
    summary = bare.data["summary"].assign(friction_by_record=by_record, friction_demand=by_record.max("record"))
    more = {
        "verdicts": verdicts.assign(
            friction_demand=demands, pivoting_demand=demands / 3.0, minimum_normal_force=demands
        ),
        "planar": answers,
        "summary": summary,
    }
    return replace(bare, data={**bare.data, **more}, setting={**bare.setting, "contact": True})


def xr_like(verdicts, value):
    return (verdicts["tilt_ratio"] * 0.0).fillna(0.0) + value


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.cells, self.sources, self.headings, self.text, self.links = [], [], [], [], []
        self.where = None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.where = tag
        if tag in ("td", "th"):
            self.cells.append("")
        self.sources += [given[name] for name in ("src", "srcset", "data") if name in given]
        self.links += [given["href"]] if "href" in given else []

    def handle_data(self, data):
        if self.where in ("td", "th"):
            self.cells[-1] += data
        if self.where == "h2":
            self.headings.append(data)
        self.text.append(data)

    def handle_endtag(self, tag):
        self.where = None


def plain(cell):
    return cell.replace("−", "-").replace("‑", "-")


@pytest.fixture(scope="module")
def folder(found, tmp_path_factory):
    target = tmp_path_factory.mktemp("report") / "assessment"
    assert assessment_report(found, target) == target / "report.html"
    return target


@pytest.fixture(scope="module")
def page(folder):
    return Page((folder / "report.html").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_files_and_workbook_hold_every_cell_of_every_table(found, folder):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.load_workbook(folder / "tables.xlsx")
    tables = assessment_tables(found)
    assert set(book.sheetnames) == set(tables)
    for name, table in tables.items():
        with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
            header, *rows = csv.reader(file)
        assert header == list(table.header)
        assert rows == [list(row) for row in table.rows]
        cells = [[cell or "" for cell in row] for row in book[name].iter_rows(values_only=True)]
        assert cells == [header, *rows]


def test_the_tables_hold_the_numbers_of_the_assessment(found):
    runs = assessment_tables(found)["runs"]
    data = found.data["verdicts"]
    assert len(runs.rows) == data["tilt_ratio"].size
    assert [row[5] for row in runs.rows].count("overturned") == int((data["overturned"] == 1).sum())
    needed = {row[9]: row[10] for row in runs.rows}
    assert needed == {"0.31": "yes", "0.712": "no"}


def test_rules_of_practice_are_counted_over_the_records_beside_the_verdicts(found):
    rows = assessment_tables(found)["rules-of-practice"].rows
    practice, verdicts = found.data["practice"], found.data["verdicts"]["overturned"]
    overturned = verdicts.sel(dissipation="central", vertical="with") == 1
    assert len(rows) == practice["safe"].isel(record=0).size
    assert all(int(row[3]) + int(row[5]) == practice.sizes["record"] for row in rows)
    assert sum(int(row[6]) for row in rows) == int((practice["safe"] & overturned).sum())
    assert all(int(row[4]) <= int(row[3]) for row in rows)


def test_the_page_loads_nothing_from_elsewhere(folder, page):
    assert page.sources
    assert all(source.startswith("data:image/png;base64,") for source in page.sources)
    assert all(link.startswith("#") for link in page.links)
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert not re.search(r"<(script|link|iframe|object)\b|@import|url\(", text)
    assert "@media print" in text


def test_the_page_names_every_record_column_and_what_it_rests_on(found, page):
    text = "".join(page.text)
    wanted = ["slim <1>", "stout", "strong", "weak & quiet", "made for strong", "the floor is dry", sb.__version__]
    wanted += ["N. Author", "site 7", "2026-05-14", "two.toml", "ab12" * 16, "made earthquake, station 3"]
    wanted += ["spectrum of the site", "Housner", "Boore", "Vassiliou", "numpy", "llvmlite"]
    wanted += ["several drums", "sloshing", "anchors", "flexible soil", "not circular"]
    wanted += [record["digest"] for record in found.setting["records"].values()]
    for words in wanted:
        assert words in text, words
    for heading in (
        "Assumptions",
        "What is not covered",
        "Contact demand",
        "How to repeat this assessment",
        "References",
    ):
        assert heading in page.headings


def test_verdicts_promise_nothing(found, folder):
    summary = (folder / "summary.txt").read_text(encoding="utf-8")
    heads = [document_table(found), verdict_table(found), answer_table(found, 1.0)]
    assert summary == summary_text(found, heads)
    answers = heads[-1]
    for row in answers.rows:  # each number stands behind its heading
        (line,) = (one for one in summary.splitlines() if one.startswith(f"{row[0]}: {row[1]}; "))
        assert all(f"{name} {cell}" in line for name, cell in zip(answers.header[2:], row[2:], strict=True))
    assert "did not overturn" in summary
    words = summary + " ".join(
        cell for table in assessment_tables(found).values() for row in table.rows for cell in row
    )
    assert not re.search(r"\b(?<!NOT shown )(safe|secure|certain|guarante\w+)\b", words)
    assert summary.startswith("Two columns\n")


def test_a_column_that_always_overturns_and_one_that_never_moves_are_described_so(found):
    always, never = _only(found, "slim <1>", "strong"), _only(found, "stout", "weak & quiet")
    (row,) = verdict_table(always).rows
    assert row[1] == "NOT shown safe"
    assert row[2].startswith(
        "Overturned at the recorded level under the one record (strong). 100 % of the small variations overturn it "
        "(strong). Under strong it needs a friction of 0.712, more than stated: its base would slip. Smallest "
        "overturning scale of all cases: at most "
    )
    findings = dict(column_findings(never, "stout").rows)
    assert findings["tilt, at the recorded level"] == "It did not rock."
    assert "No scale factor from 0.45 to 3 overturned it" in findings["margin"]


def test_intensities_at_the_margin_are_those_of_the_record_times_the_least_scale(found):
    table = assessment_tables(found)["margin-intensities"]
    records, least = found.data["records"], found.data["margins"]["least_overturning"]
    spectral = found.data["spectra"]["spectral_acceleration"].sel(period=0.8)
    assert "Sa(0.8 s) [g]" in table.header
    seen = 0
    for row in table.rows:
        cells = dict(zip(table.header, row, strict=True))
        scale = float(least.sel(column=cells["column"], record=cells["record"], case=cells["case"]))
        if np.isnan(scale):
            assert cells["PGA [g]"].startswith("> ")
            continue
        seen += 1
        own = records.sel(record=cells["record"])
        assert cells["definition"] == own["definition"].item() == "RotD50"
        peak = scale * float(own["median_peak_acceleration"])
        assert cells["PGA [m/s²]"] == f"{peak:.3g}"
        assert cells["PGA [g]"] == f"{peak / 9.80665:.3g}"
        assert cells["PGV [m/s]"] == f"{scale * float(own['median_peak_velocity']):.3g}"
        assert cells["Sa(0.8 s) [g]"] == f"{scale * float(spectral.sel(record=cells['record'])) / 9.80665:.3g}"
    assert seen >= 2


def test_mean_and_design_spectrum_are_compared_where_both_are_known(found):
    table = assessment_tables(found)["spectra"]
    own = found.data["spectra"]["spectral_acceleration"]
    design = {"0.1": 2.6, "0.2": 3.2, "0.3": 3.8, "0.5": 5.0, "0.8": 4.2, "1": 11.0 / 3.0, "2": 1.0, "3": np.nan}
    rows = {row[0]: dict(zip(table.header, row, strict=True)) for row in table.rows}
    assert rows.keys() == design.keys()
    for period, row in rows.items():
        values = own.sel(period=float(period))
        for name in ("strong", "weak & quiet"):
            assert row[f"{name} [g]"] == f"{float(values.sel(record=name)) / 9.80665:.3g}"
        mean, aim = float(values.mean()), design[period]
        assert row["mean [g]"] == f"{mean / 9.80665:.3g}"
        assert row["spectrum of the site [g]"] == ("–" if np.isnan(aim) else f"{aim / 9.80665:.3g}")
        assert row["mean / design"] == ("–" if np.isnan(aim) else f"{mean / aim:.3g}")


def test_spectra_are_drawn_with_their_mean_and_the_design_spectrum(found):
    (axes,) = spectra_figure(found).axes
    own = found.data["spectra"]["spectral_acceleration"]
    curves = {line.get_label(): line.get_xydata().T for line in axes.lines}
    expected = {name: own.sel(record=name) for name in ("strong", "weak & quiet")}
    expected["mean of the records"] = own.mean("record")
    for name, values in expected.items():
        np.testing.assert_array_equal(curves[name][0], own["period"])
        np.testing.assert_allclose(curves[name][1], values / 9.80665, rtol=1e-12)
    np.testing.assert_allclose(curves["spectrum of the site"], [[0.0, 0.5, 2.0], np.array([2.0, 5.0, 1.0]) / 9.80665])
    assert axes.get_xlim() == (0.0, float(own["period"].max()))
    assert axes.get_ylim()[0] == 0.0


def test_the_first_page_states_whether_the_other_contact_law_matters(found):
    (listed,) = [part for part in first_page(found, {}) if isinstance(part, PageList)]
    (words,) = [item for item in listed.items if item.startswith("Contact: ")]
    cases = {name: cases_of(found, name, 1.0).with_other_law for name in BODIES}
    only = [name for name, one in cases.items() if one]
    expected = (
        f"some record overturned {' and '.join(only)}." if only else "No record overturned an object with the other"
    )
    assert expected in words


def test_the_command_the_inputs_and_what_the_table_carries_are_in_the_report(found):
    details = {
        **found.setting["details"],
        "command": "stylobate assess objects.csv --records 'my quakes'",
        "table_file": "objects.csv",
        "table_sha256": "cd34" * 16,
        "about_columns": {"stout": "room 12, inventory number B-007"},
    }
    stated = replace(found, setting={**found.setting, "details": details})
    listed, _ = section(stated, "How to repeat this assessment")
    assert "Command: stylobate assess objects.csv --records 'my quakes'" in listed.items
    assert f"Table of objects: objects.csv, SHA-256 {'cd34' * 16}" in listed.items
    assert f"Study file: two.toml, SHA-256 {'ab12' * 16}" in listed.items
    assert column_findings(stated, "stout").rows[0] == ("object", "room 12, inventory number B-007")


def test_a_mean_of_five_percent_is_not_divided_by_a_design_spectrum_of_another_damping(found):
    design = {**found.setting["details"]["design_spectrum"], "damping": 0.02}
    other = replace(
        found, setting={**found.setting, "details": {**found.setting["details"], "design_spectrum": design}}
    )
    table = assessment_tables(other)["spectra"]
    rows = [dict(zip(table.header, row, strict=True)) for row in table.rows]
    assert {row["mean / design"] for row in rows} == {"–"}
    assert any(row["spectrum of the site [g]"] != "–" for row in rows)


@pytest.mark.parametrize(
    ("asked", "words"), [(False, "was not run"), (True, "was computed only for columns that slide")]
)
def test_what_is_not_covered_depends_on_whether_sliding_was_asked_for(found, asked, words):
    (row,) = [
        row
        for row in not_covered(replace(found, setting={**found.setting, "sliding": asked})).rows
        if row[0] == "slip and flight"
    ]
    assert words in row[1]


def test_a_planar_run_that_is_not_decided_does_not_differ(found):
    verdicts = found.data["verdicts"]
    stood = verdicts["overturned"].sel(dissipation="central", vertical="with") == 1
    tilts = found.data["planar"]["planar_tilt_ratio"]
    for value, count in ((np.nan, 0), (0.5, int(stood.sum()))):
        planar = found.data["planar"].assign(planar_tilt_ratio=xr.full_like(tilts, value))
        counts = summary_of({**found.data, "planar": planar}, ["strong", "strong"])
        assert int(counts["planar_differs"].sum()) == count


def test_figures_that_would_show_nothing_are_left_out(found, folder):
    names = {path.stem for path in (folder / "figures").glob("*.png")}
    assert {"records-1", "spectra-1", "margins-1", "history-1"} <= names
    still = _only(found, "stout", "weak & quiet")
    quiet = still.data["histories"].assign(peak_tilt_ratio=("column", [0.0]))
    names = report_pictures(replace(still, data={**still.data, "histories": quiet}))
    assert not any(name.startswith(("margins", "tilts", "history", "variations")) for name in names)


def test_a_record_that_drifts_is_named(found):
    records = found.data["records"]
    for drifts, names, words in ((0, [], "no"), (1, ["strong", "weak & quiet"], "yes")):
        moved = records.assign(drifts=xr.full_like(records["drifts"], drifts))
        changed = replace(found, data={**found.data, "records": moved})
        assert drifting(changed) == names
        assert {row[-1] for row in assessment_tables(changed)["records"].rows} == {words}


@pytest.mark.slow
def test_an_assessment_saved_without_spectra_and_details_has_a_report(found, tmp_path):
    later = {"spectra", "ground_motions"}
    older = {name: value for name, value in found.setting.items() if name not in ("details", "software")}
    few = _only(found, "slim <1>", "strong")
    bare = replace(few, data={name: one for name, one in few.data.items() if name not in later}, setting=older)
    assert assessment_report(bare, tmp_path).is_file()


def _only(found, column, record):
    """Return the part of an assessment that is of one column and record, its counts made anew."""
    data = {
        name: one.sel({dim: [name_of] for dim, name_of in (("column", column), ("record", record)) if dim in one.dims})
        for name, one in found.data.items()
        if name not in ("summary", "planar")
    }
    return replace(found, data={**data, "summary": summary_of(data, [record])})


def test_friction_beyond_the_stated_one_is_reported(found):
    slim, stout = (dict(column_findings(found, name).rows)["contact"] for name in ("slim <1>", "stout"))
    assert "needed a friction coefficient of 0.712, above the stated 0.6" in slim
    assert "up to 0.31; the stated coefficient is 0.6" in stout


def undecided(found):
    """Return the assessment, with the upper half of every scan lifted off where nothing overturned below."""
    margins = found.data["margins"]
    scale = margins["margin_scale"].to_numpy()
    lifted, begin = scale > 1.5, float(scale[scale <= 1.5][-1])
    one = margins.assign(
        outcome=margins["outcome"].where(~xr.DataArray(lifted, dims="margin_scale"), sb.Outcome.LIFTED_OFF),
        undecided_from=margins["undecided_from"] * 0.0,
        unknown=margins["unknown"] * 0.0 + int(lifted.sum()),
    )
    one["undecided_from"] = one["undecided_from"].fillna(begin)
    one["undecided_to"] = one["undecided_from"] * 0.0 + scale[-1]
    return replace(found, data={**found.data, "margins": one}), begin, float(scale[-1])


def test_undecided_scales_are_drawn_named_and_written_as_such(found):
    hidden, begin, end = undecided(found)
    figure = margins_figure(hidden, "stout")
    labels = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert "not decided: lifted off" in labels
    grey = [bar for bar in figure.axes[0].patches if bar.get_facecolor()[:3] == to_rgb(UNDECIDED.colour)]
    margins = hidden.data["margins"].sel(column="stout")
    drawn = ("low", "central", "high", "central, other contact law")
    assert len(grey) == margins.sizes["record"] * len(drawn)
    for bar in grey:
        assert bar.get_x() == pytest.approx(begin)
        assert bar.get_x() + bar.get_width() == pytest.approx(end)
    one = margins.sel(record="weak & quiet", case="central")
    where = f"not decided from {begin:.4g} to {end:.4g} (lifted off)"
    assert least_scale(one) == intervals(one) == f"none found; {where}"
    labels = [text.get_text() for legend in margins_figure(found, "stout").legends for text in legend.get_texts()]
    assert not any("not decided" in label for label in labels)


@pytest.mark.parametrize(
    ("interval", "stretch", "words"),
    [
        ((4.735, 4.735, 0, 1, 0, 1), (4.735, 5.0), "4.735; not decided from 4.735 to 5 (lifted off)"),
        ((1.582, 4.735, 0, 1, 0, 1), (4.735, 5.0), "1.582 to 4.735; not decided from 4.735 to 5 (lifted off)"),
        ((0.2, 0.5, 1, 0, 0, 0), (np.nan, np.nan), "0.2 to 0.5 and below"),
        ((3.0, 5.0, 0, 1, 0, 0), (np.nan, np.nan), "3 to 5 and beyond"),
        ((5.0, 5.0, 0, 1, 0, 0), (np.nan, np.nan), "5 and beyond"),
        ((np.nan, np.nan, 0, 0, 0, 0), (np.nan, np.nan), "none"),
    ],
)
def test_an_interval_is_written_as_far_as_runs_are_decided(interval, stretch, words):
    names = ("interval_from", "interval_to", "open_below", "open_above", "undecided_below", "undecided_above")
    lifted = [sb.Outcome.AT_REST, sb.Outcome.LIFTED_OFF]
    one = xr.Dataset({name: ("interval", [value]) for name, value in zip(names, interval, strict=True)})
    one = one.assign(undecided_from=("stretch", [stretch[0]]), undecided_to=("stretch", [stretch[1]]))
    assert intervals(one.assign(outcome=("margin_scale", lifted))) == words


def test_an_undecided_run_has_a_place_of_its_own_among_the_tilts(found):
    verdicts = found.data["verdicts"]
    lost = verdicts.assign(tilt_ratio=verdicts["tilt_ratio"].where(verdicts["record"] != "weak & quiet"))
    figure = tilts_figure(replace(found, data={**found.data, "verdicts": lost}), "stout", 1.0)
    crosses = [line for line in figure.axes[0].lines if line.get_marker() == "x" and len(line.get_xdata())]
    assert len(crosses) == 3  # a level each
    ticks = dict(zip(figure.axes[0].get_xticks(), figure.axes[0].get_xticklabels(), strict=True))
    assert ticks[crosses[0].get_xdata()[0]].get_text() == "not\ndecided"


def test_the_history_shows_the_last_run_that_stands_and_the_first_that_overturns(found):
    figure = history_figure(found, "slim <1>")
    labels = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    runs = found.data["histories"].sel(column="slim <1>")
    scale = float(runs["scale"].sel(run="overturns"))
    assert f"scale {scale:.4g}, central dissipation: overturned" in labels
    assert any(label.startswith("scale 1, central dissipation: ") for label in labels)
    below = float(runs["scale"].sel(run="stands"))
    assert np.isnan(below) or any(label.startswith(f"scale {below:.4g}, central") for label in labels)


@pytest.mark.parametrize(
    ("need", "slipping", "first", "words"),
    [
        (0.4, np.nan, 0, "No run for the margin needed more friction than stated."),
        (0.5, 2.5, 0, "needs more friction than stated is 2.5, above the smallest overturning scale: the column"),
        (0.9, 0.8, 1, "is 0.8. With some damping the base would slip at a scale below the smallest that overturns"),
        (np.nan, np.nan, 0, "The friction needed at other scales was not computed."),
    ],
)
def test_friction_up_to_the_margin_is_stated(found, need, slipping, first, words):
    at = {"friction_to_margin": need, "least_slipping": slipping, "slips_first": first}
    summary = found.data["summary"]
    counted = summary.assign({name: ("column", np.full(2, value)) for name, value in at.items()})
    changed = replace(found, data={**found.data, "summary": counted})
    assert words in dict(column_findings(changed, "stout").rows)["contact"]


def test_the_friction_of_each_contact_law_is_stated_and_the_given_one_decides_the_class(found):
    at = {"friction_to_margin": 0.5, "least_slipping": np.nan, "slips_first": 0, "least_slipping_other_law": 0.538}
    counted = found.data["summary"].assign({name: ("column", np.full(2, value)) for name, value in at.items()})
    contact = dict(column_findings(replace(found, data={**found.data, "summary": counted}), "stout").rows)["contact"]
    assert "with slender needed a friction coefficient of up to 0.31" in contact
    assert "No run for the margin needed more friction than stated. With the other contact law" in contact
    assert "from scale 0.538 on" in contact
    assert "the given law only" in contact


def test_the_table_of_friction_up_to_the_margin_is_that_of_its_runs(found):
    margins = found.data["margins"]
    need = margins["friction_demand"].fillna(0.0) + 0.5 * margins["margin_scale"]
    changed = margins.assign(friction_demand=need, **demands_to_margin(margins.assign(friction_demand=need), 0.6))
    table = assessment_tables(replace(found, data={**found.data, "margins": changed}))["contact-to-margin"]
    scales = margins["margin_scale"].to_numpy()
    assert {row[6] for row in table.rows} == {f"{scales[scales > 1.2][0]:.3g}"}
    for column, record, case, _, need_below, *_ in table.rows:
        least = float(margins["least_overturning"].sel(column=column, record=record, case=case))
        below = 0.5 * scales[~(scales >= least)]
        assert need_below == (f"{below.max():.3g}" if below.size else "–")
    assert len({row[4] for row in table.rows}) > 1


def test_a_bias_of_one_record_is_told_to_be_of_too_few(found):
    nothing = found.data["planar"].assign(bias=found.data["planar"]["bias"] * np.nan)
    rows = assessment_tables(replace(found, data={**found.data, "planar": nothing}))["planar-bias"].rows
    assert {row[2] for row in rows} == {"too few records"}


def test_few_records_are_told_in_the_words_of_the_fragility(page):
    assert "2 records: with fewer than 20 the interval of the dispersion is too narrow" in "".join(page.text)


def test_a_least_scale_that_stands_alone_is_marked(found):
    margins = found.data["margins"]
    assert float(margins["least_lasting"].min()) >= float(margins["least_overturning"].min())
    assert "so narrow" not in dict(column_findings(found, "slim <1>").rows)["margin"]
    alone = margins.assign(least_lasting=1.25 * margins["least_overturning"])
    changed = replace(found, data={**found.data, "margins": alone})
    wider = float(alone["least_lasting"].sel(column="slim <1>", record="strong", case="central"))
    words = dict(column_findings(changed, "slim <1>").rows)["margin"]
    assert "in an overturning interval so narrow that another scan may not find it" in words
    assert f"; the first wider interval begins at {wider:.4g}" in words


def test_shares_are_tabulated_with_their_word_and_counts(found):
    table = assessment_tables(found)["variations"]
    shares = found.data["variations"]
    assert len(table.rows) == shares["share"].size
    for row in table.rows:
        cells = dict(zip(table.header, row, strict=True))
        one = shares.sel(column=cells["column"], record=cells["record"], scale=float(cells["scale"]))
        low, share, high = (100.0 * float(one[name]) for name in ("share_low", "share", "share_high"))
        assert cells["under small variations"] == one["word"].item()
        assert cells["share that overturns it"] == f"{share:.0f} %"  # of 20
        assert cells["90 % sampling interval"] == f"{low:.0f} to {high:.0f} %"
        assert cells["not decided"] == "0 of 20"
        laws = [f"{name} {100.0 * float(value):.0f} %" for name, value in zip(LAWS, one["law_share"], strict=True)]
        assert cells["by contact law"] == ", ".join(laws)
        tilt = float(one["tilt_ratio_median"])
        assert cells["median tilt / α_c"] == ("overturned" if np.isinf(tilt) else f"{tilt:.3g}")
    assert {row[3] for row in table.rows} == {"undecided"}  # whatever 20 variations do


LAWS = ("slender", "slender rolling")


def test_shares_of_near_scales_are_tabulated_by_case_and_a_share_of_no_decided_scale_is_a_dash(found):
    band = found.data["margins"]["band_share"]
    where = {"column": "stout", "record": "strong", "case": "low"}
    band = band.copy()
    band.loc[where] = np.nan
    margins = found.data["margins"].assign(band_share=band)
    table = assessment_tables(replace(found, data={**found.data, "margins": margins}))["near-scales"]
    assert list(table.header[3:]) == list(band["case"].values)
    for column, record, scale, *cells in table.rows:
        for case, cell in zip(table.header[3:], cells, strict=True):
            share = float(band.sel(column=column, record=record, scale=float(scale), case=case))
            rounded = f"{100.0 * share:.0f} %"
            assert cell == ("–" if np.isnan(share) else rounded)


def with_shares(found):
    """Return the assessment, with shares of all sizes for the column "stout"."""
    variations, margins = found.data["variations"].copy(deep=True), found.data["margins"]
    for record, low, share, high in (("strong", 0.3, 0.45, 0.6), ("weak & quiet", 0.0, 0.0, 0.12)):
        for name, value in (("share_low", low), ("share", share), ("share_high", high)):
            variations[name].loc[{"column": "stout", "record": record, "scale": 1.0}] = value
    band = margins["band_share"].copy()
    for place, case in enumerate(band["case"].values):
        band.loc[{"column": "stout", "record": "strong", "case": case, "scale": 1.0}] = 0.1 * place
    return replace(found, data={**found.data, "variations": variations, "margins": margins.assign(band_share=band)})


def test_shares_are_drawn_with_their_intervals_and_those_of_near_scales_as_marks(found):
    changed = with_shares(found)
    figure = shares_figure(changed, "stout", 1.0)
    (axes,) = figure.axes
    bars = [bar for bar in axes.patches if isinstance(bar, Rectangle) and bar.get_height() == 0.5]
    drawn = [(bar.get_x(), bar.get_x() + bar.get_width(), bar.get_y() + 0.25) for bar in bars]
    np.testing.assert_allclose(drawn, [(30.0, 60.0, 0.0), (0.0, 12.0, 1.0)])
    shares, *marks = [line for line in axes.lines if line.get_linestyle() == "None"]
    np.testing.assert_allclose(shares.get_xydata(), [(45.0, 0.0), (0.0, 1.0)])
    cases = found.data["margins"]["case"].values
    assert len(marks) == len(cases) == len({(line.get_marker(), line.get_markeredgecolor()) for line in marks})
    for place, line in enumerate(marks):
        np.testing.assert_allclose(line.get_xydata(), [(10.0 * place, 0.0), (0.0, 1.0)], atol=1e-12)
    labels = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert labels == ["variations, 90 % sampling interval", "variations, share", *(f"±10 %: {case}" for case in cases)]
    assert [text.get_text() for text in axes.get_yticklabels()] == ["strong", "weak & quiet"]
    limits = sorted(line.get_xdata()[0] for line in axes.lines if line.get_linestyle() == "--")
    np.testing.assert_allclose(limits, [5.0, 95.0])


@pytest.mark.slow
def test_each_stated_scale_that_moved_a_column_has_a_figure_of_shares(found):
    names = set(report_pictures(found))
    assert {"variations-1-scale-0.5", "variations-1-scale-1", "variations-2-scale-1"} <= names
    bare = replace(found, data={name: one for name, one in found.data.items() if name != "variations"})
    assert not any(name.startswith("variations") for name in report_pictures(bare))


def test_the_section_of_outcomes_states_what_varied_or_that_nothing_did(found):
    title = "Outcomes at the stated scales"
    words, table, *_ = section(found, title)
    assert "Each verdict was repeated 20 times with everything varied at once" in words
    assert "the tolerance, and the contact law" in words
    assert "small variations" in table.header
    one_law = replace(found, setting={**found.setting, "contact_laws": False})
    assert "the contact law" not in section(one_law, title)[0]
    without = {name: one for name, one in found.data.items() if name != "variations"}
    bare = replace(found, data=without, setting={**found.setting, "variations": 0})
    bare = replace(bare, data={**without, "summary": summary_of(without, ["strong", "strong"])})
    words, table, *_ = section(bare, title)
    assert "No verdict was repeated under small variations (variations = 0), so it is not known" in words
    assert "small variations" not in table.header
    assert "No verdict was repeated under small variations here" in summary_text(bare, [])
    assert "were therefore repeated under small variations" in summary_text(found, [])
    assert "small variations disagree" not in assessment_tables(bare)["summary"].header
    assert "variations" not in assessment_tables(bare)


def test_rows_of_outcomes_that_say_nothing_are_counted_and_left_out(found):
    _, table, remark = section(found, "Outcomes at the stated scales")
    verdicts, variations, margins = (found.data[name] for name in ("verdicts", "variations", "margins"))
    cases = [name for name in margins["case"].values if name.endswith("other contact law")]
    at = states_at_scales(margins, verdicts["scale"]).sel(case=cases)
    says = (verdicts["overturned"] != 0).any(("dissipation", "vertical")) | (at != 0).any("case")
    says = says | (variations["overturned"] + variations["open"] > 0) | (margins["in_band"] > 0).any("case")
    assert len(table.rows) == int(says.sum()) > 0
    assert remark.startswith(f"{int((~says).sum())} more rows with no case that overturned")
    for column, record, scale, *cells in table.rows:
        assert bool(says.sel(column=column, record=record, scale=float(scale)))
        row = dict(zip(table.header[3:], cells, strict=True))
        states = verdicts["overturned"].sel(column=column, record=record, scale=float(scale), vertical="with")
        for level in ("low", "central", "high"):
            assert (row[level] == "yes") == bool(states.sel(dissipation=level) == 1)


def test_the_first_page_answers_with_class_probability_and_margin(found):
    table = answer_table(found, 1.0)
    shares = found.data["variations"]["share"].sel(scale=1.0)
    for name, verdict, probability, least in table.rows:
        share = 100.0 * float(shares.sel(column=name).mean())
        assert probability.startswith(f"{share:.0f} % (")
        assert verdict in ("NOT shown safe", "Survival NOT robust", "Survived every run")
        smallest = float(found.data["margins"]["least_overturning"].sel(column=name).min())
        assert least.startswith("No scale" if np.isnan(smallest) else at_most(smallest))
    without = {name: one for name, one in found.data.items() if name != "variations"}
    plain = answer_table(replace(found, data=without), 1.0)
    states = found.data["verdicts"]["overturned"].sel(column="slim <1>", scale=1.0, vertical="with")
    assert plain.rows[0][2].startswith(f"{100.0 * float((states == 1).mean()):.0f} % (")


def test_a_sketch_turns_about_the_rim_and_an_overturned_body_lies_on_the_ground(found):
    names = list(BODIES)
    figure = objects_figure(found, names, names)
    for place, (name, body) in enumerate(BODIES.items()):
        standing, *turned = (patch.get_xy()[:-1] for patch in figure.axes[place].patches)
        assert standing[:, 0].max() == pytest.approx(body.radius)
        ratio = float(found.data["histories"]["peak_tilt_ratio"].sel(column=name, run="stated"))
        assert len(turned) == (ratio >= 1e-3)
        for outline in turned:
            rim, top = (
                int(np.flatnonzero(np.isclose(standing, corner).all(axis=1))[0])
                for corner in ((body.radius, 0.0), (body.radius, body.height))
            )
            np.testing.assert_allclose(outline[rim], (body.radius, 0.0), atol=1e-12)
            sides = [np.linalg.norm(np.roll(one, 1, axis=0) - one, axis=1) for one in (standing, outline)]
            np.testing.assert_allclose(sides[0], sides[1], rtol=1e-12)
            if np.isinf(ratio):
                np.testing.assert_allclose(outline[top], (body.radius + body.height, 0.0), atol=1e-12)
                assert outline[:, 1].min() >= -1e-12


@pytest.mark.system
def test_a_pdf_has_page_numbers_a_running_title_and_a_bookmark_for_each_section(found, tmp_path):
    pypdf = pytest.importorskip("pypdf")
    try:
        require_pdf()
    except sb.errors.UnsupportedError as lacking:
        pytest.skip(f"{lacking} (got: {lacking.__context__})")  # which names the library of the system
    few = _only(found, "stout", "weak & quiet")
    assessment_report(few, tmp_path, pdf=True)
    reader = pypdf.PdfReader(tmp_path / "report.pdf")
    texts = ["".join(one.extract_text().split()) for one in reader.pages]  # kerning may look like a space
    for place, text in enumerate(texts):
        assert f"Page{place + 1}of{len(texts)}" in text
        assert "Twocolumns" in text
    title, sections = reader.outline
    assert title.title == "Two columns"
    assert [one.title for one in sections] == [one.heading for one in report_sections(few, assessment_tables(few), {})]
    assert reader.metadata.author == "N. Author"


def test_without_weasyprint_a_pdf_is_refused_before_anything_is_written(found, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    with pytest.raises(sb.errors.UnsupportedError, match=r'pip install "stylobate\[pdf\]"'):
        assessment_report(_only(found, "stout", "weak & quiet"), tmp_path / "new", pdf=True)
    assert not (tmp_path / "new").exists()


def test_margins_are_stated_as_upper_bounds(found):
    seen = 0
    for name in ("margins", "governing"):
        table = assessment_tables(found)[name]
        for row in table.rows:
            words = dict(zip(table.header, row, strict=True))["smallest overturning scale"]
            assert words.startswith(("at most ", "none up to "))
            seen += words.startswith("at most ")
    assert seen >= 3
    words = dict(column_findings(found, "slim <1>").rows)["margin"]
    assert words.startswith("At central dissipation the smallest overturning scale is at most ")
    assert "Smallest overturning scale of all cases: at most " in verdict_table(found).rows[0][2]
    assert "read each margin as “at most”" in section(found, "Margins")[0]


def test_bounds_are_rounded_up_in_every_table_and_sentence(found):
    margins = found.data["margins"]
    scales = margins["least_overturning"]
    table = assessment_tables(found)["margin-intensities"]
    for row in table.rows:
        cells = dict(zip(table.header, row, strict=True))
        exact = float(scales.sel(column=cells["column"], record=cells["record"], case=cells["case"]))
        if not cells["smallest overturning scale, at most"].startswith("> "):
            assert exact <= float(cells["smallest overturning scale, at most"]) * (1.0 + 1e-12) < exact * 1.002
    assert [at_most(0.77251), at_most(0.772), at_most(0.0999), at_most(2.0)] == ["0.773", "0.772", "0.0999", "2"]
    assert [at_least(0.77251), at_least(0.772), at_least(1.999), at_least(2.0)] == ["0.772", "0.772", "1.99", "2"]


def test_a_record_without_a_vertical_component_is_not_said_to_have_one(found):
    rows = assessment_tables(found)["runs"]
    assert {dict(zip(rows.header, row, strict=True))["vertical"] for row in rows.rows} == {"none in the record"}
    records = assessment_tables(found)["records"]
    assert {dict(zip(records.header, row, strict=True))["PGA up [g]"] for row in records.rows} == {"none in the record"}
    assert not any("vertical component included" in one.caption for one in report_pictures(found).values())


def test_verdicts_name_the_records_that_overturned_it_near_by_and_with_the_other_law(found):
    table = assessment_tables(found)["verdicts"]
    rows = {row[:2]: dict(zip(table.header, row, strict=True)) for row in table.rows}
    overturned = rows["slim <1>", "1"]
    assert overturned["verdict"] == "NOT shown safe"
    margins = found.data["margins"].sel(column="slim <1>", record="strong", scale=1.0)
    share = 100.0 * float(margins["band_share"].max())
    assert overturned["overturned it within 10 % of the scale"] == f"strong ({share:.0f} % of 41)"
    share = float(found.data["variations"]["share"].sel(column="slim <1>", record="strong", scale=1.0))
    assert overturned["overturned it in some small variations"] == f"strong ({100.0 * share:.0f} %)"
    between = found.data["margins"].assign(band_share=found.data["margins"]["band_share"] * 0.0)
    table = assessment_tables(replace(found, data={**found.data, "margins": between}))["verdicts"]
    (row,) = [dict(zip(table.header, row, strict=True)) for row in table.rows if row[:2] == ("slim <1>", "1")]
    assert row["overturned it within 10 % of the scale"] == "strong (an interval between them)"


@pytest.mark.parametrize(
    ("side", "flagged"), [("below", True), ("above", True), ("among", False), ("not compared", False)]
)
def test_damping_is_compared_with_what_impacts_lose_and_levels_on_one_side_are_flagged(found, side, flagged):
    columns = found.data["columns"]
    values = columns["housner_damping"].sel(column="stout").values
    changed = columns.assign(damping_side=xr.full_like(columns["damping_side"], side, dtype=object))
    assessment = replace(found, data={**found.data, "columns": changed})
    findings = dict(column_findings(assessment, "stout").rows)
    words = findings["damping"]
    text = ", ".join(f"{value:.2g}" for value in values)
    assert words.startswith(f"Housner's impacts lose as much as η = {text} at a peak tilt of ¼, ½, ¾ α_c.")
    flag = f" All stated levels of damping lie {side} Housner's: state why, or add a level near it."
    assert findings["verdict"].endswith(flag) is flagged
    assert all(row[2].endswith(flag) is flagged for row in verdict_table(assessment).rows)


def test_levels_of_damping_too_near_each_other_are_named_on_the_first_page(found):
    def first_page(*levels):
        own = dict(zip(("low", "central", "high"), ({"damping": one} for one in levels), strict=True))
        setting = {**found.setting, "dissipation": dict.fromkeys(BODIES, own)}
        return verdict_table(replace(found, setting=setting)).rows[0][2]

    assert "levels of damping differ by a factor of 1.15 only" in first_page(0.10, 0.11, 0.115)
    assert "differ by a factor" not in first_page(0.05, 0.1, 0.2)
    assert "differ by a factor" not in first_page(0.0, 0.1, 0.2)


def test_the_side_of_the_yardstick_is_that_of_the_levels(found):
    columns = found.data["columns"]
    for name, body in BODIES.items():
        yardstick = [body.housner_damping(amplitude) for amplitude in (0.25, 0.5, 0.75)]
        np.testing.assert_allclose(columns["housner_damping"].sel(column=name), yardstick, rtol=1e-12)
        dampings = [level["damping"] for level in DISSIPATION.values()]
        side = "below" if max(dampings) < min(yardstick) else "above" if min(dampings) > max(yardstick) else "among"
        assert columns["damping_side"].sel(column=name).item() == side
    assert set(columns["damping_side"].values) == {"below", "among"}


MARKUP = ("<script>alert(1)</script>", "<b>\"bold\" & 'italic'</b>", r"$\frac{1$")


def test_names_with_markup_are_text(found, tmp_path, monkeypatch):
    margins = found.data["margins"]
    names = dict(zip(margins["column"].values, MARKUP, strict=False))
    names |= dict(zip(margins["record"].values, MARKUP[1:], strict=False))

    def renamed(value):
        if isinstance(value, xr.Dataset):
            texts = {name: one for name, one in value.variables.items() if one.dtype.kind in "OU"}
            return value.assign({name: one.copy(data=renamed(one.values)) for name, one in texts.items()})
        if isinstance(value, np.ndarray):
            return np.array([names.get(one, one) for one in value.flat], dtype=object).reshape(value.shape)
        if isinstance(value, dict):
            return {names.get(key, key): renamed(one) for key, one in value.items()}
        return names.get(value, value) if isinstance(value, str) else value

    hostile = MARKUP[0] + MARKUP[1]
    details = {**found.setting["details"], "author": hostile, "project": hostile}
    setting = {**renamed(found.setting), "title": hostile, "notes": [hostile], "details": details}
    monkeypatch.setattr(document, "report_pictures", lambda _: {})
    path = assessment_report(replace(found, data=renamed(found.data), setting=setting), tmp_path / "report")
    text = path.read_text(encoding="utf-8")
    assert not {"script", "b"} & set(re.findall(r"<([a-z0-9]+)", text))
    shown = "".join(Page(text).text)
    for name in (*MARKUP[:2], hostile):
        assert name in shown


def test_figures_of_an_earlier_report_do_not_stay(found, tmp_path):
    old = [tmp_path / "figures" / "margins-99.png", tmp_path / "tables" / "contact.csv"]
    for path in old:
        path.parent.mkdir()
        path.write_bytes(b"old")
    assessment_report(_only(found, "stout", "weak & quiet"), tmp_path)
    assert not any(path.exists() for path in old)


def test_an_assessment_is_no_single_figure(found):
    with pytest.raises(sb.errors.ParameterError, match=r"Write its report by earthquakes\.assessment_report"):
        sb.plot(found)


def test_a_saved_assessment_tells_the_same(found, folder):
    again = sb.results.Assessment.load(folder / "assessment.nc")
    assert assessment_tables(again) == assessment_tables(found)
    assert summary_text(again, [verdict_table(again)]) == summary_text(found, [verdict_table(found)])
