"""The study of an inventory: many objects under the records of their sites, ranked."""

import json
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.config.parts import ANY_COLUMN
from stylobate.earthquakes.assessment.inputs import identities
from stylobate.earthquakes.config.verdict import described_spread
from stylobate.earthquakes.fragility import HazardCurve
from stylobate.earthquakes.intensities import Intensity, IntensityMeasure
from stylobate.earthquakes.inventories.objects import (
    OF_RUNS,
    InventoryObject,
    InventorySite,
    PreparedObject,
    require_model,
)
from stylobate.earthquakes.inventories.ranking import Evaluation, limit_state_names, ranked
from stylobate.earthquakes.inventories.runs import SiteRuns
from stylobate.earthquakes.study_inputs import Records, named_records
from stylobate.errors import (
    LARGEST_SEED,
    MOST_RUNS,
    ConfigError,
    Interrupted,
    ParameterError,
    UnlikelyInputWarning,
    require_not_negative,
    require_positive,
    require_whole,
)
from stylobate.parameter_quantities import attributes_of
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.quantities import cf_attributes, exact_repr
from stylobate.records.intensities import HorizontalComponent
from stylobate.run_arguments import Accuracy
from stylobate.studies.checks import require_no_limits
from stylobate.studies.proportions import require_confidence
from stylobate.studies.sweeps import Executor
from stylobate.text import did_you_mean, plural

_FEWEST_SCALES = 2


@shows_progress("runs")
def inventory(
    objects: Sequence[InventoryObject],
    sites: Records | InventorySite | Mapping[str, InventorySite],
    *,
    model: str = "wobbling",
    samples: int = 20,
    scales: npt.ArrayLike = (1.0,),
    limit_state: str = "overturning",
    tail: float | None = None,
    seed: int = 0,
    confidence: float = 0.95,
    resamples: int = 1000,
    store: str | Path | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
    **options: Unpack[Accuracy],
) -> xr.Dataset:
    """Rank many objects by how probably the records of their sites overturn them.

    Each object has a run under each record of its site, at each scale, for each sample of its uncertain numbers. Each
    record has samples of its own, so that the interval over records covers the sampling too.

    Parameters
    ----------
    objects
        The objects, such as from `read_inventory`; their names must differ.
    sites
        The records, a site, or sites by name.
    model
        Kind of the model of all objects, three-dimensional and with permanent contact.
    samples
        Number of samples of the uncertain numbers for each record; 1 is used for an object without uncertain numbers.
    scales
        Factors of the records. A hazard curve needs several.
    limit_state
        Limit state of the ranking: "overturning", or "tilt 0.5 α" and its like.
    tail
        Free-vibration time after a record [s]; by default 20/p of each sample.
    seed
        Seed of the samples and resamples.
    confidence
        Confidence level of the intervals.
    resamples
        Number of bootstrap samples of the records for the intervals of annual rates.
    store
        A folder that keeps the runs of each object: with it an interrupted study resumes, and a changed table computes
        the changed objects only.
    executor
        As in `run_sweep`.
    progress
        A function that is called with the numbers of runs done and of all runs; a bar by default, False for none.
    **options
        Options of all runs, as in `simulate_ensemble`, such as `rtol`.

    Returns
    -------
    xarray.Dataset
        Of kind "inventory". Over `object`, in the order of the ranking:

        * `rank`, 0 if withheld; `site`; the nominal numbers of column and model; `friction_coefficient`; `runs`.
        * Over `limit_state` and `scale`: `probability`, the mean over records of the share of samples that reach the
          limit state; `probability_low` and `probability_high`, its interval over records; `probability_least` and
          `probability_most`, its bounds if the runs that are not known reach it or not. It is NaN if these bounds
          differ by more than 0.05.
        * Over `scale`: `tilt_median` and `tilt_84`, quantiles of the peak tilt over α_c, infinite if overturned;
          `friction_demand_median` and `friction_demand_84`; `slip_share`, the share of runs that need more than the
          friction coefficient; `sliding_share`, the share of runs that slide before they rock, and `undecided_share`,
          both not known.
        * With hazard curves, over `limit_state`: `annual_rate`, its interval `rate_low` and `rate_high` and bounds
          `rate_least` and `rate_most`, as from `empirical_rate`. If all sites have one, it is the rank's number.
        * `carried` over `column`, further cells of the table; `geometry` in hexadecimal digits.

    Raises
    ------
    ConfigError
        With one line for each object that is invalid; nothing is computed then.
    ParameterError
        If an argument is out of range.
    Interrupted
        On Ctrl-C; the objects that were computed are in the store.

    Notes
    -----
    The objects are computed in the order of their names, and the order of the table changes no number. All runs start
    upright at rest. The contact neither slips nor opens: `slip_share` states for how many runs this does not hold.

    Examples
    --------
    >>> import stylobate as sb
    >>> vases = [
    ...     sb.earthquakes.InventoryObject(
    ...         name=f"vase {height:g} m",
    ...         column={"radius": 0.05, "height": height, "density": 2200.0},
    ...         model={"damping": 0.05},
    ...         friction_coefficient=0.5,
    ...         spreads={"radius": sb.earthquakes.LognormalSpread(0.05)},
    ...     )
    ...     for height in (0.3, 0.6)
    ... ]
    >>> found = sb.earthquakes.inventory(vases, sb.sample_record(), samples=10)
    >>> found["object"].values.tolist(), found["probability"].sel(limit_state="overturning").values.ravel().tolist()
    (['vase 0.6 m', 'vase 0.3 m'], [1.0, 0.1])
    """
    require_no_limits(options)
    factors = _factors(scales)
    require_model(model)
    states = limit_state_names()
    if limit_state not in states:
        remedy = did_you_mean(limit_state, states) or f"Use one of {', '.join(states)}."
        raise ParameterError(f"limit_state: unknown (got {limit_state!r}); {remedy}")
    count = require_whole("samples", samples, least=1, most=MOST_RUNS)
    start = require_whole("seed", seed, least=0, most=LARGEST_SEED)
    places = _sites(sites)
    for name, site in places.items():
        if site.hazard is not None and len(factors) < _FEWEST_SCALES:
            raise ParameterError(
                f"scales: a hazard curve needs two or more (got {factors[0]:g}, and one of the site {name!r}). "
                "Pass some from small to large, such as numpy.geomspace(0.25, 4, 9)."
            )
    of_sites = {
        name: SiteRuns(
            records=dict(sorted(named_records(site.records).items())),
            scales=factors,
            samples=count,
            seed=start,
            tail=None if tail is None else require_not_negative("tail", tail, "s"),
            options=options,
        )
        for name, site in places.items()
    }
    prepared = _prepared(objects, of_sites, model)
    evaluation = Evaluation(
        scales=factors,
        confidence=require_confidence(confidence),
        resamples=require_whole("resamples", resamples, least=0),
        seed=start,
    )
    numbers: dict[str, dict[str, Any]] = {}
    total = sum(of_sites[one.site].runs_of(one) for one in prepared.values())
    report, done = report_of(progress), [0]
    folder = None if store is None else Path(store)
    try:
        for name, runs in of_sites.items():
            own = [one for _, one in sorted(prepared.items()) if one.site == name]
            hazard = places[name].hazard
            intensity = None if hazard is None else _intensity(hazard, runs)
            parts = runs.parts(own, folder, executor, lambda part, _: report(sum(done) + part, total))
            for one, part in parts if own else ():
                numbers[one.name] = evaluation.numbers(one, part, hazard, intensity)
                done.append(runs.runs_of(one))
                report(sum(done), total)
    except KeyboardInterrupt:
        remedy = "pass store= to keep them" if store is None else f"the same call with store={str(store)!r} continues"
        computed = f"{len(numbers)} of {plural(len(prepared), 'object')}"
        raise Interrupted(f"stopped after {computed}; {remedy}", None) from None
    found = ranked(prepared, numbers, states, factors, limit_state)
    found = found.assign(_inputs(prepared, found["object"].to_numpy().tolist()))
    setting = {
        "samples": count,
        "seed": start,
        "scales": list(factors),
        "tail": tail,
        "confidence": confidence,
        "resamples": resamples,
        "limit_state": limit_state,
        "model": model,
        "options": {name: repr(value) for name, value in options.items() if value is not None},
    }
    return found.assign_attrs(
        confidence=evaluation.confidence,
        model=model,
        provenance=json.dumps(_provenance(prepared, places, of_sites, setting)),
    )


