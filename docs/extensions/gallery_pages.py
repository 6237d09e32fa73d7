"""Pages of tutorials and gallery: thumbnails have words, and buttons for downloads stay out of the search."""

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

# Containers at the end of each example, with the links that download it.
_FOOTER = "sphx-glr-footer"


def keep_from_search(app: Sphinx, document: nodes.document) -> None:
    """Keep the footers of examples out of the search, where each would be found by "zip" and "notebook"."""
    del app
    for container in document.findall(nodes.container):
        if _FOOTER in container["classes"]:
            container["classes"].append("no-search")


def name_thumbnails(app: Sphinx, document: nodes.document, page: str) -> None:
    """Give each thumbnail the title of the example that it leads to, which the next link shows."""
    del app, page
    for image in document.findall(nodes.image):
        if "/thumb/" in image["uri"] and not image.get("alt"):
            link = image.next_node(nodes.reference, ascend=True)
            image["alt"] = "" if link is None else link.astext()


def setup(app: Sphinx) -> dict[str, Any]:
    """Change the pages when they have been read, and when their links are known."""
    app.connect("doctree-read", keep_from_search)
    app.connect("doctree-resolved", name_thumbnails)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
