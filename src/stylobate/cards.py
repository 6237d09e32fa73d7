"""Cards: what notebooks show of a value, as one table in HTML."""

import re
from collections.abc import Iterable, Sequence
from html import escape
from typing import NamedTuple

# Colours are those of the notebook, light or dark; names and lines are paler.
_CARD = "border-collapse:collapse;color:inherit;background:none;font-size:inherit;margin:0.3em 0"
_TITLE = "caption-side:top;text-align:left;font-weight:bold;color:inherit;padding:0 0 0.3em"
_CELL = "text-align:left;vertical-align:top;color:inherit;background:none;border:none;padding:0.1em 1.2em 0.1em 0"
_LINE = "border-top:1px solid color-mix(in srgb, currentColor 30%, transparent)"
_PALE = "opacity:0.75;font-weight:normal"
_NAME = f"{_CELL};{_PALE};white-space:nowrap"
_SUBSCRIPT = re.compile(r"_(\w+)")


class Row(NamedTuple):
    """A row of a card: name, symbol, value with unit, and the meaning, which appears when the pointer rests on it."""

    name: str
    value: str
    symbol: str = ""
    meaning: str = ""


class CardSection(NamedTuple):
    """Rows of a card below a heading; the first section of a card has none."""

    heading: str
    rows: Sequence[Row]


def card(title: str, sections: Iterable[CardSection], folded: CardSection | None = None) -> str:
    """Render a title and sections of rows as a table in HTML; sections without rows are left out.

    A `folded` section stands below the table; a click on its heading shows its rows.
    """
    body = "".join(map(_section, (one for one in sections if one.rows)))
    table = f'<table style="{_CARD}"><caption style="{_TITLE}">{escape(title)}</caption>{body}</table>'
    if folded is None or not folded.rows:
        return table
    rows = _section(folded._replace(heading=""))
    summary = f'<summary style="{_PALE}">{escape(folded.heading)}</summary>'
    return f'{table}<details>{summary}<table style="{_CARD}">{rows}</table></details>'


def _section(section: CardSection) -> str:
    heading = (
        f'<tr><th colspan="3" style="{_CELL};{_PALE};{_LINE}">{escape(section.heading)}</th></tr>'
        if section.heading
        else ""
    )
    return f"<tbody>{heading}{''.join(map(_row, section.rows))}</tbody>"


def _row(row: Row) -> str:
    meaning = f' title="{escape(row.meaning)}"' if row.meaning else ""
    symbol = _SUBSCRIPT.sub(r'<sub style="line-height:0">\1</sub>', escape(row.symbol))
    return (
        f'<tr style="background:none"><th scope="row"{meaning} style="{_NAME}">{escape(row.name)}</th>'
        f'<td style="{_CELL};font-style:italic">{symbol}</td>'
        f'<td style="{_CELL}">{escape(row.value)}</td></tr>'
    )
