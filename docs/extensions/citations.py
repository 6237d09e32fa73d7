"""Directive `citation`: BibTeX of the software and of its references, made from CITATION.cff."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

CITATION = Path(__file__).parents[2] / "CITATION.cff"


def citation() -> Mapping[str, Any]:
    """Read CITATION.cff."""
    read: Mapping[str, Any] = yaml.safe_load(CITATION.read_text(encoding="utf-8"))
    return read


def bibtex(kind: str, key: str, fields: Mapping[str, str]) -> str:
    """Write an entry of BibTeX; empty fields are left out."""
    lines = [f"  {name:<7} = {{{text}}}," for name, text in fields.items() if text]
    return "\n".join([f"@{kind}{{{key},", *lines, "}"])


def software() -> str:
    """Write the entry of the software."""
    cited = citation()
    authors = " and ".join(f"{{{one['name']}}}" for one in cited["authors"])
    year = str(cited.get("date-released", ""))[:4]
    fields = {
        "author": authors,
        "title": cited["title"],
        "year": year,
        "version": str(cited["version"]),
    }
    return bibtex(
        "software", "stylobate", fields | {"url": cited.get("repository-code", "")}
    )


def paper() -> str:
    """Write the entry of the source paper, the first reference."""
    one = citation()["references"][0]
    authors = " and ".join(
        f"{author['family-names']}, {author['given-names']}"
        for author in one["authors"]
    )
    fields = {"author": authors, "title": one["title"], "journal": one["journal"]}
    return bibtex(
        "article",
        "munitsyn2021",
        fields | {"year": str(one["date-published"])[:4], "url": one["url"]},
    )


class Citation(SphinxDirective):
    """`citation`: the entry of the "software" or of the "paper"."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        self.env.note_dependency(str(CITATION))
        text = {"software": software, "paper": paper}[self.arguments[0]]()
        return [nodes.literal_block(text, text, language="bibtex")]


def setup(app: Sphinx) -> dict[str, Any]:
    """Add the directive."""
    app.add_directive("citation", Citation)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
