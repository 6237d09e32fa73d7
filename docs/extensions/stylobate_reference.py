"""Directives of the reference: summaries of pages, and tables made from the declarations of the package.

`summary` lists what a page describes. `command` and `shared-options` show the command line; `kinds`, `numbers`,
`run-numbers` and `fields` show description files. Their contents come from `declared_options` and `declared_fields`.
"""

import re
import shlex
import textwrap
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, ClassVar

import declared_fields
import declared_options
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from stylobate.cli.commands import COMMANDS

_CONSOLE_WIDTH = 80
# The page of the options that commands share.
_OPTIONS = "reference/command-options"
_IN_TEXT = re.compile(r"`([^`]+)`|(--[a-z][a-z-]*)")

Cell = str | nodes.Node | Sequence[nodes.Node]


class summary(nodes.General, nodes.Element):  # noqa: N801  docutils names nodes so
    """Stands for the summary of a page until everything on the page is read."""


def table(
    header: Sequence[str], rows: Iterable[Sequence[Cell]], widths: Sequence[int]
) -> nodes.table:
    """Make a table of texts and nodes."""
    group = nodes.tgroup(cols=len(header))
    group += [nodes.colspec(colwidth=width) for width in widths]
    head, body = nodes.thead(), nodes.tbody()
    head += _row(header)
    body += [_row(cells) for cells in rows]
    group += [head, body]
    made = nodes.table(classes=["reference-table"])
    made += group
    return made


def _row(cells: Sequence[Cell]) -> nodes.row:
    made = nodes.row()
    for cell in cells:
        entry, paragraph = nodes.entry(), nodes.paragraph()
        paragraph += list(inline(cell)) if isinstance(cell, str) else cell
        entry += paragraph
        made += entry
    return made


def inline(text: str) -> Iterator[nodes.Node]:
    """Make nodes of a text: what stands between backticks, and options, are code."""
    at = 0
    for match in _IN_TEXT.finditer(text):
        if match.start() > at:
            yield nodes.Text(text[at : match.start()])
        yield code(match[1] or match[2])
        at = match.end()
    if at < len(text):
        yield nodes.Text(text[at:])


def code(text: str, **attributes: Any) -> nodes.literal:
    """Make a piece of code within a text."""
    return nodes.literal(text, text, **attributes)


def codes(texts: Iterable[str]) -> list[nodes.Node]:
    """Make a list of pieces of code, with commas between them."""
    made: list[nodes.Node] = []
    for text in texts:
        made += [nodes.Text(", ")] if made else []
        made.append(code(text))
    return made


class Summary(SphinxDirective):
    """`summary`: what the page describes, by section, each with the first paragraph of its docstring."""

    def run(self) -> list[nodes.Node]:
        return [summary()]


def fill_summaries(app: Sphinx, document: nodes.document) -> None:
    """Put tables of the described names, one for each section, in the place of each summary."""
    del app
    for place in list(document.findall(summary)):
        by_section: dict[nodes.section, list[nodes.Element]] = {}
        for described in document.findall(addnodes.desc):
            if described["domain"] == "py" and addnodes.desc not in map(
                type, _above(described)
            ):
                by_section.setdefault(next(_sections_above(described)), []).append(
                    described
                )
        made: list[nodes.Node] = []
        for section, entries in by_section.items():
            if len(by_section) > 1:
                made.append(_section_link(section))
            made.append(
                table(("name", "description"), list(_summary_rows(entries)), (35, 65))
            )
        place.replace_self(made)


def _above(node: nodes.Node) -> Iterator[nodes.Node]:
    while node.parent is not None:
        node = node.parent
        yield node


def _sections_above(node: nodes.Node) -> Iterator[nodes.section]:
    return (one for one in _above(node) if isinstance(one, nodes.section))


def _section_link(section: nodes.section) -> nodes.paragraph:
    title = section[0].astext()
    link = nodes.reference("", title, internal=True, refid=section["ids"][0])
    return nodes.paragraph(
        "", "", nodes.strong("", "", link), classes=["summary-section"]
    )


