"""The report of an assessment: it holds every number of its tables, names every record, and needs nothing else."""

import csv
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

import stylobate as sb
from stylobate.plots import assessment_report, assessment_tables
from stylobate.plots.assessment.summary import summary_paragraphs
from stylobate.studies import ScaledRecord, assess
from stylobate.studies.assessment.margins import demands_to_margin

DISSIPATION = {"low": {"damping": 0.01}, "central": {"damping": 0.05}, "high": {"damping": 0.1}}


def record(name, peak):
    time = 0.02 * np.arange(101)
    wave = np.sin(np.pi * time / 2.0) * np.sin(2.0 * np.pi * time)
    return sb.Record(
        samples=peak * np.stack([wave, 0.4 * wave**2], axis=-1), step=0.02, name=name, provenance=(f"made for {name}",)
    )


@pytest.fixture(scope="module")
def found():
    slim, stout = (sb.Slender(sb.Column.solid(radius=radius, height=2.0, density=2700.0)) for radius in (0.2, 0.45))
    bare = assess(
        {"slim <1>": slim, "stout": stout},
        [record("strong", 9.0), record("weak & quiet", 0.2)],
        dissipation=DISSIPATION,
        friction_coefficient=0.6,
        scales=[0.5, 1.0],
        margin_scales=np.geomspace(0.5, 3.0, 9),
        changes=(ScaledRecord(0.95), ScaledRecord(1.05)),
        planar=False,
        contact=False,
        tail=2.0,
        title="Two columns",
        notes=["the floor is dry"],
    )
    return with_contact(bare)


