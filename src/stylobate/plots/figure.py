"""`plot`: draw any result as the figure of its kind."""

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.base_motions import BaseMotion
from stylobate.column import Column
from stylobate.errors import ParameterError
from stylobate.models import Model
from stylobate.plots.base_motion import plot_motion
from stylobate.plots.column_figures import plot_column
from stylobate.plots.kinds import HasPoints, check_sequence, figure_for
from stylobate.plots.orbits import DrawnOrbit, plot_bifurcation_curves, plot_branches, plot_orbit
from stylobate.plots.result_figure import drawing
from stylobate.plots.runs import plot_runs
from stylobate.results import Assessment, Run, Verdict
from stylobate.text import plural

# Functions that draw several results of a kind in one figure.
_COMPARED = {"branch": plot_branches, "bifurcation curve": plot_bifurcation_curves}


_OBJECTS: tuple[tuple[type, Callable[[Any], Figure]], ...] = (
    (Column, plot_column),
    (Model, lambda model: plot_column(model.column)),
    (BaseMotion, plot_motion),
    (DrawnOrbit, plot_orbit),
)

Plotted: TypeAlias = Column | Model | BaseMotion | Run | Verdict | xr.Dataset | HasPoints | DrawnOrbit


def plot(
    result: Plotted | Sequence[Run] | Sequence[HasPoints],
    *,
    labels: Sequence[str] | None = None,
    size: float | tuple[float, float] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """Draw a result as the figure of its kind.

    Parameters
    ----------
    result
        A column (or a model, for its column), a base motion, a record, a run or several runs to compare, a verdict, a
        periodic orbit, one or several branches of orbits or curves of bifurcations, or the Dataset of an ensemble or a
        study. Runs over one dimension are drawn as points, over two as a map, finished or not.
    labels
        A name for each run, branch or curve; by default what varies between the runs, or the kinds of the curves.
    size
        Width of the figure, or width and height [inches]; by default 7.2 inches with a height that suits the content.
        A figure of 3.5 inches, a column of a journal, has its panels and legends below each other.
    axes
        Axes to draw in, for results of one panel; of a run the tilt is drawn.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, drawn without pyplot: a notebook displays it, `show` opens a window, `savefig` saves it. It follows
        Matplotlib's settings (`rcParams`, styles), also dark ones. With `axes`, their figure.

    Raises
    ------
    ParameterError
        If no figure is registered for results of this kind (see `stylobate.plots.figure_of`), axes are given for a
        figure of several panels, the height cannot hold the tilt of a run, or there is not one label for each result.
    """
    if labels is not None:
        _check_labels(result, labels)
    with drawing(size, axes):
        return _drawn(result, labels)


def _check_labels(result: Any, labels: Sequence[str]) -> None:
    results = result if isinstance(result, Sequence) else [result]
    if not all(isinstance(one, Run | HasPoints) for one in results):
        raise ParameterError(f"labels name runs, branches or curves (got {type(result).__name__}). Leave labels out")
    if isinstance(labels, str) or len(labels) != len(results):
        got = repr(labels) if isinstance(labels, str) else len(labels)
        raise ParameterError(
            f"labels must have one name for each of {plural(len(results), 'result')}, got {got}. Pass a list of them"
        )


def _drawn(result: Any, labels: Sequence[str] | None) -> Figure:
    for kind, draw_one in _OBJECTS:
        if isinstance(result, kind):
            return draw_one(result)
    if isinstance(result, Verdict):
        result = result.data
    results: Sequence[object] = [result]
    if isinstance(result, Sequence) and not isinstance(result, str):
        check_sequence(result)
        results = result
    runs = [one for one in results if isinstance(one, Run)]
    if results and len(runs) == len(results):
        return plot_runs(runs, labels)
    tables = [one.points for one in results if isinstance(one, HasPoints)]
    if results and len(tables) == len(results):
        kinds = {str(table.attrs.get("kind")) for table in tables}
        if len(kinds) == 1 and (draw_all := _COMPARED.get(kinds.pop())) is not None:
            return draw_all(tables, labels)
    if isinstance(result, xr.Dataset) and (draw := figure_for(str(result.attrs.get("kind")))) is not None:
        return draw(result)
    if isinstance(result, Assessment):
        raise ParameterError(
            "result must have one figure, got an Assessment. Write its report by earthquakes.assessment_report"
        )
    table = result.attrs.get("kind") if isinstance(result, xr.Dataset) else None
    got = f"a Dataset of kind {table!r}, which has no figure" if table else type(result).__name__
    raise ParameterError(
        "result must be a column, a base motion, a run, an orbit, a branch, a curve, a sequence of runs, branches or "
        f"curves, or the result of a study, got {got}"
    )
