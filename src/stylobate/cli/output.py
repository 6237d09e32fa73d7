"""Output of commands: tables and JSON on stdout, figures and data in files."""

import json
import math
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from stylobate.errors import FileError, ParameterError, require_positive
from stylobate.files import write_whole
from stylobate.text import unit_in_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure


NETCDF, STORE = ".nc", ".zarr"
"""Endings of files and of stores."""
PAGE = ".html"
FIGURES = (".png", ".pdf", ".svg", PAGE)
"""Endings of figures."""


def print_json(values: Any) -> None:
    """Print `values` as JSON; a number that is not finite becomes null."""
    print(json.dumps(_finite(values), indent=2, ensure_ascii=False))


def print_table(title: str, rows: Sequence[Sequence[str]], header: Sequence[str] | None = None) -> None:
    """Print `rows` as a table with the width of the terminal; a table with a header has its title below."""
    from rich.console import Console  # noqa: PLC0415  only tables need it
    from rich.table import Table  # noqa: PLC0415

    table = Table(show_header=header is not None)
    for name in header or [""] * len(rows[0] if rows else ()):
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*row)
    width = None if sys.stdout.isatty() else _PLAIN_WIDTH
    console = Console(width=width, markup=False, emoji=False, highlight=False)
    console.print(table)
    if header is not None:
        console.print(title, soft_wrap=True)


class Practical(NamedTuple):
    """A unit of a column of a table: its name, and the factor of numbers in SI units."""

    factor: float
    name: str

    @property
    def bracketed(self) -> str:
        """The unit in brackets; empty without unit."""
        return f"[{self.name}]" if self.name else ""


DEGREES = Practical(180.0 / math.pi, "°")


def practical(values: Iterable[float], units: str) -> Practical:
    """Choose the unit of a table: millimetres if all lengths or speeds are below one metre, and degrees.

    Parameters
    ----------
    values
        The numbers in SI units; those that are not finite do not count.
    units
        Their units as in netCDF files, such as "m s-1".
    """
    unit = unit_in_text(units)
    if unit == "rad":
        return DEGREES
    if unit in ("m", "m/s") and max((abs(one) for one in values if math.isfinite(one)), default=0.0) < 1.0:
        return Practical(1000.0, f"m{unit}")
    return Practical(1.0, unit)


def deliver(
    result: Any,
    options: Mapping[str, Any],
    save: Callable[[Any, Path], None],
    summary: Callable[[Any], Any],
    show: Callable[[Any], None],
    label: str | None = None,
) -> None:
    """Write a result into the files that the options name, and print it.

    Parameters
    ----------
    result
        A run or the result of a study.
    options
        Options of the command: output, figure, as_json.
    save
        Function that writes the result into the file `output`.
    summary
        Function that returns plain values for JSON.
    show
        Function that prints a table.
    label
        Label of the result in its figure.
    """
    if options["output"] is not None:
        save(result, options["output"])
    if options["figure"] is not None:
        save_plot(result, options["figure"], label)
    if options["as_json"]:
        print_json(summary(result))
    else:
        show(result)


def check_writable(figure: Path | None, output: Path | None = None, *, stores: bool = False) -> None:
    """Raise an error before the computation for a path that is not writable.

    Parameters
    ----------
    figure
        A file whose ending names a format for figures.
    output
        File of the data: netCDF, or a store if `stores` is true.
    stores
        Whether the command supports stores.

    Raises
    ------
    ParameterError
        If the ending is not one of a supported format.
    FileError
        If the path is a folder, or its parent folder is missing.
    """
    if figure is not None and figure.suffix.lower() not in FIGURES:
        message = f"cannot draw into {figure}: --figure must end with {', '.join(FIGURES[:-1])} or {FIGURES[-1]}"
        raise ParameterError(message)
    if figure is not None and figure.suffix.lower() == PAGE and find_spec("plotly") is None:
        message = f"cannot draw into {figure}: interactive figures need Plotly (pip install stylobate[interactive])"
        raise ParameterError(message)
    if output is not None:
        endings = (NETCDF, STORE) if stores else (NETCDF,)
        if output.suffix not in endings:
            message = f"--output must end with {' or '.join(endings)}, got {str(output)!r}"
            raise ParameterError(message)
        if output.suffix == STORE and output.is_dir():  # to continue; nothing is written if the store is complete
            output = None
    for path in (figure, output):
        if path is not None:
            check_place(path)


def check_animation(path: Path, speed: float | None) -> None:
    """Raise an error before the run for an animation that cannot be made.

    Raises
    ------
    ParameterError
        If the suffix is not .gif, .mp4 or .html, or the speed is not positive.
    FileError
        If the path is a folder, or its parent folder is missing.
    """
    from stylobate.plots.animation.animation import checked_path  # noqa: PLC0415  only animations need it

    check_place(checked_path(path))
    if speed is not None:
        require_positive("speed", speed)


def check_place(path: Path) -> None:
    """Raise FileError if the path is a folder, or its parent folder is missing or not writable."""
    folder = path.parent
    if path.is_dir() or not folder.is_dir() or not os.access(path if path.exists() else folder, os.W_OK):
        reason = "it is a folder" if path.is_dir() else f"{folder} is not a writable folder"
        message = f"cannot write {path}: {reason}"
        raise FileError(message)


def save_plot(result: Any, path: Path, label: str | None = None) -> None:
    """Write the figure of `result`, with its `label`, into `path`: a page if it ends in .html, else a picture.

    A page has the interactive figure of the result, or its picture if there is no interactive one.

    Raises
    ------
    FileError
        If the file cannot be written, or its ending is not a format for figures.
    """
    from stylobate import plots  # noqa: PLC0415  slow to import

    labels = None if label is None else [label]
    if path.suffix.lower() != PAGE:
        save_figure(plots.plot(result, labels=labels), path)
        return
    try:
        text = plots.plot_interactive(result, labels=labels).to_html(include_plotlyjs=True)
    except ParameterError:
        from stylobate.plots.page import Picture, page  # noqa: PLC0415

        text = page(path.stem, [Picture(plots.plot(result, labels=labels), path.stem)], [])
    write_whole(path, text.encode())


def save_figure(figure: "Figure", path: Path) -> None:
    """Write `figure` into the file `path`, whose ending names the format.

    Raises
    ------
    FileError
        If the file cannot be written, or its ending is not a format for figures.
    """
    drawn = BytesIO()
    try:
        figure.savefig(drawn, format=path.suffix.removeprefix(".").lower(), dpi=180)
    except ValueError as error:
        message = f"cannot draw into {path}: {error}"
        raise FileError(message) from None
    write_whole(path, drawn.getvalue())


def _finite(values: Any) -> Any:
    match values:
        case dict():
            return {name: _finite(value) for name, value in values.items()}
        case list() | tuple():
            return [_finite(value) for value in values]
        case float() if not math.isfinite(values):
            return None
    return values


_PLAIN_WIDTH = 120