def with_contact(bare):
    """Return the assessment with demands on the contact and planar answers put in, as if they had been computed."""
    verdicts = bare.data["verdicts"]
    demands = xr_like(verdicts, 0.31)
    demands[{"column": 0, "scale": 1}] = 0.7123
    planar = verdicts["tilt_ratio"].sel(dissipation="central", vertical="with", drop=True) * 0.5
    told = planar.rename("planar_tilt_ratio").to_dataset()
    few = planar.isel(record=0, drop=True)
    told = told.assign(log_ratio=planar * 0.1, bias=few * 0.0 + 0.123, standard_error=few * 0.0 + 0.0456)
    told = told.assign(
        {name: (few.dims, np.ones(few.shape, int)) for name in ("compared", "only_space", "only_planar")}
    )
    by_record = demands.max(("dissipation", "vertical"))
    summary = bare.data["summary"].assign(friction_by_record=by_record, friction_demand=by_record.max("record"))
    more = {
        "verdicts": verdicts.assign(friction_demand=demands, pivoting_demand=demands / 3.0, least_normal_force=demands),
        "planar": told,
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


def test_the_report_holds_every_cell_of_every_table_and_so_do_the_files(found, folder, page):
    cells = {plain(cell) for cell in page.cells}
    tables = assessment_tables(found)
    for name, table in tables.items():
        with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
            header, *rows = csv.reader(file)
        assert header == list(table.header)
        assert rows == [list(row) for row in table.rows]
        assert {plain(cell) for row in table.rows for cell in row} <= cells
    assert {"verdicts", "margins", "contact", "robustness", "planar", "governing", "records"} <= set(tables)


def test_the_tables_hold_the_numbers_of_the_assessment(found):
    tables = assessment_tables(found)
    assert len(tables["verdicts"].rows) == found.data["verdicts"]["tilt_ratio"].size
    states = [row[5] for row in tables["verdicts"].rows]
    assert states.count("overturned") == int((found.data["verdicts"]["overturned"] == 1).sum())
    needed = {row[5]: row[7] for row in tables["contact"].rows}
    assert needed == {"0.31": "yes", "0.712": "no"}


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
    wanted += ["several drums", "sloshing", "anchors", "flexible soil", "not circular"]
    wanted += [record["digest"] for record in found.setting["records"].values()]
    for words in wanted:
        assert words in text, words
    for heading in ("Assumptions", "What is not covered", "What the contact must bear", "Software", "Fragility"):
        assert heading in page.headings


def test_verdicts_promise_nothing(found, folder):
    lead = summary_paragraphs(found)
    assert "did not overturn in these runs" in " ".join(lead)
    told = " ".join(lead) + " ".join(
        cell for table in assessment_tables(found).values() for row in table.rows for cell in row
    )
    assert not re.search(r"\b(safe|secure|certain|guarante\w+)\b(?! again)", told)
    assert (folder / "summary.txt").read_text(encoding="utf-8").startswith("Two columns\n")


def test_a_column_that_always_overturns_and_one_that_never_moves_are_told_so(found):
    always, never = _only(found, "slim <1>", "strong"), _only(found, "stout", "weak & quiet")
    assert "it overturned under the one record" in summary_paragraphs(always)[0]
    told = summary_paragraphs(never)[0]
    assert "did not overturn in these runs under the one record, it never moved" in told
    assert (
        "No scale factor from 0.475 to 3.15 that was run overturned it" in told
        or "No scale factor from 0.475 to 3 that" in told
    )


def _only(found, column, record):
    """Return the part of an assessment that is of one column and record, its counts made anew."""
    from stylobate.studies.assessment.summary import summary_of  # noqa: PLC0415

    data = {
        name: one.sel({dim: [name_of] for dim, name_of in (("column", column), ("record", record)) if dim in one.dims})
        for name, one in found.data.items()
        if name not in ("summary", "planar")
    }
    return replace(found, data={**data, "summary": summary_of(data, [record])})


def test_friction_beyond_the_stated_one_is_told(found):
    told = summary_paragraphs(found)
    assert "needed a friction of 0.712, above the stated coefficient 0.6" in told[0]
    assert "0.31; the stated coefficient is 0.6" in told[1]


@pytest.mark.parametrize(
    ("need", "slipping", "first", "told"),
    [
        (0.4, np.nan, 0, "No scale factor that was run for the margin needed more than that."),
        (0.5, 2.5, 0, "The least scale run that needs more is 2.5, above the least that overturned it: beyond it"),
        (0.9, 0.8, 1, "needs more is 0.8, in some case below the least that overturned it: there the base would slip"),
        (np.nan, np.nan, 0, "What other scales need was not looked at."),
    ],
)
def test_friction_up_to_the_margin_is_told(found, need, slipping, first, told):
    at = {"friction_to_margin": need, "least_slipping": slipping, "slips_first": first}
    summary = found.data["summary"]
    counted = summary.assign({name: ("column", np.full(2, value)) for name, value in at.items()})
    assert told in summary_paragraphs(replace(found, data={**found.data, "summary": counted}))[1]


def test_the_table_of_friction_up_to_the_margin_is_that_of_its_runs(found):
    margins = found.data["margins"]
    need = margins["friction_demand"].fillna(0.0) + 0.5 * margins["margin_scale"]
    told = margins.assign(friction_demand=need, **demands_to_margin(margins.assign(friction_demand=need), 0.6))
    table = assessment_tables(replace(found, data={**found.data, "margins": told}))["contact-to-margin"]
    scales = margins["margin_scale"].to_numpy()
    assert {row[6] for row in table.rows} == {f"{scales[scales > 1.2][0]:.4g}"}
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


def test_a_least_scale_that_stands_alone_is_told_so(found):
    margins = found.data["margins"]
    assert float(margins["least_lasting"].min()) >= float(margins["least_overturning"].min())
    plain = summary_paragraphs(found)[0]
    assert "in a band so narrow" not in plain
    alone = margins.assign(least_lasting=1.25 * margins["least_overturning"])
    told = summary_paragraphs(replace(found, data={**found.data, "margins": alone}))[0]
    wider = float(alone["least_lasting"].sel(column="slim <1>", record="strong", case="central"))
    assert (
        "in a band so narrow that another scan might miss it: scales just above and below did not; the least from"
        in told
    )
    assert f"a wider band was found is {wider:.4g}" in told


def test_figures_of_an_earlier_report_do_not_stay(found, tmp_path):
    assessment_report(found, tmp_path)
    (tmp_path / "figures" / "margins-99.png").write_bytes(b"old")
    assessment_report(found, tmp_path)
    assert not (tmp_path / "figures" / "margins-99.png").exists()


def test_an_assessment_is_no_single_figure(found):
    with pytest.raises(sb.errors.ParameterError, match=r"write its report by plots\.assessment_report"):
        sb.plot(found)


def test_a_saved_assessment_tells_the_same(found, folder):
    again = sb.results.Assessment.load(folder / "assessment.nc")
    assert assessment_tables(again) == assessment_tables(found)
    assert summary_paragraphs(again) == summary_paragraphs(found)
