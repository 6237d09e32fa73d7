"""Settings of the documentation: MyST pages, executed examples, reference from docstrings; all of it offline."""

import re
import sys
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import Any

from sphinx.domains.math import MathDomain

_HERE = Path(__file__).parent
sys.path[:0] = [
    str(_HERE),
    str(_HERE / "extensions"),
]  # `figure_scraper`, and the directives of the reference

project = "stylobate"
author = "The stylobate developers"
copyright = f"{author}, MIT licence"  # noqa: A001  the name that Sphinx asks for
release = installed_version("stylobate")
language = "en"

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.intersphinx",  # types in signatures link to NumPy, xarray, Matplotlib, SciPy and Python
    "sphinx.ext.viewcode",  # links to the source, which is part of the site
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # the files of MathJax, so that no page fetches anything
    "sphinx_copybutton",
    "sphinx_design",  # cards
    "sphinx_gallery.gen_gallery",
    "sphinxcontrib.bibtex",
    "citations",  # docs/extensions: BibTeX from CITATION.cff
    "gallery_pages",  # docs/extensions: words of thumbnails; downloads stay out of the search
    "laboratory_links",  # docs/extensions: links that open a case in the laboratory
    "source_links",  # docs/extensions: links from source code back to the reference
    "stylobate_reference",  # docs/extensions: summaries, options of commands and fields of files from declarations
]
exclude_patterns = ["_build", "inventories", "extensions"]
myst_enable_extensions = [
    "dollarmath",
    "colon_fence",
    "deflist",
    "attrs_inline",
    "attrs_block",
]
myst_heading_anchors = 3
# `laboratory:lesson=stands` leads to the laboratory beside the pages: docs/extensions/laboratory_links.py
myst_url_schemes = ["http", "https", "mailto", "laboratory"]
myst_html_meta = {
    "description": "Free-standing round columns on shaking bases: simulate whether they stay, rock, roll or overturn.",
}

# In our docstrings single backticks mean code.
default_role = "literal"
napoleon_google_docstring = False
napoleon_use_ivar = True
# Parameters that share a text, "tilt, tilt_rate", share one entry.
napoleon_use_param = False
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 88

# The names of other packages that signatures and pages use: text files, so that a build fetches nothing.
intersphinx_mapping = {
    name: (address, str(_HERE / "inventories" / f"{name}.txt"))
    for name, address in {
        "python": "https://docs.python.org/3",
        "numpy": "https://numpy.org/doc/stable",
        "scipy": "https://docs.scipy.org/doc/scipy",
        "xarray": "https://docs.xarray.dev/en/stable",
        "matplotlib": "https://matplotlib.org/stable",
        "pillow": "https://pillow.readthedocs.io/en/stable",
    }.items()
}

bibtex_bibfiles = ["../paper/paper.bib"]
bibtex_default_style = "unsrt"
bibtex_reference_style = "author_year"

copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