def _summary_rows(entries: Iterable[nodes.Element]) -> Iterator[tuple[Cell, Cell]]:
    for described in entries:
        signature = next(iter(described.findall(addnodes.desc_signature)))
        link = nodes.reference(
            "",
            "",
            code(signature["fullname"]),
            internal=True,
            refid=signature["ids"][0],
        )
        paragraph = next(
            (one for one in described[-1].children if isinstance(one, nodes.paragraph)),
            None,
        )
        yield (
            [link],
            [] if paragraph is None else [one.deepcopy() for one in paragraph.children],
        )


class CommandDirective(SphinxDirective):
    """`command`: usage, help, options and examples of a command."""

    required_arguments = 1
    option_spec: ClassVar = {"without-examples": directives.flag}

    def run(self) -> list[nodes.Node]:
        name = self.arguments[0]
        usage = declared_options.usage(name)
        texts, examples = declared_options.explanation(name)
        own, sharings = declared_options.split(name)
        made: list[nodes.Node] = [
            nodes.paragraph("", "", *inline(text)) for text in texts
        ]
        made.append(_console(usage))
        argument = declared_options.argument_text(name)
        if argument:
            source = usage.rpartition(" ")[2].strip("[]")
            made.append(
                nodes.paragraph(
                    "",
                    "",
                    code(source),
                    nodes.Text(": "),
                    *inline(argument),
                    nodes.Text("."),
                )
            )
        if own:
            made.append(option_table(own, name))
        if sharings:
            made += [
                nodes.paragraph("", "Options shared with other commands:"),
                _sharings(sharings),
            ]
        if examples and "without-examples" not in self.options:
            made.append(_console("\n".join(map(wrapped_command, examples))))
        return made


def _console(text: str) -> nodes.literal_block:
    return nodes.literal_block(text, text, language="console")


def wrapped_command(example: str) -> str:
    """Write an example as it is typed, broken before options that do not fit."""
    words = [
        one if set(one).isdisjoint(" '*") else shlex.quote(one)
        for one in shlex.split(example)
    ]
    parts = re.sub(r" (?=--)", "\n", " ".join(words)).splitlines()
    lines = textwrap.wrap(
        " ".join(part.replace(" ", "\0") for part in parts),
        _CONSOLE_WIDTH,
        break_long_words=False,
    )
    return "$ " + " \\\n    ".join(line.replace("\0", " ") for line in lines)


def _sharings(sharings: Iterable[declared_options.Sharing]) -> nodes.bullet_list:
    items = []
    for one in sharings:
        link = page_link(_OPTIONS, panel_id(one.panel), nodes.Text(one.panel))
        words = one.words()
        items.append(
            nodes.list_item(
                "",
                nodes.paragraph("", "", link, *inline(f": {words}" if words else "")),
            )
        )
    return nodes.bullet_list("", *items)


def panel_id(panel: str) -> str:
    """Return the anchor of a section of shared options."""
    return f"options-{nodes.make_id(panel)}"


def option_table(rows: Iterable[declared_options.Row], name: str) -> nodes.table:
    """Make the table of options; each has an anchor, such as `map-periods`."""
    return table(
        ("option", "value", "meaning"),
        [
            (
                code(one.flag, ids=[f"{name}{one.flag[1:]}"]),
                code(one.values) if one.values else "",
                one.text,
            )
            for one in rows
        ],
        (25, 20, 55),
    )


class SharedOptions(SphinxDirective):
    """`shared-options`: a section for each panel of options that commands share."""

    def run(self) -> list[nodes.Node]:
        made: list[nodes.Node] = []
        for panel, rows in declared_options.shared_options().items():
            section = nodes.section(ids=[panel_id(panel)], names=[])
            section += [nodes.title(panel, panel), option_table(rows, "options")]
            made.append(section)
        return made


