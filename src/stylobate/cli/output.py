"""Input and output of commands: saved results; tables and JSON on stdout; figures and data in files."""

import json
import math
import os
import shutil
import sys
import textwrap
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from importlib.util import find_spec
from io import BytesIO
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unicodedata import combining, east_asian_width

from stylobate.errors import FileError, ParameterError, require_positive
from stylobate.files import require_workbooks, write_whole
from stylobate.results.tables import TABLES
from stylobate.text import UNPRINTABLE, printable

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


NETCDF, STORE = ".nc", ".zarr"
"""Endings of files and of stores."""
PAGE = ".html"
FIGURES = (".png", ".pdf", ".svg", PAGE)
"""Endings of figures."""

_PLAIN_WIDTH = 120
# Words of up to so many characters, such as names of records, are not broken while other columns can be folded.
_WHOLE_WORD = 24
# The lines of tables where the terminal or the file has no Unicode.
_ASCII = str.maketrans("┏━┳┓┃┡╇┩┌─┬┐│└┴┘", "+-++|++++-++|+++")


def print_json(values: Any) -> None:
    """Print `values` as JSON; a number that is not finite becomes null."""
    text = json.dumps(_finite(values), indent=2, ensure_ascii=False)
    print(UNPRINTABLE.sub(lambda one: f"\\u{ord(one[0]):04x}", text))


def print_table(title: str, rows: Sequence[Sequence[str]], header: Sequence[str] | None = None) -> None:
    """Print `rows` as a table with the width of the terminal; a table with a header has its title below."""
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else _PLAIN_WIDTH
    cells = [list(map(printable, row)) for row in rows]
    heads = None if header is None else list(map(printable, header))
    lines = [*table_lines(cells, heads, width), *([] if header is None else [printable(title)])]
    unicode = (sys.stdout.encoding or "utf").lower().startswith("utf")
    print("\n".join(lines if unicode else (line.translate(_ASCII) for line in lines)))


def table_lines(rows: Sequence[Sequence[str]], header: Sequence[str] | None, width: int) -> list[str]:
    """Return the lines of a table of at most `width` characters; the widest columns are folded, at blanks first."""
    columns = [*zip(*([] if header is None else [header]), *rows, strict=True)]
    widths = [max(1, *(_width(line) for cell in column for line in cell.split("\n"))) for column in columns]
    words = [max(1, *(_width(word) for cell in column for word in cell.split())) for column in columns]
    words = [min(one, _WHOLE_WORD) for one in words]
    while sum(widths) > max(width - 3 * len(widths) - 1, len(widths)):
        loose = [one if one > word else 0 for one, word in zip(widths, words, strict=True)]
        widest = loose if any(loose) else widths
        widths[widest.index(max(widest))] -= 1

    def rule(left: str, line: str, between: str, right: str) -> str:
        return left + between.join(line * (one + 2) for one in widths) + right

    def folded(cells: Sequence[str], bar: str) -> Iterator[str]:
        for parts in zip_longest(*map(_fold, cells, widths), fillvalue=""):
            padded = (part + " " * (one - _width(part)) for part, one in zip(parts, widths, strict=True))
            yield f"{bar} {f' {bar} '.join(padded)} {bar}"

    top = [rule(*"┌─┬┐")] if header is None else [rule(*"┏━┳┓"), *folded(header, "┃"), rule(*"┡━╇┩")]
    return [*top, *(line for row in rows for line in folded(row, "│")), rule(*"└─┴┘")]


def _fold(cell: str, width: int) -> list[str]:
    return [part for line in cell.split("\n") for part in textwrap.wrap(line, width, break_on_hyphens=False) or [""]]


def _width(text: str) -> int:
    """Count the columns of a text on a terminal, on which the characters of East Asian scripts are wide."""
    return sum(2 if east_asian_width(one) in "WF" else not combining(one) for one in text)


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
        File of the data: netCDF or a table, or a store if `stores` is true.
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
        raise ParameterError(
            f"cannot draw into {figure}: --figure must end with {', '.join(FIGURES[:-1])} or {FIGURES[-1]}"
        )
    if figure is not None and figure.suffix.lower() == PAGE and find_spec("plotly") is None:
        raise ParameterError(
            f"cannot draw into {figure}: interactive figures need Plotly (pip install stylobate[interactive])"
        )
    if output is not None:
        endings = (NETCDF, *((STORE,) if stores else ()), *TABLES)
        if output.suffix not in endings:
            listed = f"{', '.join(endings[:-1])} or {endings[-1]}"
            raise ParameterError(f"--output must end with {listed}, got {str(output)!r}")
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
    from stylobate.plots.animation.animation import checked_path

    check_place(checked_path(path))
    if speed is not None:
        require_positive("speed", speed)


