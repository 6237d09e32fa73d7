"""A self-contained web page of text, figures and tables: one file, nothing fetched."""

import base64
import logging
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from io import BytesIO
from typing import Any

from matplotlib.figure import Figure

from stylobate.errors import require_extra
from stylobate.plots.result_figure import remark_on_glyphs
from stylobate.text import printable

# Dots per inch of embedded figures; the page scales them to its width.
_RESOLUTION = 160
# Tables of this many columns or more are printed small.
_MANY_COLUMNS = 9

_STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.55 system-ui, sans-serif; color: #1a1a1a; background: #fff; margin: 2rem auto; max-width: 60rem;
  padding: 0 1rem; }
h1 { line-height: 1.2; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #ccc; }
figure { margin: 1.5rem 0; } figure img { max-width: 100%; height: auto; }
figcaption { font-size: .92rem; color: #333; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; }
th, td { text-align: left; vertical-align: top; padding: .4rem .6rem; border-bottom: 1px solid #ddd; }
body { overflow-wrap: break-word; } th.long, td.long { overflow-wrap: anywhere; min-width: 2.3cm; }
thead th { border-bottom: 2px solid #666; }
.verdict { font-weight: 600; white-space: nowrap; }
nav a { margin-right: 1rem; }
@media print { body { font-size: 10pt; max-width: none; margin: 0; } nav { display: none; }
  table { font-size: 7.5pt; } .many table { font-size: 6.3pt; } .wide { overflow: visible; }
  thead { display: table-header-group; }
  tr, figure { break-inside: avoid; } h2 { break-after: avoid; } }
"""


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure with its `caption`, which is also the text for readers who cannot see the figure.

    `drawn` is the PNG of the figure by `png_of`, if it was computed before.
    """

    figure: Figure
    caption: str
    drawn: bytes = b""


@dataclass(frozen=True, slots=True)
class PageTable:
    """Rows of plain text below a `header`."""

    header: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True, slots=True)
class PageList:
    """A list of plain texts; of each, the words before the first colon are bold."""

    items: Sequence[str]


Part = str | Picture | PageTable | PageList
"""What a page consists of; text is a paragraph."""


@dataclass(frozen=True, slots=True)
class PageSection:
    """A heading with paragraphs, pictures, tables and lists, in this order of `content`."""

    heading: str
    content: Sequence[Part]


def page(
    title: str, introduction: Sequence[Part], sections: Sequence[PageSection], *, style: str = "", author: str = ""
) -> str:
    """Return the HTML of a page; all text is escaped, figures are embedded as PNG.

    Parameters
    ----------
    title, author
        Title of the page and, for its metadata, the name of its author.
    introduction, sections
        Content before the links to the sections, and the sections.
    style
        Style rules after those of all pages.
    """
    links = "".join(f'<a href="#s{i}">{escape(section.heading)}</a>' for i, section in enumerate(sections))
    body = "".join(_section(i, section) for i, section in enumerate(sections))
    lead = "".join(map(_part, introduction))
    named = f'<meta name="author" content="{escape(author)}">' if author else ""
    return printable(
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">{named}'
        f"<title>{escape(title)}</title><style>{_STYLE}{style}</style></head>"
        f"<body><h1>{escape(title)}</h1>{lead}<nav>{links}</nav>{body}</body></html>\n"
    )


def style_text(text: str) -> str:
    r"""Return `text` as a string of a style sheet; it cannot end the string or the style element.

    >>> print(style_text("A </style>"))
    "A \3c \2f style\3e "
    """
    return '"' + "".join(one if one.isalnum() or one in " .,-–:" else f"\\{ord(one):x} " for one in text) + '"'


# Minus signs for hyphens, and no line break, in numbers such as -0.025 and 2e-12.
_MINUS = re.compile(r"(?<![\w)])-(?=\d)")
_EXPONENT = re.compile(r"(?<=\de)-(?=\d)")


def _text(text: str) -> str:
    return escape(_EXPONENT.sub("\u2011", _MINUS.sub("−", text)))


def _section(index: int, section: PageSection) -> str:
    parts = "".join(_part(part) for part in section.content)
    return f'<section id="s{index}"><h2>{escape(section.heading)}</h2>{parts}</section>'


def _part(part: Part) -> str:
    match part:
        case str():
            return f"<p>{_text(part)}</p>"
        case PageList():
            return f"<ul>{''.join(map(_item, part.items))}</ul>"
        case Picture():
            return _picture(part)
        case PageTable():
            return _table(part)


def _item(text: str) -> str:
    subject, colon, rest = text.partition(":")
    return f"<li><strong>{_text(subject)}</strong>{colon}{_text(rest)}</li>" if colon else f"<li>{_text(text)}</li>"


def png_of(figure: Figure, resolution: float = _RESOLUTION) -> bytes:
    """Return the figure as a PNG of this resolution [dots per inch], by default that of a page."""
    buffer = BytesIO()
    figure.savefig(buffer, format="png", dpi=resolution)
    return buffer.getvalue()


def _picture(picture: Picture) -> str:
    data = base64.b64encode(picture.drawn or png_of(picture.figure)).decode("ascii")
    caption = escape(picture.caption)
    return (
        f'<figure><img alt="{caption}" src="data:image/png;base64,{data}"><figcaption>{caption}</figcaption></figure>'
    )


def _table(table: PageTable) -> str:
    head = "".join(f"<th{_kind(name)}>{escape(name)}</th>" for name in table.header)
    rows = "".join(
        "<tr>" + "".join(f"<td{_kind(cell)}>{_text(cell)}</td>" for cell in row) + "</tr>" for row in table.rows
    )
    kind = "wide many" if len(table.header) >= _MANY_COLUMNS else "wide"
    return f'<div class="{kind}"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>'


# A cell with a longer word, such as a name without blanks, breaks anywhere.
_LONG_WORD = re.compile(r"\S{19}")


def _kind(cell: str) -> str:
    return ' class="long"' if _LONG_WORD.search(cell) else ""


def pdf_of(html: str) -> bytes:
    """Set a page as a PDF: with page numbers if its style asks for them, and a bookmark for each heading.

    Raises
    ------
    UnsupportedError
        If WeasyPrint, or Pango which it needs, is not installed.
    """
    library = require_pdf()
    missing: dict[str, None] = {}

    def noticed(record: logging.LogRecord) -> bool:
        if is_glyph := "glyph" in str(record.msg) and bool(record.args):
            missing[str(record.args[0])] = None  # type: ignore[index]
        return not is_glyph

    log = logging.getLogger("weasyprint")
    log.addFilter(noticed)
    try:
        written: bytes = library.HTML(string=html).write_pdf(pdf_tags=True)
    finally:
        log.removeFilter(noticed)
    if missing:
        remark_on_glyphs(missing, "Install a font that has them, such as Noto Sans CJK")
    return written


def require_pdf() -> Any:
    """Return WeasyPrint, or raise UnsupportedError if it or the library Pango is not installed."""
    return require_extra(
        "weasyprint",
        'a PDF needs WeasyPrint and the library Pango: pip install "stylobate[pdf]", and Pango by the system\'s '
        "packages; or print the page in a browser",
    )
