"""Basins of attraction: the attractor of each initial condition, on a grid or from a random sample."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Unpack

import numpy.typing as npt

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.config.options import MODEL_WITHOUT_SLIDING
from stylobate.config.study import Classes, Study
from stylobate.errors import MOST_RUNS, FileError, ParameterError, require_whole
from stylobate.models import Model
from stylobate.results.random_numbers import Rng
from stylobate.results.tables import ResultTable, number_of_runs
from stylobate.run_arguments import Stroboscopic
from stylobate.studies.study import StudyArguments, described, study

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.orbits import PeriodicOrbit
    from stylobate.studies.maps.attractor_search import AttractorRules
    from stylobate.studies.sweeps import Sweep
    from stylobate.studies.sweeps.running import Label

_PLANE = 2


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    return {
        "attractors": [_attractor(result.isel(attractor_index=i)) for i in range(result.sizes["attractor_index"])],
        "unsettled": int(result["unsettled"]),
        "confidence": float(result.attrs["confidence"]),
    }


def _attractor(one: "xr.Dataset") -> dict[str, Any]:
    numbers = ("mean_tilt", "peak_tilt", "turns")
    period = int(one["attractor_period"])
    points = {"orbit_point": slice(0, max(period, 1))}
    return {
        "name": str(one["attractor_name"].item()),
        "kind": str(one["attractor_kind"].item()),
        "period": period,
        **{name: float(one[f"attractor_{name}"]) for name in numbers},
        **{name: one[f"attractor_{name}"].isel(points).to_numpy().tolist() for name in ("tilt", "tilt_rate")},
        "count": int(one["count"]),
        **{name: float(one[name]) for name in ("fraction", "fraction_low", "fraction_high")},
    }


def _table(result: "xr.Dataset") -> ResultTable:
    from stylobate.studies.maps.attractor_search import REMEDY

    rows = [
        (
            one["name"],
            f"{one['turns']:.4g}" if one["mean_tilt"] > 0.0 else "",
            f"{one['mean_tilt']:.5g} rad" if one["mean_tilt"] > 0.0 else "",
            str(one["count"]),
            f"{100.0 * one['fraction']:.2f} %",
            f"{100.0 * one['fraction_low']:.2f} to {100.0 * one['fraction_high']:.2f} %",
        )
        for one in _summary(result)["attractors"]
    ]
    confidence = f"{100.0 * float(result.attrs['confidence']):g} % interval"
    header = ("attractor", "turns per period", "mean tilt", "runs", "fraction", confidence)
    remarks = [REMEDY] if int(result["unsettled"]) else []
    return ResultTable(number_of_runs(result, word="initial condition"), header, rows, remarks)


def _completed(saved: "xr.Dataset", setup: Callable[[], Any], options: Mapping[str, Any]) -> "xr.Dataset":
    """Return saved basins with intervals of the confidence level; add to the runs of a store the attractor of each."""
    from stylobate.studies.maps.attractor_search import NOT_SETTLED
    from stylobate.studies.maps.attractors import label_attractors
    from stylobate.studies.proportions import fraction_interval

    confidence = options.get("confidence")
    if "attractor_name" not in saved:
        if "strobe_tilt" not in saved:
            raise FileError("runs without stroboscopic samples have no attractors. Show them with stylobate map.")
        made = setup()
        labels = label_attractors(saved, made.model, made.motion, confidence=0.95 if confidence is None else confidence)
        return labels.assign_attrs(kind="basins")
    if confidence is None:
        return saved
    unknown = saved["unsettled"].where(saved["attractor_kind"] != NOT_SETTLED, 0)
    low, high = fraction_interval(saved["count"], unknown, saved["computed"], confidence=confidence)
    ends = {"fraction_low": ("attractor_index", low), "fraction_high": ("attractor_index", high)}
    return saved.assign(ends).assign_attrs(confidence=confidence)


@study(
    "basins",
    Study(
        name="basin",
        source="TOML description, or saved basins (.nc) or their store (.zarr) to show or repeat",
        help="""Compute basins of attraction over initial conditions, and their fractions.

    The initial conditions are a grid of two of tilt-x, tilt-y, tilt-rate-x, tilt-rate-y and start-phase, or a random
    sample. Saved basins are shown; options that change them compute them again. Examples:

    stylobate basin --slenderness 0.1 --damping 0.1 --motion circular --acceleration 0.02 --angular-frequency 1.2
    --x tilt-x -0.08 0.08 200 --y tilt-y -0.08 0.08 200 --periods 100 --figure basin.png

    stylobate basin basin.toml --random 10000 --seed 1 --over tilt-x -0.08 0.08 --over tilt-rate-x -0.1 0.1
    """,
        axes=("x", "y"),
        starts=True,
        early=True,
        numbers=Stroboscopic,
        model=MODEL_WITHOUT_SLIDING,
        classes=(Classes("attractor", "attractor_name", "fraction"),),
        completed=_completed,
        repeated=lambda provenance, values: {**values, "strobes": provenance.get("strobes") or None},
        table=_table,
        summary=_summary,
    ),
)
def basins(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, npt.ArrayLike],
    count: int | None = None,
    rng: Rng = 0,
    attractor_rules: "AttractorRules | None" = None,
    confidence: float = 0.95,
    orbits: "Sequence[PeriodicOrbit]" = (),
    **run: Unpack[StudyArguments],
) -> "tuple[Sweep, Label]":
    """Compute basins of attraction, on a grid of two initial conditions or from a random sample.

    Parameters
    ----------
    model, motion
        The column and its base motion, the same for all runs.
    over
        Initial conditions that vary: tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y [rad/s], start_phase [rad].
        Without `count`, two names with their values make a grid. With `count`, any number of names with their ranges
        (low, high).
    count, rng
        Number of random initial conditions, drawn uniformly in the ranges; seed or numpy.random.Generator.
    attractor_rules
        Tolerances by which attractors are identified.
    confidence
        Confidence level of the intervals of the fractions.
    orbits
        Stable periodic orbits of one period of the base motion, from `stylobate.orbits.periodic_orbit`. Runs that
        converge to one of them end early; see "End converged runs early" on the page on ensembles.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "basins", as `label_attractors` describes it: the runs with their `attractor`, and the table of
        attractors with the fraction of runs that reach each.

    Raises
    ------
    ParameterError
        If an argument is out of range, a name in `over` is not an initial condition, a grid does not have two names
        with at least one value each, or runs are too short for the stroboscopic samples.

    Notes
    -----
    Without `strobes`, runs keep 32 stroboscopic samples, or half of the periods of a shorter run. With
    `end_converged=True`, steady rolling in closed form under circular base motion also counts as a known orbit.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> found = sb.studies.basins(model, over={"tilt_x": [-0.06, 0.06, 0.12], "tilt_y": [0.0, 0.03]}, duration=200.0)
    >>> found["attractor_name"].values.tolist(), found["count"].values.tolist()
    (['at rest', 'overturned'], [4, 2])
    """
    from stylobate.studies.checks import require_starts, require_values
    from stylobate.studies.known_rolling import known_orbit_of
    from stylobate.studies.maps.attractor_search import with_strobes
    from stylobate.studies.sweeps import Sweep

    require_starts("over", over)
    if orbits:
        run["known_orbits"] = [known_orbit_of(orbit, model, motion or BASE_AT_REST) for orbit in orbits]
    if count is not None:
        ranges: Mapping[str, Sequence[float]] = over  # type: ignore[assignment]  # the sweep refuses invalid ranges
        count = require_whole("count", count, least=1, most=MOST_RUNS)
        sweep = Sweep.random(model, motion, over=ranges, count=count, rng=rng, **described(run))
    elif len(over) == _PLANE:
        require_values("over", over)
        sweep = Sweep.grid(model, motion, over=over, **described(run))
    else:
        raise ParameterError(
            f"over must name two starts with their values, or give count for random ones; got {', '.join(over)}"
        )
    label = partial(_basins_of, model=model, motion=motion, rules=attractor_rules, confidence=confidence)
    return with_strobes(sweep, run["strobes"] or None), label


def _basins_of(
    runs: "xr.Dataset", model: Model, motion: BaseMotion | None, rules: "AttractorRules | None", confidence: float
) -> "xr.Dataset":
    from stylobate.studies.maps.attractors import label_attractors

    labelled = label_attractors(runs, model, motion, rules=rules, confidence=confidence)
    return labelled.assign_attrs(kind="basins")