def _factors(scales: npt.ArrayLike) -> tuple[float, ...]:
    """Return the factors of the records, sorted."""
    try:
        values = np.atleast_1d(np.array(scales, dtype=float)).ravel().tolist()
    except (TypeError, ValueError):
        values = []
    if not values:
        raise ParameterError(f"scales: must be positive numbers, one or more (got {scales!r}). Pass such as [1.0].")
    return tuple(sorted({require_positive("scales", value) for value in values}))


def _sites(sites: Records | InventorySite | Mapping[str, InventorySite]) -> dict[str, InventorySite]:
    if isinstance(sites, Mapping) and any(isinstance(one, InventorySite) for one in sites.values()):
        for name, one in sites.items():
            if not isinstance(one, InventorySite):
                raise ParameterError(
                    f"sites: {name!r} is no InventorySite (got {one!r}). Pass InventorySite(records=…)."
                )
        return {name: one for name, one in sorted(sites.items()) if isinstance(one, InventorySite)}
    return {"": sites if isinstance(sites, InventorySite) else InventorySite(records=sites)}  # type: ignore[arg-type]


def _prepared(
    objects: Sequence[InventoryObject], sites: Mapping[str, SiteRuns], kind: str
) -> dict[str, PreparedObject]:
    """Prepare the objects by name; raise ConfigError with a line for each that is invalid."""
    if isinstance(objects, (str, bytes)) or not isinstance(objects, Sequence) or not objects:
        raise ParameterError(f"objects: must be InventoryObjects, one or more (got {objects!r}). Use read_inventory.")
    found: dict[str, PreparedObject] = {}
    problems: list[str] = []
    for one in objects:
        if not isinstance(one, InventoryObject):
            raise ParameterError(f"objects: must be InventoryObjects (got {one!r}). Use read_inventory.")
        name = _site_of(one, sites, problems)
        if one.name in found:
            problems.append(f"{one.place}: the name {one.name!r} is that of {found[one.name].given.place}. Rename one.")
            continue
        try:
            with _questions_of(one):
                prepared = replace(one.prepared(kind), site=name)
            if name in sites:
                site = sites[name]
                prepared.check_samples(len(site.records) * site.samples_of(prepared), site.seed)
            found[one.name] = prepared
        except ConfigError as error:
            problems += error.problems
    if problems:
        raise ConfigError(problems)
    return found


