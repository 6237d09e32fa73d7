"""Figures from results; nothing is computed here."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

from stylobate.errors import ParameterError
from stylobate.plots.paper_report import paper_report
from stylobate.plots.response import plot_response
from stylobate.plots.runs import plot_runs
from stylobate.results import Response

__all__ = ["paper_report", "plot", "plot_response", "plot_runs"]


def plot(result: Response | xr.Dataset | Sequence[Response], *, labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of `result`, chosen by its type.

    Parameters
    ----------
    result
        A run, several runs to compare, or the response curves of `stylobate.studies.response_curves`.
    labels
        Names for several runs; by default their outcomes.

    Returns
    -------
    matplotlib.figure.Figure
        A figure of its own, drawn without pyplot; show it in a notebook or save it with `savefig`.

    Raises
    ------
    ParameterError
        If there is no picture for such a result.
    """
    if isinstance(result, Response):
        return plot_runs([result], labels)
    if isinstance(result, xr.Dataset) and result.attrs.get("kind") == "response curves":
        return plot_response(result)
    if isinstance(result, Sequence) and result and all(isinstance(run, Response) for run in result):
        return plot_runs(result, labels)
    message = f"result must be a run, a sequence of runs or response curves, got {type(result).__name__}"
    raise ParameterError(message)
