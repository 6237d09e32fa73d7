"""Ranking of an inventory: probabilities with intervals over records, peak tilts, friction and annual rates.

With the share s_r of the samples of record r that reach a limit state, the probability is the mean of s_r over the
records; its interval is `clustered_interval`. A run is not known if it is undecided, or if the column slides before it
rocks: its friction coefficient is below r/h, and the run needs more friction. A lower bound counts such runs as not
reached, an upper bound as reached.
"""

import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import xarray as xr

from stylobate.earthquakes.fragility import HazardCurve, empirical_rate
from stylobate.earthquakes.fragility.observations import LIMIT_STATE, NOT_KNOWN, limit_states
from stylobate.earthquakes.incremental import tilt_ratios
from stylobate.earthquakes.inventories.objects import PreparedObject
from stylobate.earthquakes.inventories.runs import KEPT
from stylobate.quantities import cf_attributes
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.studies.proportions import clustered_interval
from stylobate.studies.sweeps.designs import Floats

MATTERS = 0.05
"""A probability is withheld if runs that are not known change it by more than this."""

_QUANTILES = {"median": 0.5, "84": 0.84}


@dataclass(frozen=True, slots=True, kw_only=True)
class Evaluation:
    """How the runs of an object are evaluated.

    Parameters
    ----------
    scales
        Factors of the records.
    confidence
        Confidence level of intervals.
    resamples
        Number of bootstrap samples of the records for intervals of annual rates.
    seed
        Seed of the resamples.
    """

    scales: tuple[float, ...]
    confidence: float
    resamples: int
    seed: int

    def numbers(
        self, one: PreparedObject, part: xr.Dataset, hazard: HazardCurve | None, intensity: xr.DataArray | None
    ) -> dict[str, Any]:
        """Compute the numbers of an object from its runs.

        Parameters
        ----------
        one
            The object.
        part
            Its runs, as from `SiteRuns.parts`.
        hazard, intensity
            Hazard curve of its site, and the intensity over record and scale; None without a hazard.

        Returns
        -------
        dict
            Values by the names of the variables of the ranking: over scale, limit state or both.
        """
        # A run without slip holds until friction is exceeded: below r/h, the column then slides and does not rock.
        slides = (one.friction < part["slenderness"]) & (part["peak_friction_demand"] > one.friction)
        reached = limit_states(part, slenderness=part["slenderness"]).where(~slides, np.int8(NOT_KNOWN))
        reached = reached.transpose(LIMIT_STATE, "scale", "record", "property_sample")
        codes = reached.to_numpy()
        least, most = (codes == 1).mean(axis=-1), (codes != 0).mean(axis=-1)  # shares of each record
        low, _ = clustered_interval(least, confidence=self.confidence)
        _, high = clustered_interval(most, confidence=self.confidence)
        bounds = least.mean(axis=-1), most.mean(axis=-1)
        known = bounds[1] - bounds[0] <= MATTERS
        sliding = slides.mean(("record", "property_sample")).to_numpy()
        demand = part["peak_friction_demand"].transpose("scale", ...).to_numpy()
        demand = demand.reshape(len(self.scales), -1)
        found = {
            "probability": np.where(known, 0.5 * (bounds[0] + bounds[1]), np.nan),
            "probability_low": low,
            "probability_high": high,
            "probability_least": bounds[0],
            "probability_most": bounds[1],
            **{f"tilt_{name}": values for name, values in _tilt_quantiles(part, slides).items()},
            **{f"friction_demand_{name}": _quantile(demand, share) for name, share in _QUANTILES.items()},
            "slip_share": (demand > one.friction).mean(axis=-1),
            "sliding_share": sliding,
            "undecided_share": (codes[-1] == NOT_KNOWN).mean(axis=(-2, -1)) - sliding,
            "runs": int(part["outcome"].size),
        }
        if hazard is None or intensity is None:
            return found
        return found | self._rates(one, reached, hazard, intensity)

    def _rates(
        self, one: PreparedObject, reached: xr.DataArray, hazard: HazardCurve, intensity: xr.DataArray
    ) -> dict[str, Floats]:
        """Count annual rates; runs that are not known count as not reached below, and as reached above."""

        def counted(states: xr.DataArray) -> xr.Dataset:
            # The same resamples for each object and bound, whatever the other objects are.
            key = (self.seed, zlib.crc32(one.name.encode()))
            return empirical_rate(
                intensity,
                states,
                hazard,
                record=xr.DataArray(np.arange(states.sizes["record"]), dims="record"),
                property_sample=xr.DataArray(np.arange(states.sizes["property_sample"]), dims="property_sample"),
                confidence=self.confidence,
                resamples=self.resamples,
                rng=np.random.default_rng(key),
            )

        unknown = bool((reached == NOT_KNOWN).any())
        plain = reached.drop_vars([name for name in reached.coords if name != LIMIT_STATE])
        below = counted(plain.where(plain != NOT_KNOWN, np.int8(0)))
        above = counted(plain.where(plain != NOT_KNOWN, np.int8(1))) if unknown else below
        share = float((plain.isel({LIMIT_STATE: -1}) == NOT_KNOWN).mean())
        rate = 0.5 * (below["annual_rate"] + above["annual_rate"]).to_numpy()
        return {
            "annual_rate": np.where(share <= MATTERS, rate, np.nan),
            "rate_low": below["rate_low"].to_numpy(),
            "rate_high": above["rate_high"].to_numpy(),
            "rate_least": below["rate_least"].to_numpy(),
            "rate_most": above["rate_most"].to_numpy(),
        }