def check_place(path: Path) -> None:
    """Raise FileError if the path is a folder, or its parent folder is missing or not writable.

    Before anything is computed for a workbook, the package that writes it is required.
    """
    if path.suffix.lower() == ".xlsx":
        require_workbooks(path)
    folder = path.parent
    if path.is_dir() or not folder.is_dir() or not os.access(path if path.exists() else folder, os.W_OK):
        reason = "it is a folder" if path.is_dir() else f"{folder} is not a writable folder"
        raise FileError(f"cannot write {path}: {reason}")


def save_plot(result: Any, path: Path, label: str | None = None) -> None:
    """Write the figure of `result`, with its `label`, into `path`: a page if it ends in .html, else a picture.

    A page has the interactive figure of the result, or its picture if there is no interactive one.

    Raises
    ------
    FileError
        If the file cannot be written, or its ending is not a format for figures.
    """
    from stylobate import plots

    labels = None if label is None else [label]
    if path.suffix.lower() != PAGE:
        save_figure(plots.plot(result, labels=labels), path)
        return
    try:
        text = plots.plot_interactive(result, labels=labels).to_html(include_plotlyjs=True)
    except ParameterError:
        from stylobate.plots.page import Picture, page

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
        raise FileError(f"cannot draw into {path}: {error}") from None
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


def open_saved(source: Path | None) -> "xr.Dataset | None":
    """Read the runs saved in a netCDF file (.nc) or a store (.zarr), finished or not; None for any other source.

    Raises
    ------
    FileError
        If the file cannot be read, or holds no runs of a study.
    """
    if source is None or source.suffix not in (NETCDF, STORE):
        return None
    if not source.exists():
        raise FileError(f"cannot read {source}: No such file or directory")
    if source.suffix == STORE:
        from stylobate.studies.sweeps.store import open_sweep

        return relocated(open_sweep(source, load=True), source)
    from stylobate.results.storage import read_dataset

    data = read_dataset(source)
    if "outcome" not in data.data_vars or "provenance" not in data.attrs or "format" in data.attrs:
        raise FileError(f"{source} holds no map or basins saved by stylobate")
    return relocated(data, source)


def open_kind(source: Path | None, name: str, kinds: Collection[str]) -> "xr.Dataset | None":
    """Read saved runs as `open_saved` does; the command of this name shows these `kinds`, or all without kinds.

    Raises
    ------
    FileError
        If the runs are of another kind, as those of a store.
    """
    if kinds and source is not None and source.suffix == STORE:
        raise FileError(
            f"{source} is a store of runs, which cannot be shown. Continue it with its description or options, "
            f"--output {source} and --resume, or save the result as .nc."
        )
    saved = open_saved(source)
    if saved is not None and kinds and saved.attrs["kind"] not in kinds:
        raise FileError(f"{source}: no {name} result (got a {saved.attrs['kind']}).")
    return saved


def relocated(data: "xr.Dataset", source: Path) -> "xr.Dataset":
    """Return `data` with new paths of records that were moved together with the file."""
    from stylobate.config import records

    return data.assign_attrs(provenance=json.dumps(records.relocated(provenance_of(data), source.parent)))


def provenance_of(data: "xr.Dataset") -> dict[str, Any]:
    """Return the provenance of `data`."""
    provenance: dict[str, Any] = json.loads(data.attrs["provenance"])
    return provenance


def axes_of(data: "xr.Dataset") -> dict[str, list[float]]:
    """Return the values along each dimension of the runs in `data`, by name; none for a random sample."""
    names = [str(dim) for dim in data["outcome"].dims]
    return {name: data[name].to_numpy().tolist() for name in names if name in data.coords}


def study_summary(data: "xr.Dataset", **own: Any) -> dict[str, Any]:
    """Describe a study for JSON: kind, axes, `own` values, number of computed runs, provenance."""
    done = {"computed": int(data["computed"]), "runs": data["outcome"].size}
    return {"kind": data.attrs["kind"], **plain_axes(data), **own, **done, "provenance": provenance_of(data)}


def plain_axes(data: "xr.Dataset") -> Mapping[str, Any]:
    """Return name, ends and number of the values along each axis of a grid, for JSON; none of other designs."""
    design = provenance_of(data).get("design", {}).get("kind")
    axes = axes_of(data).items() if design == "grid" else ()
    return {
        place: {"name": name, "from": values[0], "to": values[-1], "number": len(values)}
        for place, (name, values) in zip("xy", axes, strict=False)
        if values
    }
