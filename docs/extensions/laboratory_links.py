"""Links that open the case of a page in the laboratory, which is part of the site as static files.

`laboratory` takes the case from what is on the page: from the Python block before it, up to the first call of
`simulate` or with its only model and base motion; from TOML in the directive, in which `start` can be a branch of
steady rolling; or from the options `case` or `lesson`, a preset or a lesson of the page.
A link in the text, `[It stands](laboratory:lesson=stands)`, opens a lesson or a preset, `case=temple`.
In a site without the static laboratory words take their place that say how to start it.
"""

import shutil
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, NoReturn
from unittest.mock import patch

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective
from sphinx.util.osutil import relative_uri

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST
from stylobate.config.simulation import SimulationConfig
from stylobate.errors import ParameterError
from stylobate.lab.links import (
    case_of_objects,
    case_of_provenance,
    is_answered_in_the_page,
    link_to,
    link_to_listed,
    shortest,
)
from stylobate.provenance import provenance_of_run

LOGGER = logging.getLogger(__name__)

FOLDER = "laboratory"
"""Folder of the static laboratory in the site."""

SCHEME = "laboratory:"
"""Beginning of the links in the text."""

_LABEL = "Open this case in the laboratory"
_COMMAND = "stylobate lab"

# Browsers run no script of a folder on disk: there the links lead to the page in one file.
_FROM_DISK = """
if (location.protocol === "file:")
  document.addEventListener("DOMContentLoaded", () => {
    for (const link of document.querySelectorAll("a.laboratory-link"))
      link.href = link.href.replace("/index.html#", "/laboratory.html#");
  });
"""


class laboratory_link(nodes.General, nodes.Element):  # noqa: N801  docutils names nodes so
    """Stands for a link until the place of the laboratory is known."""


class _Simulated(Exception):  # noqa: N818  ends a program at its first run
    def __init__(self, values: Mapping[str, Any]) -> None:
        self.values = values


def case_of_code(code: str) -> dict[str, Any]:
    """Return the case of the first run of a program, which ends there, or else of its only model and base motion.

    >>> case_of_code('''
    ... import stylobate as sb
    ...
    ... model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.05)
    ... run = sb.simulate(model, tilt=(0.08, 0.0), duration=30.0)
    ... ''')["model"]
    {'kind': 'slender', 'damping': 0.05}
    """

    def simulate(model: Any, motion: Any = None, **options: Any) -> NoReturn:
        options.pop("events", None)
        moved = BASE_AT_REST if motion is None else motion
        raise _Simulated(provenance_of_run(model, moved, **options))

    variables: dict[str, Any] = {}
    with patch.object(sb, "simulate", simulate):
        try:
            exec(code, variables)  # noqa: S102  the code of our own page
        except _Simulated as run:
            return case_of_provenance(run.values)
    case = case_of_objects(variables.values())
    if case is None:
        raise ValueError("the Python block before has no run, and no single case")
    return case


def case_of_toml(text: str) -> dict[str, Any]:
    """Return the case that TOML describes.

    >>> case = '''
    ... duration = 20.0
    ... tilt = [0.05, 0.0]
    ... column = { slenderness = 0.1 }
    ... '''
    >>> case_of_toml(case)["column"]
    {'shape': 'dimensionless', 'slenderness': 0.1}
    """
    values = tomllib.loads(text)
    start = {"start": values.pop("start")} if "start" in values else {}
    described = SimulationConfig.parse(values)
    described.build()  # reports numbers that no case can have
    return {**shortest(described), **start}


