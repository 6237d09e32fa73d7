"""`plot`: draw any result as the figure of its kind."""

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

import xarray as xr
from matplotlib.figure import Figure

from stylobate.errors import ParameterError
from stylobate.plots.bifurcation_curves import plot_bifurcation_curves
from stylobate.plots.branches import plot_branches
from stylobate.plots.kinds import figure_for
from stylobate.plots.runs import plot_runs
from stylobate.results import Assessment, Response, Verdict

# Functions that draw several results of a kind in one figure.
_COMPARED = {"branch": plot_branches, "bifurcation curve": plot_bifurcation_curves}


@runtime_checkable
class HasPoints(Protocol):
    """A branch of orbits or a curve of bifurcations: its `points` are a Dataset."""

    @property
    def points(self) -> xr.Dataset:
        """Its points as data."""


def plot(
    result: Response | Verdict | xr.Dataset | HasPoints | Sequence[Response] | Sequence[HasPoints],
    *,
    labels: Sequence[str] | None = None,
) -> Figure:
    """Draw a result as the figure of its kind.

    Parameters
    ----------
    result
        A run, several runs to compare, a verdict, the Dataset of a study, or one or several branches of orbits or
        curves of bifurcations. A sweep over two dimensions is drawn as a map, finished or not.
    labels
        A name for each of several runs, branches or curves; by default the outcomes of runs and the kinds of curves.

    Returns
    -------
    matplotlib.figure.Figure
        A figure of its own, drawn without pyplot; show it in a notebook or save it with `savefig`.

    Raises
    ------
    ParameterError
        If no figure is registered for results of this kind; see `stylobate.plots.figure_of`.
    """
    if isinstance(result, Verdict):
        result = result.data
    results: Sequence[object] = result if isinstance(result, Sequence) else [result]
    runs = [one for one in results if isinstance(one, Response)]
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
        message = "result must have one figure, got an Assessment. Write its report by earthquakes.assessment_report"
        raise ParameterError(message)
    message = (
        f"result must be a run, a branch, a curve, a sequence of one of these or the result of a study, "
        f"got {type(result).__name__}"
    )
    raise ParameterError(message)
