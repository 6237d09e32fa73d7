"""Animation as a self-contained web page: the viewer and the numbers in one file, nothing fetched."""

import base64
import hashlib
import json
from collections.abc import Mapping
from html import escape
from importlib.resources import files
from typing import Any

from stylobate.errors import UnsupportedError

_STYLE = """
:root { color-scheme: light dark; }
html, body { height: 100%; margin: 0; }
#viewer { height: 100%; }
noscript { display: block; padding: 2rem; font: 16px/1.5 system-ui, sans-serif; }
"""

_START = """
stylobateViewer.mount(document.getElementById("viewer"), JSON.parse(document.getElementById("motion").textContent));
"""


def page_of(motion: Mapping[str, Any]) -> str:
    """Return the HTML of a page that shows a motion in three dimensions, with controls to turn and stop it.

    The page may run only its own two scripts, identified by their hashes, and may not load anything.

    Raises
    ------
    UnsupportedError
        If the viewer was not built.
    """
    viewer, title = _viewer(), escape(str(motion["title"]))
    numbers = json.dumps(motion, ensure_ascii=False, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    policy = (
        f"default-src 'none'; script-src {_hash(viewer)} {_hash(_START)}; style-src {_hash(_STYLE)}; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{title}</title><style>{_STYLE}</style></head>"
        f'<body><div id="viewer"></div><noscript>{title}. The animation needs scripts, which are in this file.'
        f'</noscript><script type="application/json" id="motion">{numbers}</script>'
        f"<script>{viewer}</script><script>{_START}</script></body></html>\n"
    )


def _viewer() -> str:
    """Return the viewer's script, escaped so that no part of the script ends its element."""
    try:
        text = files("stylobate.plots.animation").joinpath("viewer.js").read_text(encoding="utf-8")
    except FileNotFoundError:
        message = (
            "an HTML animation needs viewer.js, which wheels of stylobate hold; from sources make it by "
            "'npm ci && npm run build' in src/stylobate/lab/web, or write a .gif"
        )
        raise UnsupportedError(message) from None
    # Line ends as browsers read them; otherwise the hash would not match.
    return text.replace("\r\n", "\n").replace("</script", "<\\/script").replace("<!--", "<\\!--")


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
