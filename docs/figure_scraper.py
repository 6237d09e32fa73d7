"""Puts animations, figures drawn without pyplot, and links of runs to the laboratory into tutorials and gallery."""

import logging
import textwrap
from pathlib import PurePosixPath
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

from stylobate import Run
from stylobate.config.snippets import as_toml
from stylobate.errors import UnsupportedError
from stylobate.lab.links import (
    case_of_objects,
    case_of_provenance,
    is_answered_in_the_page,
)
from stylobate.plots import Animation

_DPI = 100

# A page is the same whether its kernels were compiled before or not.
logging.getLogger("stylobate.compiling").setLevel(logging.ERROR)


def new_figures(
    block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any], **options: Any
) -> str:
    """Save each new figure or animation that a variable of the example holds; return its RST."""
    del block, options
    variables = block_vars["example_globals"]
    shown = variables.setdefault("__shown__", [])
    images = []
    for value in list(variables.values()):
        if not isinstance(value, (Figure, Animation)) or any(
            value is one for one in shown
        ):
            continue
        shown.append(value)
        if (
            isinstance(value, Figure)
            and getattr(value.canvas, "manager", None) is not None
        ):
            continue  # pyplot's own, which sphinx-gallery finds, and closes afterwards
        path = PurePosixPath(next(block_vars["image_path_iterator"]))
        images.append(_saved(value, path, gallery_conf))
    return "\n".join(images)


def links_of_runs(
    block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any], **options: Any
) -> str:
    """Return the RST of a link to the laboratory for each new run that a variable of the example holds.

    A case that the example repeats has one link. Runs that the laboratory of the site does not open have none. An
    example without runs has a link to the case of its only model and base motion.
    """
    del block, gallery_conf, options
    variables = block_vars["example_globals"]
    seen = variables.setdefault("__runs__", [])
    linked = variables.setdefault("__cases__", [])
    runs = {
        name: value
        for name, value in variables.items()
        if isinstance(value, Run) and not any(value is one for one in seen)
    }
    seen += runs.values()
    cases = {name: _case(run) for name, run in runs.items()}
    if not seen and not linked:
        cases = {"": case_of_objects(variables.values())}
    links = []
    for name, case in cases.items():
        if case and is_answered_in_the_page(case) and case not in linked:
            linked.append(case)
            label = f"Open “{name}” in the laboratory" if len(runs) > 1 else ""
            links.append(
                f"\n.. laboratory:: {label}\n\n{textwrap.indent(as_toml(case), '   ')}\n"
            )
    return "".join(links)


def _case(run: Run) -> dict[str, Any] | None:
    """Return the case of a run, or None if descriptions do not support it."""
    try:
        return case_of_provenance(run.provenance)
    except UnsupportedError:
        return None


def _saved(
    picture: Figure | Animation, path: PurePosixPath, gallery_conf: dict[str, Any]
) -> str:
    if isinstance(picture, Animation):
        moving = picture.save(path.with_suffix(".gif"))
        return figure_rst(
            [moving], gallery_conf["src_dir"], "Animation: the column on its base"
        )
    picture.savefig(path, dpi=_DPI)
    paths = {0: path}
    for factor in gallery_conf["image_srcset"]:
        paths[factor] = path.with_name(
            f"{path.stem}_{factor:.2f}".replace(".", "_") + f"x{path.suffix}"
        )
        picture.savefig(paths[factor], dpi=factor * _DPI)
    return figure_rst(
        [path], gallery_conf["src_dir"], _description(picture), srcsetpaths=[paths]
    )


def _description(figure: Figure) -> str:
    """Describe the panels of a figure by their titles and axes, as the alternative text of the figure."""
    suptitle = getattr(figure, "_suptitle", None)
    panels = [suptitle.get_text()] if suptitle else []
    panels += [
        words
        for axes in figure.axes
        if axes.get_label() != "<colorbar>" and (words := _panel(axes))
    ]
    return "; ".join(dict.fromkeys(panels)).replace("$", "").replace("\\", "")


def _panel(axes: Axes) -> str:
    title = next(
        (
            text
            for place in ("left", "center", "right")
            if (text := axes.get_title(loc=place))
        ),
        "",
    )
    x, y = axes.get_xlabel(), axes.get_ylabel()
    over = f"{y} against {x}" if x and y else y or x
    return ": ".join(part for part in (title, over) if part)