class Laboratory(SphinxDirective):
    """`laboratory`: a link that opens a case, with a text of its own as argument."""

    has_content = True
    optional_arguments = 1
    final_argument_whitespace = True
    option_spec: ClassVar = {
        "case": directives.unchanged_required,
        "lesson": directives.unchanged_required,
    }

    def run(self) -> list[nodes.Node]:
        try:
            link, label, choice = self._link()
        except Exception as error:  # noqa: BLE001  the code of a page can raise anything
            warning = self.state.document.reporter.warning
            return [warning(f"laboratory: {error}", line=self.lineno)]
        label = (*self.arguments, label)[0]
        return [laboratory_link(link=link, label=label, choice=choice)]

    def _link(self) -> tuple[str, str, str]:
        """Return the link, its label, and what a reader does in a laboratory without it."""
        for group, identity in self.options.items():
            link, title = link_to_listed(group, identity)
            what = "the lesson " if group == "lesson" else ""
            label = f"Open {what}“{title}” in the laboratory"
            return link, label, f"choose {what or 'the preset '}“{title}”"
        content = "\n".join(self.content)
        values = case_of_toml(content) if content else case_of_code(self._code())
        if not is_answered_in_the_page(values):
            raise ValueError(
                f"the page cannot answer this case without a server: {values}"
            )
        return link_to(values), _LABEL, "set up this case"

    def _code(self) -> str:
        blocks = [
            one
            for one in self.state.document.findall(nodes.literal_block)
            if one.get("language") == "python"
        ]
        if not blocks:
            raise ValueError("there is no Python block before")
        return blocks[-1].astext()


def _folder(app: Sphinx) -> Path | None:
    """Return the folder with the static laboratory, or None for a site without it."""
    name: str = app.config.static_laboratory
    if not name or app.builder.format != "html":
        return None
    folder = Path(app.confdir, name)
    if not (folder / "index.html").is_file():
        raise ExtensionError(
            f"static_laboratory: {folder} has no index.html. Run make static-lab."
        )
    return folder


def _add_script(app: Sphinx) -> None:
    if _folder(app) is not None:
        app.add_js_file(None, body=_FROM_DISK)


def _put_links(app: Sphinx, document: nodes.document, page: str) -> None:
    """Put a link in the place of each, or words that say how to start the laboratory."""
    address = None
    if _folder(app) is not None:
        address = relative_uri(app.builder.get_target_uri(page), f"{FOLDER}/index.html")
    for place in list(document.findall(laboratory_link)):
        place.replace_self(_button(place, address))
    for link in list(document.findall(nodes.reference)):
        if link.get("refuri", "").startswith(SCHEME):
            _lead(link, address)


def _button(place: laboratory_link, address: str | None) -> nodes.paragraph:
    if address is None:
        before, after = "Start the laboratory with ", f" and {place['choice']}."
        command = nodes.literal("", _COMMAND)
        return nodes.paragraph("", before, command, nodes.Text(after))
    link = nodes.reference(
        "",
        place["label"],
        refuri=f"{address}#{place['link']}",
        internal=True,
        classes=["laboratory-link"],
    )
    return nodes.paragraph("", "", link)


def _lead(link: nodes.reference, address: str | None) -> None:
    """Let a link in the text lead to its lesson or preset."""
    group, _, identity = link["refuri"].removeprefix(SCHEME).partition("=")
    try:
        found, _ = link_to_listed(group, identity)
    except ParameterError as error:
        LOGGER.warning("laboratory: %s", error, location=link)
        return
    if address is None:
        words = [*link.children, nodes.Text(" ("), nodes.literal("", _COMMAND)]
        link.replace_self([*words, nodes.Text(")")])
        return
    link["refuri"], link["internal"] = f"{address}#{found}", True
    link["classes"].append("laboratory-link")


def _copy(app: Sphinx, error: Exception | None) -> None:
    folder = _folder(app)
    if error is None and folder is not None:
        shutil.copytree(folder, Path(app.outdir, FOLDER), dirs_exist_ok=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Add the directive and the folder of the static laboratory, relative to the settings of the site."""
    app.add_config_value("static_laboratory", "", "html", (str,))
    app.add_node(laboratory_link)
    app.add_directive("laboratory", Laboratory)
    app.connect("builder-inited", _add_script)
    app.connect("doctree-resolved", _put_links)
    app.connect("build-finished", _copy)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
