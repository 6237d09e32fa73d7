"""Verdicts on one column: by record and dissipation, small variations and a planar column."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stylobate.earthquakes import incremental_dynamic_analysis, planar_bias
from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs, Parts
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.planar_comparison import bias_of
from stylobate.earthquakes.property_spreads import LogUniformSpread, Spread, UniformSpread
from stylobate.earthquakes.verdict_study import contact_laws, verdict
from stylobate.progress import Report
from stylobate.results.verdict import Verdict
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.designs import Floats

_DEMANDS: Mapping[str, tuple[str, str]] = {
    "peak_friction_demand": ("friction_demand", "peak friction force over normal force"),
    "peak_pivoting_demand": ("pivoting_demand", "peak moment about the vertical over normal force and radius"),
    "minimum_normal_force": ("minimum_normal_force", "minimum normal force over weight"),
}


def verdicts_on(inputs: Inputs, column: str, parts: Parts, *, contact: bool, executor: Executor | None) -> xr.Dataset:
    """Compute the verdicts on a column.

    Returns
    -------
    xarray.Dataset
        Over `record`, `dissipation`, `vertical` and `scale`: `overturned` (1, 0, −1 if the run is undecided),
        `outcome`, `tilt_ratio`, `uncertain`, `friction_demand` (standing and moving), `pivoting_demand`,
        `minimum_normal_force`.
    """
    vertical = (True, False) if inputs.has_vertical else (True,)
    levels = inputs.dissipation[column]
    names = list(levels[CENTRAL])
    parameters = {name: np.array([numbers[name] for numbers in levels.values()]) for name in names}

    options = inputs.options.copy()
    options["demands"] = contact
    options.setdefault("recheck", True)

    def compute(progress: Report) -> xr.Dataset:
        runs = incremental_dynamic_analysis(
            inputs.columns[column][CENTRAL],
            dict(inputs.records),
            scales=inputs.scales,
            vertical=vertical,
            parameters=parameters,
            tail=inputs.tail,
            executor=executor,
            progress=progress,
            **options,
        )
        return _table_of_verdicts(runs.expand_dims("vertical") if len(vertical) == 1 else runs)

    count = len(inputs.records) * len(levels) * len(vertical) * inputs.scales.size
    identity = {**inputs.identity(column), "scales": inputs.scales.tolist(), "contact": contact}
    found = parts.get(f"{column}: verdicts", count, identity, compute)
    return found.assign_coords(dissipation=list(levels), vertical=["with", "without"][: len(vertical)])


def verdict_runs(inputs: Inputs) -> int:
    """Return the number of runs for the verdicts on one column."""
    return len(inputs.records) * len(inputs.levels) * (2 if inputs.has_vertical else 1) * inputs.scales.size


def _table_of_verdicts(runs: xr.Dataset) -> xr.Dataset:
    plain = runs.rename(property_sample="dissipation")
    plain = plain.drop_vars([name for name in plain.coords if name not in ("record", "scale", LIMIT_STATE)])
    found = {
        "overturned": plain["reached"].sel({LIMIT_STATE: "overturning"}, drop=True).astype(np.int8),
        "outcome": plain["outcome"],
        "tilt_ratio": plain["tilt_ratio"],
        "uncertain": plain["uncertain"].astype(np.int8),
    }
    empty = xr.full_like(plain["tilt_ratio"], np.nan)
    for name, (own, long_name) in _DEMANDS.items():
        found[own] = plain.get(name, empty).assign_attrs(units="1", long_name=long_name)
    ordered = {name: one.transpose("record", "dissipation", "vertical", "scale") for name, one in found.items()}
    return xr.Dataset(ordered).assign_attrs(provenance=runs.attrs["provenance"])


# Number of records in one stored part: enough to occupy the cores, few enough to lose at Ctrl-C.
_TOGETHER = 4


def _some_at_a_time(inputs: Inputs) -> list[Inputs]:
    """Split the records into groups that are computed and stored together."""
    names = list(inputs.records)
    return [inputs.with_records(names[at : at + _TOGETHER]) for at in range(0, len(names), _TOGETHER)]


def _part_name(column: str, what: str, inputs: Inputs) -> str:
    """Return the name of the part of a group of records."""
    first, last = next(iter(inputs.records)), list(inputs.records)[-1]
    return f"{column}: {what}, {first}" + (f" to {last}" if last != first else "")


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
        for some in _some_at_a_time(inputs)
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
    return parts.get(_part_name(column, what, inputs), runs, identity, compute)


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


_AXES = 2
# Variables that count records.
_COUNTS = ("only_space", "only_planar")


def planar_of(inputs: Inputs, column: str, parts: Parts, *, executor: Executor | None) -> xr.Dataset:
    """Compute the response of Housner's planar column, at the central dissipation.

    Returns
    -------
    xarray.Dataset
        Over `record` and `scale`: `planar_tilt_ratio`, the larger one of the two components, infinite if it
        overturns, and `log_ratio` of the tilts if both columns rock; over `scale` `bias`, `standard_error`,
        `compared`, `only_space`, `only_planar`.
    """
    few = [_planar_at(some, column, parts, executor) for some in _some_at_a_time(inputs)]
    records = xr.concat([one.drop_vars(_COUNTS) for one in few], dim="record", join="override")
    counts = xr.concat([one[list(_COUNTS)] for one in few], dim="part").sum("part", keep_attrs=True)
    return records.assign({**counts.data_vars, **bias_of(records["log_ratio"])})


def _planar_at(inputs: Inputs, column: str, parts: Parts, executor: Executor | None) -> xr.Dataset:
    def compute(progress: Report) -> xr.Dataset:
        found = planar_bias(
            inputs.columns[column][CENTRAL],
            dict(inputs.records),
            scales=inputs.scales,
            tail=inputs.tail,
            executor=executor,
            progress=progress,
            **inputs.options,
        )
        kept = found[["log_ratio", *_COUNTS]].assign(planar_tilt_ratio=found["worst_planar_tilt_ratio"])
        return kept.drop_vars([name for name in kept.coords if name not in ("record", "scale")])

    identity = {**inputs.identity(column, inputs.columns[column][CENTRAL]), "scales": inputs.scales.tolist()}
    return parts.get(_part_name(column, "planar", inputs), planar_runs(inputs), identity, compute)


def planar_runs(inputs: Inputs) -> int:
    """Return the number of runs for the planar comparison of one column."""
    return len(inputs.records) * inputs.scales.size * (1 + _AXES)