def _site_of(one: InventoryObject, sites: Mapping[str, SiteRuns], problems: list[str]) -> str:
    """Return the name of the site of an object: the one site, if it has no name or the object states none."""
    if one.site not in sites:
        if len(sites) == 1 and (not one.site or "" in sites):
            return next(iter(sites))
        remedy = did_you_mean(one.site, sites) or f"Use {', '.join(sites)}."
        problems.append(f"{one.place}: site: unknown (got {one.site!r}); {remedy}")
    return one.site


@contextmanager
def _questions_of(one: InventoryObject) -> Iterator[None]:
    """Name the row of an object in warnings about its numbers."""
    with warnings.catch_warnings(record=True) as questions:
        warnings.simplefilter("always", UnlikelyInputWarning)
        yield
    for message in dict.fromkeys(str(question.message) for question in questions):
        warnings.warn(f"{one.place}: {message}", UnlikelyInputWarning, stacklevel=2)


def _intensity(hazard: HazardCurve, site: SiteRuns) -> xr.DataArray:
    """Return the intensity of the hazard curve over record and scale."""
    component = hazard.component or HorizontalComponent.ROTD50
    measure = IntensityMeasure.named(hazard.quantity, component)
    if measure.quantity in (Intensity.ACCELERATION_RATIO, Intensity.VELOCITY_RATIO):
        raise ParameterError(
            f"hazard: its intensity must not depend on the column (got {hazard.quantity!r}). Use one such as PGA."
        )
    each = np.array([measure.of(motion, ANY_COLUMN) for motion in site.records.values()])
    return xr.DataArray(np.multiply.outer(each, site.scales), dims=("record", "scale"), attrs=measure.attributes)


def _inputs(objects: Mapping[str, PreparedObject], order: Sequence[str]) -> dict[str, Any]:
    """Return the nominal numbers of the objects, and the cells that the table carries, as variables over `object`."""
    chosen = [objects[name] for name in order]
    data: dict[str, Any] = {
        name: ("object", [float(getattr(one.model.column, name)) for one in chosen], attributes_of(name))
        for name in (*OF_RUNS, "slenderness")
    }
    of_model = dict.fromkeys(name for one in chosen for name in one.of_model)
    data |= {
        name: ("object", [float(getattr(one.model, name)) for one in chosen], attributes_of(name)) for name in of_model
    }
    data["friction_coefficient"] = (
        "object",
        [one.friction for one in chosen],
        cf_attributes("1", "friction coefficient of the contact"),
    )
    carried = list(dict.fromkeys(name for one in chosen for name in one.given.carried))
    if carried:
        cells = [[one.given.carried.get(name, "") for name in carried] for one in chosen]
        data["carried"] = (("object", "column"), np.array(cells, dtype=object), {"long_name": "cells of the table"})
        data["column"] = ("column", carried)
    if any(one.given.geometry for one in chosen):
        text = {"long_name": "well-known binary in hexadecimal digits", "crs": chosen[0].given.crs}
        data["geometry"] = ("object", [one.given.geometry.hex() for one in chosen], text)
    return data


def _provenance(
    objects: Mapping[str, PreparedObject],
    places: Mapping[str, InventorySite],
    sites: Mapping[str, SiteRuns],
    setting: Mapping[str, Any],
) -> dict[str, Any]:
    """Return the inputs of the study as plain values."""
    first = next(iter(objects.values())).model
    return {
        "version": version("stylobate"),
        "inventory": dict(setting),
        "sites": {
            name: {
                "records": {
                    one: {
                        "digest": identity,
                        "motion": provenance_of_run(first, site.records[one])["motion"],
                    }
                    for one, identity in identities(site.records).items()
                },
                "hazard": exact_repr(places[name].hazard),
            }
            for name, site in sites.items()
        },
        "objects": {
            name: {
                "column": dict(one.numbers),
                "shape": one.shape,
                "estimated": one.estimated,
                "model": {"kind": one.model.name, **{number: getattr(one.model, number) for number in one.of_model}},
                "friction_coefficient": one.friction,
                "site": one.site,
                "spreads": {number: described_spread(spread) for number, spread in one.spreads.items()},
            }
            for name, one in sorted(objects.items())
        },
    }
