"""Names without blanks and in any script: they stay within pages and figures, and boxes are remarked on."""

import io
from itertools import combinations

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes.assessment.report.document import report_style
from stylobate.errors import UnlikelyInputWarning, UnsupportedError
from stylobate.plots.page import PageList, PageSection, PageTable, page, pdf_of, require_pdf
from stylobate.plots.result_figure import heading
from stylobate.plots.style import new_figure, styled

NAMES = ["NM_Inv.2019-0456_marble_column_drum_northeast_stoa", "marble" * 12 + "abc", "N" * 115]
CHINESE = "\u67f1\u5b50"


@pytest.fixture(scope="module", autouse=True)
def _with_weasyprint():
    try:
        require_pdf()
    except UnsupportedError:
        pytest.skip("WeasyPrint is not installed")


@pytest.mark.parametrize("columns", [3, 12])
def test_no_text_of_a_report_lies_beyond_its_page(columns):
    weasyprint = pytest.importorskip("weasyprint")
    table = PageTable(
        ["object", "record", *["central"] * (columns - 2)],
        [[name, NAMES[2], *["84 % (60 to 95 %)"] * (columns - 2)] for name in NAMES],
    )
    parts = [*NAMES, table, PageList([f"{name}: {name}" for name in NAMES])]
    html = page(NAMES[2], parts, [PageSection(NAMES[1], parts)], style=report_style(NAMES[2], " · ".join(NAMES)))
    texts = 0
    for one in weasyprint.HTML(string=html).render().pages:
        box = one._page_box  # the layout has no other door
        for part in box.descendants():
            if type(part).__name__ == "TextBox":
                texts += 1
                assert part.position_x >= 0.0
                assert part.position_x + part.width <= box.margin_width() - 0.5 * box.margin_right, part.text
    assert texts > 50


@styled
def panels(names, along):
    figure = new_figure(7.0)
    for axes, name in zip(figure.subplots(1, len(names), sharey=True), names, strict=True):
        axes.plot([0.0, 1.0], label=name)
        axes.set_title(name)
    heading(figure, " under ".join(names))
    figure.axes[0].set_yticks(range(len(along)), along)
    figure.legend(loc="outside lower center")
    return figure


def test_long_names_overlap_nothing_in_a_figure():
    figure = panels(NAMES, [f"{name} · low" for name in NAMES])
    figure.draw_without_rendering()
    titles = [axes._left_title if axes.get_title(loc="left") else axes.title for axes in figure.axes]
    for one, other in combinations([text.get_window_extent() for text in titles], 2):
        assert not one.overlaps(other)
    assert ["".join(text.get_text().split()) for text in titles] == NAMES  # broken, and not cut
    for text in (*titles, *figure.texts, *figure.legends[0].get_texts(), figure.axes[0].yaxis.get_ticklabels()[-1]):
        box = text.get_window_extent()
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
    assert all(axes.get_window_extent().width > 0.1 * figure.bbox.width for axes in figure.axes)
    labels = {label.get_text() for axes in figure.axes for label in axes.yaxis.get_ticklabels()}
    assert "NNNNNNNNNNNNNNNNNNNN…NNNNNNNNNN · low" in labels


def test_one_remark_names_the_characters_of_a_figure_that_its_font_lacks():
    record = sb.Record(samples=np.array([0.0, 1.0, 0.0]), step=0.1, name=f"{CHINESE} \xe9")
    figure = sb.plot(record)
    with pytest.warns(UnlikelyInputWarning, match=r"fonts: boxes .* \(got \u67f1, \u5b50\)\. Name a font") as caught:
        figure.savefig(io.BytesIO(), format="png")
    assert len(caught) == 1


def test_one_remark_names_the_characters_of_a_pdf_that_no_font_has():
    with pytest.warns(UnlikelyInputWarning, match=r"fonts: boxes .* \(got \U000f1234\)\. Install a font") as caught:
        pdf_of(page("\U000f1234 \U000f1234 a", [], []))
    assert len(caught) == 1