@cache
def limit_state_names() -> tuple[str, ...]:
    """Return the names of the limit states of a ranking; overturning is the last."""
    none: dict[str, Any] = {name: ("run", np.zeros(1)) for name in KEPT} | {"outcome": ("run", [NOT_COMPUTED])}
    names = limit_states(xr.Dataset(none), slenderness=1.0)[LIMIT_STATE].to_numpy().tolist()
    return tuple(names)


def _tilt_quantiles(part: xr.Dataset, slides: xr.DataArray) -> dict[str, Floats]:
    """Return quantiles of the peak tilt over α_c at each scale: infinite if overturned, NaN if not known."""
    ratios = tilt_ratios(part, part["slenderness"]).where(~slides).transpose("scale", ...).to_numpy()
    known = ~np.isnan(ratios)
    flat = (len(ratios), -1)
    below, above = (np.where(known, ratios, other).reshape(flat) for other in (0.0, np.inf))
    found = {}
    for name, share in _QUANTILES.items():
        low, high = _quantile(below, share), _quantile(above, share)
        found[name] = np.where(low == high, low, np.nan)
    return found


def _quantile(values: Floats, share: float) -> Floats:
    """Return the quantile along the last axis that is one of the values, so that infinite ones are possible."""
    return np.asarray(np.quantile(values, share, axis=-1, method="inverted_cdf"))


