"""Shares of small variations that overturn one column, at each stated scale of each record."""

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs
from stylobate.earthquakes.assessment.parts import Parts
from stylobate.earthquakes.assessment.planar import part_name, some_at_a_time
from stylobate.earthquakes.property_spreads import LogUniformSpread, Spread, UniformSpread
from stylobate.earthquakes.verdict_study import contact_laws, verdict
from stylobate.progress import Report
from stylobate.results.verdict import Verdict
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.quantities import Floats

_OF_RUNS = ("demands", "recheck")
_QUANTILES = {"tilt_ratio_low": 0.05, "tilt_ratio_median": 0.5, "tilt_ratio_high": 0.95}


def shares_of(inputs: Inputs, column: str, parts: Parts, *, executor: Executor | None) -> xr.Dataset:
    """Compute the verdicts under small variations; the damping varies over the stated levels.

    Returns
    -------
    xarray.Dataset
        Over `record` and `scale`: `share` of variations that overturn the column, with its 90 % interval `share_low`,
        `share_high`; `word`; `deciding`; numbers of variations: `overturned`, `open` (undecided) and `runs`; quantiles
        of the peak tilt of the decided runs, infinite if overturned: `tilt_ratio_low`, `tilt_ratio_median`,
        `tilt_ratio_high` (5, 50, 95 %). Over `contact_law` too: `law_share`.
    """
    few = [
        xr.concat(
            [_shares_at(some, column, scale, parts, executor) for scale in inputs.scales.tolist()],
            dim=xr.Variable("scale", inputs.scales),
            data_vars="all",
            join="override",
        )
        for some in some_at_a_time(inputs)
    ]
    joined: xr.Dataset = xr.concat(few, dim="record", data_vars="all", join="override")
    return joined


def _shares_at(inputs: Inputs, column: str, scale: float, parts: Parts, executor: Executor | None) -> xr.Dataset:
    models = inputs.columns[column]
    central = models[CENTRAL]
    variations = _over_the_levels(inputs, column)

    def compute(progress: Report) -> xr.Dataset:
        found = []
        for place, motion in enumerate(inputs.records.values()):
            progress(place, len(inputs.records))
            laws = contact_laws(central if inputs.contact_laws else [central])
            options = {name: value for name, value in inputs.options.items() if name not in _OF_RUNS}
            found.append(
                verdict(
                    laws,
                    motion.scaled(scale),
                    variations=variations,
                    runs=inputs.variations,
                    seed=inputs.seed,
                    tail=inputs.tail,
                    executor=executor,
                    **options,  # type: ignore[arg-type]
                )
            )
        return _table_of_shares(found, list(inputs.records))

    identity = {
        **inputs.identity(column),
        "scale": scale,
        "variations": inputs.variations,
        "seed": inputs.seed,
        "contact laws": inputs.contact_laws,
    }
    runs = len(inputs.records) * inputs.variations
    what = f"small variations, scale {scale:g}, {runs} runs"
    return parts.get(part_name(column, what, inputs), runs, identity, compute)


def share_runs(inputs: Inputs) -> int:
    """Return the number of runs for the small variations of one column."""
    return len(inputs.records) * inputs.variations * inputs.scales.size


def _over_the_levels(inputs: Inputs, column: str) -> dict[str, Spread | None]:
    """Return the distribution of each dissipation parameter: from its smallest to its largest level."""
    levels = inputs.dissipation[column].values()
    found: dict[str, Spread | None] = {"dissipation": None}
    for name in inputs.dissipation[column][CENTRAL]:
        low, high = min(one[name] for one in levels), max(one[name] for one in levels)
        found[name] = LogUniformSpread(low, high) if low > 0.0 else UniformSpread(low, high)
    return found


def _table_of_shares(found: list[Verdict], records: list[str]) -> xr.Dataset:
    shares = np.array([(one.share, *one.interval) for one in found])
    states = [one.data["overturned"].to_numpy() for one in found]
    ratios = [one.data["tilt_ratio"].to_numpy()[state >= 0] for one, state in zip(found, states, strict=True)]
    law_shares = np.array([one.data["model_share"].to_numpy() for one in found])
    one = {"units": "1"}
    return xr.Dataset(
        {
            "share": ("record", shares[:, 0], {**one, "long_name": "share of small variations that overturn it"}),
            "share_low": ("record", shares[:, 1], {**one, "long_name": "lower end of the interval"}),
            "share_high": ("record", shares[:, 2], {**one, "long_name": "upper end of the interval"}),
            "word": ("record", [str(one.word.value) for one in found]),
            "deciding": ("record", [one.deciding for one in found]),
            "overturned": ("record", [int((state == 1).sum()) for state in states]),
            "open": ("record", [int((state < 0).sum()) for state in states]),
            "runs": ("record", [state.size for state in states]),
            **{name: ("record", [_quantile(ratio, at) for ratio in ratios], one) for name, at in _QUANTILES.items()},
            "law_share": (("record", "contact_law"), law_shares, {**one, "long_name": "share of overturning"}),
        },
        coords={"record": records, "contact_law": [str(name) for name in found[0].data["model"].to_numpy()]},
    )


def _quantile(ratios: Floats, at: float) -> float:
    """Return a quantile of peak tilts, one of the values; NaN without any."""
    return float(np.quantile(ratios, at, method="higher")) if ratios.size else np.nan