class CommandList(SphinxDirective):
    """`command-list`: the commands of a page of the reference, each with its line of help."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        page = f"reference/{self.arguments[0]}"
        self.env.note_dependency(self.env.doc2path(page))
        text = Path(self.env.doc2path(page)).read_text(encoding="utf-8")
        rows = [
            ([_command_link(page, name)], COMMANDS[name].summary)
            for name in re.findall(r"^```\{command\} (\w+)$", text, re.MULTILINE)
        ]
        return [table(("command", "purpose"), rows, (25, 75))]


def _command_link(page: str, name: str) -> nodes.Element:
    """Link to the section of a command, whose title is its usage without "[OPTIONS]"; the link has its anchor too."""
    anchor = nodes.make_id(declared_options.title(name))
    link = page_link(page, anchor, code(name))
    link["ids"].append(anchor)
    return link


def page_link(page: str, anchor: str, shown: nodes.Node) -> nodes.reference:
    """Make a link to an anchor of a page, whose address is known when pages are written."""
    link = nodes.reference("", "", shown, internal=True, refuri=f"#{anchor}")
    link["page"] = page
    return link


def fill_links(app: Sphinx, document: nodes.document, page: str) -> None:
    """Put the addresses of the pages into the links."""
    for link in document.findall(nodes.reference):
        if "page" in link:
            address = app.builder.get_relative_uri(page, link["page"])
            link["refuri"] = address + link["refuri"]


class Kinds(SphinxDirective):
    """`kinds`: the kinds of a part of a description, with the names of their numbers."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        rows = [
            (code(one.name), one.text, codes(one.needed), codes(one.optional))
            for one in declared_fields.kinds(self.arguments[0])
        ]
        return [
            table(("kind", "meaning", "needed", "optional"), rows, (18, 37, 20, 25))
        ]


def _numbers(
    rows: Iterable[declared_fields.Number], *, with_kinds: bool
) -> nodes.table:
    header = ("name", "meaning", "unit", "default", "values", "kinds")
    made = [
        (
            code(one.name),
            one.text,
            one.unit,
            code(one.default) if one.default else "",
            one.range,
            codes(one.kinds) if one.kinds else "all",
        )
        for one in rows
    ]
    count = len(header) if with_kinds else len(header) - 1
    return table(
        header[:count], [row[:count] for row in made], (20, 30, 8, 10, 17, 15)[:count]
    )


class Numbers(SphinxDirective):
    """`numbers`: the declared numbers of a part, with unit, default and range."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        return [_numbers(declared_fields.numbers(self.arguments[0]), with_kinds=True)]


class RunNumbers(SphinxDirective):
    """`run-numbers`: the declared numbers of runs, with unit, default and range."""

    def run(self) -> list[nodes.Node]:
        return [_numbers(declared_fields.numbers_of_runs(), with_kinds=False)]


class Fields(SphinxDirective):
    """`fields`: the keys of a table, from the class that reads it."""

    required_arguments = 1
    option_spec: ClassVar = {"without": directives.unchanged}

    def run(self) -> list[nodes.Node]:
        left_out = self.options.get("without", "").split()
        rows = [
            (
                code(one.name),
                one.type,
                code(one.default) if one.default else "",
                one.text,
            )
            for one in declared_fields.fields_of(
                declared_fields.table_of(self.arguments[0]), left_out
            )
        ]
        return [table(("key", "value", "default", "meaning"), rows, (20, 22, 16, 42))]


_DIRECTIVES: dict[str, type[SphinxDirective]] = {
    "summary": Summary,
    "command": CommandDirective,
    "command-list": CommandList,
    "shared-options": SharedOptions,
    "kinds": Kinds,
    "numbers": Numbers,
    "run-numbers": RunNumbers,
    "fields": Fields,
}


def setup(app: Sphinx) -> dict[str, Any]:
    """Add the directives, and read all declarations."""
    declared_options.shared_options()
    for part in declared_fields.PARTS:
        declared_fields.numbers(part)
    app.add_node(summary)
    for name, one in _DIRECTIVES.items():
        app.add_directive(name, one)
    connect: Callable[..., Any] = app.connect
    connect("doctree-read", fill_summaries)
    connect("doctree-resolved", fill_links)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
