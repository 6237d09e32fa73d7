"""Thumbnails of the gallery have words, and downloads of examples are not found by the search."""

import importlib.util
from pathlib import Path

import pytest

pytest.importorskip("sphinx", reason="the tools of the documentation are not installed")

from docutils import nodes
from docutils.utils import new_document
from sphinx.search import WordCollector
from sphinx.search.en import SearchEnglish

FILE = Path(__file__).parents[1] / "docs" / "extensions" / "gallery_pages.py"


@pytest.fixture(scope="module")
def gallery_pages():
    if not FILE.is_file():
        pytest.skip("the documentation is not here")
    spec = importlib.util.spec_from_file_location("gallery_pages", FILE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def paragraph(text):
    return nodes.paragraph("", "", nodes.Text(text))


def test_the_search_finds_the_text_of_an_example_and_not_its_downloads(gallery_pages):
    document = new_document("")
    footer = nodes.container("", paragraph("Download zipped"), classes=["sphx-glr-footer", "sphx-glr-footer-example"])
    document += [paragraph("A column rolls"), footer]
    gallery_pages.keep_from_search(None, document)
    words = WordCollector(document, SearchEnglish({}))
    document.walk(words)
    assert words.found_words == ["A", "column", "rolls"]


def test_a_thumbnail_has_the_title_of_its_example(gallery_pages):
    document = new_document("")
    for title in ("Which path?", "Does it stand?"):
        image = nodes.image(uri=f"gallery/images/thumb/{title}.png", alt="")
        document += [image, nodes.paragraph("", "", nodes.reference("", title, refuri="plot.html"))]
    document += nodes.image(uri="_static/figure.png", alt="")
    gallery_pages.name_thumbnails(None, document, "gallery/index")
    assert [image["alt"] for image in document.findall(nodes.image)] == ["Which path?", "Does it stand?", ""]
