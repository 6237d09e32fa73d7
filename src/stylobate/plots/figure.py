"""The one function that draws any result."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

from stylobate.errors import ParameterError
from stylobate.plots.kinds import figure_for
from stylobate.plots.runs import plot_runs
from stylobate.results import Assessment, Response


def plot(result: Response | xr.Dataset | Sequence[Response], *, labels: Sequence[str] | None = None) -> Figure:
    """Draw a result as the figure of its kind.

    Parameters
    ----------
    result
        A run, several runs to compare, or the Dataset of a study. A sweep over two dimensions is drawn as a map,
        finished or not.
    labels
        Names for several runs; by default their outcomes.

    Returns
    -------
    matplotlib.figure.Figure
        A figure of its own, drawn without pyplot; show it in a notebook or save it with `savefig`.

    Raises
    ------
    ParameterError
        If no figure is registered for results of this kind; see `stylobate.plots.figure_of`.
    """
    if isinstance(result, Response):
        return plot_runs([result], labels)
    if isinstance(result, xr.Dataset) and (draw := figure_for(str(result.attrs.get("kind")))) is not None:
        return draw(result)
    if isinstance(result, Sequence) and result and all(isinstance(run, Response) for run in result):
        return plot_runs(result, labels)
    if isinstance(result, Assessment):
        message = "result must be one figure's, got an Assessment: write its report by earthquakes.assessment_report"
        raise ParameterError(message)
    message = f"result must be a run, a sequence of runs or the result of a study, got {type(result).__name__}"
    raise ParameterError(message)