VARIABLES: Mapping[str, tuple[str, str, tuple[str, ...]]] = {
    "probability": ("probability of reaching the limit state", "1", (LIMIT_STATE, "scale")),
    "probability_low": ("lower end of its interval over records", "1", (LIMIT_STATE, "scale")),
    "probability_high": ("upper end of its interval over records", "1", (LIMIT_STATE, "scale")),
    "probability_least": ("probability if no run that is not known reaches it", "1", (LIMIT_STATE, "scale")),
    "probability_most": ("probability if all runs that are not known reach it", "1", (LIMIT_STATE, "scale")),
    "tilt_median": ("median of the peak tilt / α_c", "1", ("scale",)),
    "tilt_84": ("84 % quantile of the peak tilt / α_c", "1", ("scale",)),
    "friction_demand_median": ("median of the peak friction demand", "1", ("scale",)),
    "friction_demand_84": ("84 % quantile of the peak friction demand", "1", ("scale",)),
    "slip_share": ("share of runs that need more than the friction coefficient", "1", ("scale",)),
    "sliding_share": ("share of runs that slide before they rock", "1", ("scale",)),
    "undecided_share": ("share of undecided runs", "1", ("scale",)),
    "runs": ("runs", "1", ()),
    "annual_rate": ("annual rate, counted", "a-1", (LIMIT_STATE,)),
    "rate_low": ("lower end of its interval over records", "a-1", (LIMIT_STATE,)),
    "rate_high": ("upper end of its interval over records", "a-1", (LIMIT_STATE,)),
    "rate_least": ("lower bound beyond the scales", "a-1", (LIMIT_STATE,)),
    "rate_most": ("upper bound beyond the scales", "a-1", (LIMIT_STATE,)),
}
"""Numbers of each object, in the order of the Dataset."""

_OF_RATES = ("annual_rate", "rate_low", "rate_high", "rate_least", "rate_most")


def ranked(
    objects: Mapping[str, PreparedObject],
    numbers: Mapping[str, Mapping[str, Any]],
    names: tuple[str, ...],
    scales: tuple[float, ...],
    limit_state: str,
) -> xr.Dataset:
    """Rank the objects by the annual rate of a limit state, or by its probability if an object has no rate.

    Objects whose number is withheld follow without a rank, in the order of their upper bounds. Equal numbers are ranked
    by the median peak tilt; objects that are equal in this too share a rank, in the order of their names.

    Parameters
    ----------
    objects, numbers
        Objects, and their numbers from `Evaluation.numbers`, by name.
    names
        Names of the limit states.
    scales
        Factors of the records.
    limit_state
        Limit state by which the objects are ranked.

    Returns
    -------
    xarray.Dataset
        Over `object`, in the order of the ranking: `rank`, 0 if withheld, `site` and the numbers; and over
        `limit_state` and `scale`.
    """
    by_rate = all("annual_rate" in one for one in numbers.values())
    state, scale = names.index(limit_state), int(np.argmin(np.abs(np.log(scales))))

    def key(name: str) -> tuple[bool, float, float, str]:
        one = numbers[name]
        value = one["annual_rate"][state] if by_rate else one["probability"][state, scale]
        bound = one["rate_most"][state] if by_rate else one["probability_most"][state, scale]
        tilt = one["tilt_median"][scale]
        withheld = bool(np.isnan(value))
        return (
            withheld,
            -float(bound if withheld else value),
            -float(np.nan_to_num(tilt, nan=-1.0, posinf=np.inf)),
            name,
        )

    order = sorted(objects, key=key)
    keys = [key(name) for name in order]
    ranks = [0 if one[0] else 1 + next(at for at, other in enumerate(keys) if other[:3] == one[:3]) for one in keys]
    lengths = {LIMIT_STATE: len(names), "scale": len(scales)}
    data: dict[str, Any] = {
        "rank": ("object", np.array(ranks), cf_attributes("1", "rank")),
        "site": ("object", [objects[name].given.site or objects[name].site for name in order], {"long_name": "site"}),
    }
    for name, (text, units, dims) in VARIABLES.items():
        if name in _OF_RATES and not any(name in one for one in numbers.values()):
            continue
        missing = np.full([lengths[dim] for dim in dims], np.nan)
        values = np.array([numbers[one].get(name, missing) for one in order])
        data[name] = (("object", *dims), values, cf_attributes(units, text))
    return xr.Dataset(
        data,
        coords={
            "object": order,
            LIMIT_STATE: list(names),
            "scale": ("scale", list(scales), cf_attributes("1", "factor of the records")),
        },
        attrs={
            "kind": "inventory",
            "limit_state": limit_state,
            "ranked_by": "annual_rate" if by_rate else "probability",
        },
    )
