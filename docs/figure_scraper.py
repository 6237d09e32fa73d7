"""Puts figures that are drawn without pyplot, such as those of `sb.plot`, into the pages of tutorials and gallery."""

from pathlib import PurePosixPath
from typing import Any
from weakref import WeakSet

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

_DPI = 100
_shown: WeakSet[Figure] = WeakSet()


def new_figures(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any], **options: Any) -> str:
    """Save each figure that a variable of the example holds and no block before has shown; return its RST."""
    del block, options
    found = {id(value): value for value in block_vars["example_globals"].values() if isinstance(value, Figure)}
    images = []
    for figure in found.values():
        if figure in _shown or getattr(figure.canvas, "manager", None) is not None:
            continue
        _shown.add(figure)
        images.append(_saved(figure, PurePosixPath(next(block_vars["image_path_iterator"])), gallery_conf))
    return "\n".join(images)


def _saved(figure: Figure, path: PurePosixPath, gallery_conf: dict[str, Any]) -> str:
    figure.savefig(path, dpi=_DPI)
    paths = {0: path}
    for factor in gallery_conf["image_srcset"]:
        paths[factor] = path.with_name(f"{path.stem}_{factor:.2f}".replace(".", "_") + f"x{path.suffix}")
        figure.savefig(paths[factor], dpi=factor * _DPI)
    suptitle = getattr(figure, "_suptitle", None)
    titles = [suptitle.get_text()] if suptitle else [axes.get_title() for axes in figure.axes]
    title = "; ".join(one for one in titles if one)
    return figure_rst([path], gallery_conf["src_dir"], title, srcsetpaths=[paths])
