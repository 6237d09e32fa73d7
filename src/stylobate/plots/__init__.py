"""Figures from results; nothing is computed here."""

from collections.abc import Callable, Sequence

import xarray as xr
from matplotlib.figure import Figure

from stylobate.errors import ParameterError
from stylobate.plots.animation import Animation, animate
from stylobate.plots.assessment import assessment_report, assessment_tables
from stylobate.plots.basins import plot_basins
from stylobate.plots.column_path import plot_column_path
from stylobate.plots.contact_map import plot_contact_map, plot_drift
from stylobate.plots.exact_response import plot_exact_response
from stylobate.plots.exponent import plot_exponent
from stylobate.plots.fates import plot_fates
from stylobate.plots.fractions import plot_fractions
from stylobate.plots.fragility import plot_annual_rate, plot_fragility, plot_reached_bands
from stylobate.plots.incremental import plot_incremental
from stylobate.plots.integrity import plot_erosion, plot_integrity
from stylobate.plots.ladder import plot_ladder, plot_outcome_differences
from stylobate.plots.lyapunov import plot_lyapunov
from stylobate.plots.maps import plot_map
from stylobate.plots.overturning_bands import plot_overturning_bands
from stylobate.plots.paper_report import paper_report
from stylobate.plots.planar_bias import plot_directions, plot_planar_bias
from stylobate.plots.records import plot_records
from stylobate.plots.response import plot_response
from stylobate.plots.robustness import plot_robustness
from stylobate.plots.rocking_spectrum import plot_rocking_spectrum
from stylobate.plots.runs import plot_runs
from stylobate.plots.sections import plot_section
from stylobate.plots.slipping_boundary import plot_slipping_boundary
from stylobate.plots.slow_sweep import plot_slow_sweep
from stylobate.plots.stability_boundary import plot_averaging_map, plot_stability_boundary
from stylobate.plots.start_boundary import plot_start_boundary
from stylobate.results import Assessment, Response

__all__ = [
    "Animation",
    "animate",
    "assessment_report",
    "assessment_tables",
    "paper_report",
    "plot",
    "plot_annual_rate",
    "plot_averaging_map",
    "plot_basins",
    "plot_column_path",
    "plot_contact_map",
    "plot_directions",
    "plot_drift",
    "plot_erosion",
    "plot_exact_response",
    "plot_exponent",
    "plot_fates",
    "plot_fractions",
    "plot_fragility",
    "plot_incremental",
    "plot_integrity",
    "plot_ladder",
    "plot_lyapunov",
    "plot_map",
    "plot_outcome_differences",
    "plot_overturning_bands",
    "plot_planar_bias",
    "plot_reached_bands",
    "plot_records",
    "plot_response",
    "plot_robustness",
    "plot_rocking_spectrum",
    "plot_runs",
    "plot_section",
    "plot_slipping_boundary",
    "plot_slow_sweep",
    "plot_stability_boundary",
    "plot_start_boundary",
]

_BY_KIND: dict[str, Callable[[xr.Dataset], Figure]] = {
    "response curves": plot_response,
    "stability boundary": plot_stability_boundary,
    "averaging map": plot_averaging_map,
    "exact response": plot_exact_response,
    "fates": plot_fates,
    "ensemble": plot_map,
    "sweep": plot_map,
    "overturning map": plot_map,
    "contact map": plot_contact_map,
    "drift": plot_drift,
    "attractors": plot_basins,
    "basins": plot_basins,
    "basin fractions": plot_fractions,
    "uncertainty exponent": plot_exponent,
    "fragility": plot_fragility,
    "annual rate": plot_annual_rate,
    "reached bands": plot_reached_bands,
    "overturning bands": plot_overturning_bands,
    "rocking spectrum": plot_rocking_spectrum,
    "incremental dynamic analysis": plot_incremental,
    "planar bias": plot_planar_bias,
    "robustness": plot_robustness,
    "integrity": plot_integrity,
    "erosion": plot_erosion,
    "ladder": plot_ladder,
    "outcome differences": plot_outcome_differences,
    "slipping boundary": plot_slipping_boundary,
    "start boundary": plot_start_boundary,
    "slow sweep": plot_slow_sweep,
    "Poincaré section": plot_section,
    "Lyapunov exponents": plot_lyapunov,
}


def plot(result: Response | xr.Dataset | Sequence[Response], *, labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of `result`, chosen by its type.

    Parameters
    ----------
    result
        A run, several runs to compare, or the result of a study in `stylobate.studies`: response curves, an
        overturning map, basins, attractors, basin fractions, an uncertainty exponent, integrity or its erosion, a
        slow sweep, a Poincaré section, Lyapunov exponents, the ladder of models, differences of outcomes, a
        contact map, a drift, the boundaries of slip and of the start of motion, a fragility, annual rates, reached
        bands, overturning bands, a rocking spectrum, an incremental dynamic analysis, a planar bias, a robustness.
        A sweep over two dimensions is drawn as a map, finished or not.
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
    if isinstance(result, xr.Dataset) and result.attrs.get("kind") in _BY_KIND:
        return _BY_KIND[result.attrs["kind"]](result)
    if isinstance(result, Sequence) and result and all(isinstance(run, Response) for run in result):
        return plot_runs(result, labels)
    if isinstance(result, Assessment):
        message = "result must be one figure's, got an Assessment: write its report by plots.assessment_report"
        raise ParameterError(message)
    message = f"result must be a run, a sequence of runs or the result of a study, got {type(result).__name__}"
    raise ParameterError(message)