# Tutorials and gallery: programs that run while the site is built; their figures and output become part of their pages.
sphinx_gallery_conf = {
    "examples_dirs": ["../examples/tutorials", "../examples/gallery"],
    "gallery_dirs": ["tutorials", "gallery"],
    "filename_pattern": r"\.py$",
    "within_subsection_order": "FileNameSortKey",
    "subsection_order": [
        f"../examples/gallery/{folder}"
        for folder in (
            "rocking_and_rolling",
            "columns_and_motions",
            "earthquakes",
            "maps_and_basins",
            "orbits",
            "models",
            "conveyors",
            "plots_and_animations",
        )
    ],
    "image_scrapers": (
        "figure_scraper.new_figures",
        "matplotlib",
        "figure_scraper.links_of_runs",
    ),
    "capture_repr": (),  # text is what an example prints; figures are shown as images
    "image_srcset": ["2x"],
    "thumbnail_size": (480, 320),
    "remove_config_comments": True,
    "abort_on_example_error": True,
    "show_memory": False,
    "min_reported_time": 1e9,
    "write_computation_times": False,
    "doc_module": ("stylobate",),
    "reference_url": {"stylobate": None},
    "prefer_full_module": {r"stylobate\."},
    "download_all_examples": False,
    "parallel": 2,
}
# A name in a signature or a link that no page describes is an error, but for types that users never construct.
nitpicky = True
nitpick_ignore_regex = [
    ("py:class", pattern)
    for pattern in (
        r"stylobate\.orbits\.(arclength|curves|shooting)\.\w+",  # inner values of branches and orbits
        r"stylobate\.models\.(model\.ClosedForm|sliding\.balance\.SlidingNumbers)",  # inner values of models
        r"stylobate\.plots\.(animation\.drawing|body|figure|geometry|kinds|page)\.\w+",  # parts of figures and reports
        r"stylobate\.base_motions\.record\.RecordOrigin",  # kept for files
        r"stylobate\.base_motions\.combined\.(Scaled|Rotated|Delayed|Offset)",  # made by methods of motions
        r"stylobate\.models\.model\.Push|stylobate\.results\.findings\.\w+",  # inner values of models and of the paper
        r"stylobate\.(earthquakes\.intensities\.Intensity|records\.intensities\.HorizontalComponent)",  # given as texts
        r"stylobate\.earthquakes\.property_spreads\.Spread",  # any of the spreads
        r"(stylobate\.studies\.sweeps\.(chunks|designs|executors)\.)?(Computed|Design|Task|Work)",  # given by sweeps
        r"stylobate\.earthquakes\.config\.(fragility\.Fragility|hazard\.HazardPoints)",  # shown as tables of keys
        r"starlette\.applications\.Starlette",  # has no inventory of names
        r"(pd|pandas)\.DataFrame|plotly\.graph_objects\.Figure",  # neither have these here
        r"Figure|matplotlib\.axes\._axes\.Axes",  # the inventory has matplotlib.axes.Axes
        r"stylobate\.(quantities\.Stated|plots\.orbits\.DrawnOrbit)",  # inner values of motions and figures
        r"ArrayLike",  # in signatures that are made
    )
]
# Declared numbers of properties.
nitpick_ignore_regex += [("py:obj", r"typing\.Annotated.*|over")]
suppress_warnings = ["config.cache"]

html_theme = "furo"
html_title = f"stylobate {release}"
html_logo = "_static/logo.svg"
html_favicon = "_static/favicon.svg"
html_static_path = ["_static"]
html_css_files = ["page.css"]
html_copy_source = False

# The laboratory as static files becomes part of the site if it has been written (make static-lab). Without it,
# or with -D static_laboratory= on the command line, the pages say how to start it in place of links.
static_laboratory = (
    "../static-lab" if (_HERE / "../static-lab/index.html").is_file() else ""
)
html_show_sphinx = False

# Text between backticks stays as it is; elsewhere |α| is an amount and no substitution of reStructuredText.
_CODE = re.compile(r"(`[^`]*`)")


def _escape_bars(
    app: Any, what: str, name: str, thing: object, options: object, lines: list[str]
) -> None:
    del app, what, name, thing, options
    for index, line in enumerate(lines):
        if "|" in line and not line.lstrip().startswith(">>>"):
            parts = _CODE.split(line)
            lines[index] = "".join(
                part if part.startswith("`") else part.replace("|", r"\|")
                for part in parts
            )


# Napoleon takes what stands before a colon in the first line of a property for its type: the colon hides from it.
_HIDDEN_COLON = "\ue000"


def _hide_colons(
    app: Any, what: str, name: str, thing: object, options: object, lines: list[str]
) -> None:
    del app, name, thing, options
    if what in ("attribute", "data", "property") and lines:
        lines[0] = lines[0].replace(":", _HIDDEN_COLON)


def _show_colons(
    app: Any, what: str, name: str, thing: object, options: object, lines: list[str]
) -> None:
    del app, what, name, thing, options
    lines[:] = [line.replace(_HIDDEN_COLON, ":") for line in lines]


# Attributes that share a text, "tilt, tilt_rate": Sphinx would take the first for a type of the second.
_SHARED_TEXT = re.compile(r"^:ivar ((?:\w+, )+\w+):")


def _finish_attributes(
    app: Any, what: str, name: str, thing: object, options: object, lines: list[str]
) -> None:
    del app, what, name, thing, options
    for index, line in enumerate(lines):
        line = _SHARED_TEXT.sub(  # noqa: PLW2901
            lambda match: f":ivar {match[1].replace(' ', '')}:", line
        )
        if line.startswith(":vartype "):
            line = _named(line, {}) or ""  # noqa: PLW2901
        lines[index] = line


