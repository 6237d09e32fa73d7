"""Links from pages of source code back to the reference.

`sphinx.ext.viewcode` assumes that the reference describes all names of a file under one module. A file whose names
stand partly in `stylobate` and partly in a subpackage would have links to anchors that do not exist.
"""

import re
from collections.abc import Iterable
from typing import Any

from sphinx.application import Sphinx
from sphinx.util import logging

_LINK = re.compile(r'(<a class="viewcode-back" href="[^"#]*#)([^"]+)"')


def described_as(anchor: str, described: Iterable[str]) -> str | None:
    """Return the anchor under which the reference describes a name: the one with the longest common end.

    >>> described_as("stylobate.models.Push.x", ["stylobate.Push", "stylobate.Push.x", "stylobate.Pull.x"])
    'stylobate.Push.x'
    >>> described_as("stylobate.models.Pull", ["stylobate.Push"])
    """
    known = set(described)
    if anchor in known:
        return anchor
    parts = anchor.split(".")
    for begin in range(1, len(parts)):
        end = "." + ".".join(parts[begin:])
        if found := [name for name in known if name.endswith(end)]:
            return min(found, key=len)
    return None


def _repair(
    app: Sphinx, page: str, template: str, context: dict[str, Any], document: object
) -> None:
    del template, document
    if not page.startswith("_modules/") or "body" not in context:
        return
    described = [
        entry.node_id for entry in app.env.domains["py"].data["objects"].values()
    ]

    def repaired(match: re.Match[str]) -> str:
        anchor = described_as(match[2], described)
        if anchor is None:
            logging.getLogger(__name__).warning(
                "%s links to %s, which no page describes", page, match[2]
            )
        return f'{match[1]}{anchor or match[2]}"'

    context["body"] = _LINK.sub(repaired, context["body"])


def setup(app: Sphinx) -> dict[str, Any]:
    """Repair the links when the pages of source code are written."""
    app.connect("html-page-context", _repair)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