def _space_names(app: Any, document: Any) -> None:
    del app
    from docutils import nodes
    from sphinx import addnodes

    for node in document.findall(addnodes.literal_strong):
        node.children = [nodes.Text(node.astext().replace(",", ", "))]


def _aliases() -> dict[str, str]:
    # numpy's aliases arrive written out in full, and classes with the module where they are defined: in signatures
    # both get the names by which users know them.
    import numpy as np
    import numpy.typing as npt
    from sphinx.util.typing import stringify_annotation

    named = {
        "~numpy.typing.ArrayLike": npt.ArrayLike,
        "~numpy.typing.NDArray[~numpy.float64]": npt.NDArray[np.float64],
        "~numpy.typing.NDArray[~numpy.complex128]": npt.NDArray[np.complex128],
        "~numpy.typing.NDArray[~numpy.int64]": npt.NDArray[np.int64],
        "~numpy.typing.NDArray[~numpy.bool]": npt.NDArray[np.bool_],
    }
    return {
        stringify_annotation(alias, "smart"): name for name, alias in named.items()
    } | {
        "~xarray.core.dataset.Dataset": "~xarray.Dataset",
        "~xarray.core.dataarray.DataArray": "~xarray.DataArray",
        "~xarray.core.datatree.DataTree": "~xarray.DataTree",
        "~numpy.random._generator.Generator": "~numpy.random.Generator",
    }


# Annotations that only the type checker reads keep the short names of their file.
_SHORT = re.compile(r"(?<![\w.~])(npt|np|xr)\.(?=[A-Za-z])")
_MODULES = {"npt": "~numpy.typing.", "np": "~numpy.", "xr": "~xarray."}


# A declared number has a type, and a quantity or a check: signatures show the type, docstrings describe the number.
_ANNOTATED = re.compile(r"~?(?:\w+\.)*Annotated\[")
_MARK = re.compile(r"""'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*"|[][(){},]""")


def _without_annotations(text: str) -> str:
    while start := _ANNOTATED.search(text):
        depth, comma, end = 0, len(text), len(text)
        for mark in _MARK.finditer(text, start.end()):
            if mark[0] in ("[", "(", "{"):
                depth += 1
            elif mark[0] == "," and not depth:
                comma = min(comma, mark.start())
            elif mark[0] in ("]", ")", "}"):
                depth -= 1
                if depth < 0:
                    end = mark.end()
                    break
        text = text[: start.start()] + text[start.end() : comma] + text[end:]
    return text


class NumbersOfThePaper(MathDomain):
    """Equations labelled "eq-7" have the number 7, which the source paper gives them, on whatever page they stand."""

    def note_equation(self, docname: str, labelid: str, location: Any = None) -> None:
        """Register an equation."""
        super().note_equation(docname, labelid, location=location)
        if number := re.fullmatch(r"eq-(\d+)", labelid):
            self.equations[labelid] = (docname, int(number[1]))


def setup(app: Any) -> None:
    """Connect what docstrings and signatures need, and number equations as the source paper does."""
    app.add_domain(NumbersOfThePaper, override=True)
    aliases = _aliases()

    def name_aliases(*event: Any) -> tuple[str | None, str | None]:
        if hasattr(
            event[3], "model_fields"
        ):  # the keys of a file: listed on the page of description files
            return "", None
        return _named(event[-2], aliases), _named(event[-1], aliases)

    app.connect("autodoc-process-docstring", _escape_bars)
    app.connect("autodoc-process-docstring", _hide_colons, priority=400)
    app.connect("autodoc-process-docstring", _show_colons, priority=600)
    app.connect("autodoc-process-docstring", _finish_attributes, priority=600)
    app.connect("doctree-read", _space_names)
    app.connect("autodoc-process-signature", name_aliases)


def _named(signature: str | None, aliases: dict[str, str]) -> str | None:
    if not signature:
        return signature
    signature = signature.replace("<factory>", "...")  # so that it can be parsed
    for alias, name in aliases.items():
        signature = signature.replace(alias, name)
    return _SHORT.sub(lambda match: _MODULES[match[1]], _without_annotations(signature))
