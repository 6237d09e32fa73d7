"""Slip of columns that slide before they rock: at the stated scales, under small variations, and over the margin."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs, Parts
from stylobate.earthquakes.fragility.displacement_limits import LimitState, Response
from stylobate.earthquakes.fragility.observations import LIMIT_STATE, NOT_KNOWN
from stylobate.earthquakes.property_spreads import VARIATIONS, LognormalSpread, shares_of
from stylobate.earthquakes.slip_paths import slip_paths
from stylobate.earthquakes.slip_study import attributes_of_slip, reached_by_slip, slip_numbers, slip_under
from stylobate.earthquakes.study_inputs import tail_of
from stylobate.engine import simulate
from stylobate.errors import Outcome
from stylobate.models import Model, Sliding
from stylobate.models.declared import dissipation_of
from stylobate.progress import Report
from stylobate.results.outcomes import NOT_COMPUTED, NUMERICALLY_UNCERTAIN, outcome_attributes
from stylobate.run_arguments import Accuracy, numbers_of
from stylobate.studies.sweeps.designs import Floats

_OPTIONS = tuple(name for name in numbers_of(Accuracy) if name != "tilt_limit")
_SLIPS = ("peak_slip", "residual_slip", "residual_x", "residual_y", "slip_path", "time_sliding")
_RUN = ("outcome", "overturned", "uncertain", "tilt_ratio", *_SLIPS)
_STANDS = {"outcome": float(Outcome.AT_REST), "overturned": 0.0, "uncertain": 0.0, "tilt_ratio": 0.0}
_NOT_FOLLOWED = {**dict.fromkeys(_RUN, math.nan), "outcome": float(NOT_COMPUTED), "overturned": -1.0, "uncertain": 0.0}
_QUANTILES = {"low": 0.05, "median": 0.5, "high": 0.95}
# Share of the small variations within the angle about the direction of the residual slip.
_WITHIN = 0.9


def sliding_of(inputs: Inputs, column: str, parts: Parts) -> xr.Dataset:
    """Compute the slip of a column at the stated scales, at its stated friction, and under small variations.

    Where the column stands on its whole base it is a sliding block, see `block_slip`. A run in which the base falls
    faster than g is that of the model `Sliding`, at the central dissipation; small variations of it are not known.

    Returns
    -------
    xarray.Dataset
        Over `record` and `scale`: `outcome`; `overturned` (1, 0, −1 not decided); `uncertain` (1 if rounding or the
        rest threshold could alter the outcome); `tilt_ratio`, infinite if the column overturned; `residual_slip`,
        `residual_x`, `residual_y`, `peak_slip` and `slip_path` [m]; `time_sliding` [s]. Quantiles of `peak_slip` and
        `residual_slip` under small variations of record and friction, with the ends `_low`, `_median` and `_high` (5,
        50, 95 %); `residual_azimuth` [rad] and `azimuth_within`, the angle on both sides that has 90 % of the
        variations; `known_variations`, their number. Over `scale` the same quantiles over all records and variations,
        as `all_peak_slip_low` and so on. Over `limit_state` too: `reached` and `reached_share`, the share of
        variations. A column that rocks before it slides is not run: `outcome`, `overturned` and `reached` are −1, the
        rest is NaN.
    """
    followed = column in inputs.sliding_first
    runs = [
        [_at_scale(inputs, column, name, scale, parts) for scale in inputs.scales.tolist()] if followed else None
        for name in inputs.records
    ]
    blank = xr.Dataset({name: float(value) for name, value in _NOT_FOLLOWED.items()}).assign(
        {name: ("variation", np.full(max(inputs.variations, 1), np.nan)) for name in map(_varied, _SLIPS[:4])}
    )
    rows = [
        xr.concat(row or [blank] * inputs.scales.size, dim=xr.Variable("scale", inputs.scales), combine_attrs="drop")
        for row in runs
    ]
    joined: xr.Dataset = xr.concat(rows, dim=xr.Variable("record", list(inputs.records)))
    found = xr.Dataset(
        {
            "outcome": joined["outcome"].astype(np.int8).assign_attrs(outcome_attributes()),
            "overturned": joined["overturned"].astype(np.int8).assign_attrs(long_name="overturned"),
            "uncertain": joined["uncertain"].astype(np.int8).assign_attrs(long_name=NUMERICALLY_UNCERTAIN),
            "tilt_ratio": joined["tilt_ratio"].assign_attrs(units="1", long_name="peak tilt / α_c"),
            **{name: joined[name].assign_attrs(attributes_of_slip(name)) for name in _SLIPS},
        }
    )
    return found.assign({**_spread(joined), **_direction(joined), **_reached(inputs, column, joined)})


def sliding_runs(inputs: Inputs) -> int:
    """Return the number of runs at the stated scales for the columns that slide."""
    return len(inputs.sliding_first) * len(inputs.records) * inputs.scales.size * (1 + inputs.variations)


def sliding_model(given: Model, friction: float) -> Sliding:
    """Return `Sliding` with the column of a model and those dissipation parameters that both models have."""
    losses = {name: getattr(given, name) for name in dissipation_of(Sliding) if name in dissipation_of(type(given))}
    return Sliding(given.column, friction_coefficient=friction, **losses)


def _varied(name: str) -> str:
    return f"varied_{name}"


def _at_scale(inputs: Inputs, column: str, record: str, scale: float, parts: Parts) -> xr.Dataset:
    """Compute the slip under a record at one scale: as stated, and `varied_…` over `variation`."""

    def compute(progress: Report) -> xr.Dataset:
        progress(0, 1)
        return _slip_at(inputs, column, record, scale)

    identity = {
        **inputs.with_records([record]).identity(column, inputs.columns[column][CENTRAL]),
        "scale": scale,
        "sliding": inputs.friction[column],
        "dispersion": inputs.friction_dispersion,
        "variations": inputs.variations,
        "seed": inputs.seed,
    }
    return parts.get(f"{column}: sliding under {record}, scale {scale:g}", 1 + inputs.variations, identity, compute)


def _slip_at(inputs: Inputs, column: str, record: str, scale: float) -> xr.Dataset:
    body, friction = inputs.columns[column][CENTRAL].column, inputs.friction[column]
    varied = {name: VARIATIONS[name].draw(1.0, _shares(inputs, name)) for name in ("scale", "clock")}
    rotation = VARIATIONS["rotation"].draw(0.0, _shares(inputs, "rotation"))
    frictions = LognormalSpread(inputs.friction_dispersion, friction).draw(friction, _shares(inputs, "friction"))
    slid = slip_under(
        inputs.records[record], np.append(friction, frictions), scale * np.append(1.0, varied["scale"]), body.gravity
    )
    numbers = slip_numbers(slid)
    if slid.flies[0]:
        stated = _run_of_model(inputs, column, record, scale)
    else:
        stated = {**_STANDS, **{name: float(values[0]) for name, values in numbers.items()}}
    # a column that would rock, or lifts off, is not described; a slower clock stretches the slip by its square
    known = (frictions < body.slenderness) & ~slid.flies[1:]
    x, y = numbers["residual_x"][1:], numbers["residual_y"][1:]
    turned = {
        "residual_x": x * np.cos(rotation) - y * np.sin(rotation),
        "residual_y": x * np.sin(rotation) + y * np.cos(rotation),
        **{name: numbers[name][1:] for name in ("peak_slip", "residual_slip")},
    }
    stretched = {
        _varied(name): np.where(known, values * varied["clock"] ** 2, np.nan) for name, values in turned.items()
    }
    return xr.Dataset(
        {
            **{name: stated[name] for name in _RUN},
            **{name: ("variation", values if values.size else [np.nan]) for name, values in stretched.items()},
        }
    )


def _shares(inputs: Inputs, name: str) -> Floats:
    return shares_of(name, runs=inputs.variations, seed=inputs.seed)


def _run_of_model(inputs: Inputs, column: str, record: str, scale: float) -> dict[str, float]:
    """Run a column with `Sliding`."""
    given = inputs.columns[column][CENTRAL]
    model, motion = sliding_model(given, inputs.friction[column]), inputs.records[record].scaled(scale)
    options: dict[str, Any] = {name: value for name, value in inputs.options.items() if name in _OPTIONS}
    run = simulate(model, motion, duration=motion.duration + tail_of(given.column, inputs.tail), **options)
    fallen, undecided = run.outcome is Outcome.OVERTURNED, run.outcome is Outcome.FAILED
    places = run.data["footprint"].transpose("axis", "time").to_numpy()
    tilt = run.measures["peak_tilt"] / given.column.tipping_angle
    return {
        "outcome": float(run.outcome),
        "overturned": -1.0 if undecided else float(fallen),
        "uncertain": float(run.uncertain),
        "tilt_ratio": math.inf if fallen else math.nan if undecided else tilt,
        "residual_slip": run.measures["residual_displacement"],
        "residual_x": float(places[0, -1]),
        "residual_y": float(places[1, -1]),
        "peak_slip": float(np.hypot(*places).max()),
        "slip_path": run.measures["slip_distance"],
        "time_sliding": run.measures["time_sliding"],
    }


def _quantiles(values: xr.DataArray, dims: Sequence[str], name: str) -> dict[str, xr.DataArray]:
    """Return quantiles over dimensions, by the names `name`_low and so on; NaN where nothing is known."""
    about = attributes_of_slip(name.removeprefix("all_"))
    found = {}
    for end, share in _QUANTILES.items():
        words = {**about, "long_name": f"{about['long_name']}, {100.0 * share:g} % quantile"}
        found[f"{name}_{end}"] = _quantile(values, share, dims).assign_attrs(words)
    return found


def _quantile(values: xr.DataArray, share: float, dims: Sequence[str]) -> xr.DataArray:
    """Return a quantile of the known values over dimensions; NaN where none is known."""
    known = values.notnull().any(dims)
    return values.where(known, 0.0).quantile(share, dims, skipna=True).drop_vars("quantile").where(known)


def _spread(joined: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the quantiles over small variations, and over records and variations."""
    found: dict[str, xr.DataArray] = {}
    for name in ("peak_slip", "residual_slip"):
        varied = joined[_varied(name)]
        pooled = varied if bool(varied.notnull().any()) else joined[name].expand_dims("variation")
        found |= _quantiles(varied, ["variation"], name)
        found |= _quantiles(pooled, ["record", "variation"], f"all_{name}")
    count = joined[_varied("peak_slip")].notnull().sum("variation")
    return {**found, "known_variations": count.assign_attrs(units="1", long_name="small variations that are known")}


def _direction(joined: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the azimuth of the residual slip, and the angle on both sides that has most small variations."""
    x, y = joined["residual_x"], joined["residual_y"]
    other_x, other_y = joined[_varied("residual_x")], joined[_varied("residual_y")]
    turn = xr.apply_ufunc(np.arctan2, x * other_y - y * other_x, x * other_x + y * other_y)
    angle = xr.apply_ufunc(np.abs, turn)
    moved = joined["residual_slip"] > 0.0
    within = _quantile(angle.where(moved), _WITHIN, ["variation"])
    azimuth = xr.apply_ufunc(np.arctan2, y, x)
    return {
        "residual_azimuth": azimuth.where(moved).assign_attrs(
            units="rad", long_name="azimuth of the residual slip, from x towards y"
        ),
        "azimuth_within": within.assign_attrs(
            units="rad", long_name=f"angle on both sides that has {100.0 * _WITHIN:g} % of the small variations"
        ),
    }


def _reached(inputs: Inputs, column: str, joined: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return which limit states are reached, and by what share of the small variations; empty without limit states."""
    if not inputs.limit_names:
        return {}
    own = inputs.limits[column]
    varied = xr.Dataset({name: joined[_varied(name)] for name in ("peak_slip", "residual_slip")})
    stated = joined[["peak_slip", "residual_slip"]]
    # an overturned column has reached every limit
    stated = stated.where(joined["overturned"] != 1, math.inf)
    # a column that lands after a flight may tilt too
    body = inputs.columns[column][CENTRAL].column
    tilt = joined["tilt_ratio"].where(np.isfinite(joined["tilt_ratio"]), 0.0) * body.tipping_angle
    shifts = {one.name: one.shift(tilt, [body], "column") for one in own if one.kind is Response.NEIGHBOURS}
    states, several = (
        _on_all(inputs, reached_by_slip(stated, own, shifts)),
        _on_all(inputs, reached_by_slip(varied, own)),
    )
    states = states.where((joined["overturned"] >= 0) | (states == 1), np.int8(NOT_KNOWN)).astype(np.int8)
    share = (several == 1).sum("variation") / (several >= 0).sum("variation")
    return {
        "reached": states,
        "reached_share": share.assign_attrs(units="1", long_name="share of small variations that reach it"),
    }


def _on_all(inputs: Inputs, states: xr.DataArray) -> xr.DataArray:
    """Return states over the limit states of all columns; those of another column are not known."""
    every: xr.DataArray = states.reindex({LIMIT_STATE: list(inputs.limit_names)}, fill_value=np.int8(NOT_KNOWN))
    return every.assign_attrs(states.attrs)


# Scales between two of the scan at a time, for the end of an interval.
_BETWEEN = 9


def slip_margins_of(inputs: Inputs, column: str, parts: Parts) -> xr.Dataset:
    """Compute the slip of a column over the scales of the margin, and the smallest scales that reach limit states.

    Returns
    -------
    xarray.Dataset
        Over `record` and `margin_scale`: `peak_slip` and `residual_slip` [m], NaN where the base falls faster than g;
        over `limit_state` too `reached` (1, 0, −1 not known). Over `record` and `limit_state`: `least_reaching`, the
        smallest scale that reaches it, within the relative width of the assessment, NaN if none does; `falls_back`, 1
        if a larger scale does not reach it. Over `record`: `decided_to`, the largest scale up to which all are known.
        NaN and −1 for a column that rocks before it slides.
    """
    own = inputs.limits[column]
    followed = column in inputs.sliding_first
    names, scales = list(inputs.records), inputs.margin_scales
    blank = np.full((2, scales.size), np.nan)
    rows = np.stack([_scan(inputs, column, name, parts) if followed else blank for name in names])
    dims = ("record", "margin_scale")
    found = xr.Dataset(
        {
            name: (dims, rows[:, place], attributes_of_slip(name))
            for place, name in enumerate(("peak_slip", "residual_slip"))
        },
        coords={"record": names, "margin_scale": scales},
    )
    known = found["peak_slip"].notnull()
    decided = found["margin_scale"].where(known.cumprod("margin_scale") > 0).max("margin_scale")
    found = found.assign(
        decided_to=decided.assign_attrs(units="1", long_name="largest scale up to which all are known")
    )
    if not inputs.limit_names:
        return found
    reached = reached_by_slip(found, own)
    least = np.full((len(names), len(own)), np.nan)
    back = np.full((len(names), len(own)), 0.0 if followed else np.nan)
    for place, name in enumerate(names):
        for which, limit in enumerate(own):
            states = reached.isel({LIMIT_STATE: which, "record": place}).to_numpy()
            hits = np.flatnonzero(states == 1)
            if hits.size:
                least[place, which] = _end_of(inputs, column, name, limit, int(hits[0]), states)
                back[place, which] = float(np.any(states[hits[0] :] == 0))
    over = {"record": names, LIMIT_STATE: [one.name for one in own]}
    margins = xr.Dataset(
        {
            "least_reaching": (tuple(over), least, {"units": "1", "long_name": "smallest scale that reaches it"}),
            "falls_back": (tuple(over), back, {"long_name": "whether a larger scale does not reach it"}),
        },
        coords=over,
    ).reindex({LIMIT_STATE: list(inputs.limit_names)})
    return found.assign(reached=_on_all(inputs, reached)).merge(margins)


def slip_margin_runs(inputs: Inputs) -> int:
    """Return the number of runs over the margin for the columns that slide."""
    return len(inputs.sliding_first) * len(inputs.records) * inputs.margin_scales.size


def _scan(inputs: Inputs, column: str, record: str, parts: Parts) -> Floats:
    """Return peak and residual slip over the scales of the margin, shape (2, scales)."""

    def compute(progress: Report) -> xr.Dataset:
        progress(0, 1)
        return xr.Dataset({"slip": (("number", "margin_scale"), _slips(inputs, column, record, inputs.margin_scales))})

    identity = {
        **inputs.with_records([record]).identity(column, inputs.columns[column][CENTRAL]),
        "scales": inputs.margin_scales.tolist(),
        "sliding": inputs.friction[column],
    }
    part = parts.get(f"{column}: slip margin under {record}", inputs.margin_scales.size, identity, compute)
    return np.asarray(part["slip"].to_numpy())


def _slips(inputs: Inputs, column: str, record: str, scales: Floats) -> Floats:
    """Compute peak and residual slip at scales, shape (2, scales); NaN where the base falls faster than g."""
    body = inputs.columns[column][CENTRAL].column
    slid = slip_under(inputs.records[record], inputs.friction[column], scales, body.gravity)
    numbers = slip_numbers(slid)
    return np.where(slid.flies, np.nan, np.stack([numbers["peak_slip"], numbers["residual_slip"]]))


def _end_of(inputs: Inputs, column: str, record: str, limit: LimitState, first: int, states: Floats) -> float:
    """Return the smallest reaching scale, between the `first` one of the scan and the one before it."""
    scales = inputs.margin_scales
    high = float(scales[first])
    if first == 0 or states[first - 1] != 0:
        return high
    low = float(scales[first - 1])
    while high - low > inputs.width * high:
        between = np.linspace(low, high, _BETWEEN)
        peak, residual = (xr.DataArray(one) for one in _slips(inputs, column, record, between))
        hits = np.flatnonzero(limit.of_slip(peak, residual).to_numpy())
        place = max(int(hits[0]), 1) if hits.size else _BETWEEN - 1
        low, high = float(between[place - 1]), float(between[place])
    return high


def slip_paths_of(inputs: Inputs, columns: Sequence[str]) -> xr.Dataset:
    """Compute the paths in plan of columns that slide before they rock, at the stated scale nearest to 1.

    Returns
    -------
    xarray.Dataset
        Over `column`, `record` and `sample`: `time` [s], `slip_x` and `slip_y` [m], as from `slip_paths`; NaN for a
        column that rocks before it slides. Over `column` only `scale`.
    """
    scale = float(inputs.scales[inputs.as_recorded])
    blank = np.full((len(inputs.records), 1), np.nan)
    nothing = xr.Dataset(
        dict.fromkeys(("time", "slip_x", "slip_y"), (("record", "sample"), blank)),
        coords={"record": list(inputs.records)},
    )
    paths = [
        slip_paths(
            sliding_model(inputs.columns[name][CENTRAL], inputs.friction[name]), dict(inputs.records), scale=scale
        ).drop_vars([LIMIT_STATE, "limit", "response"])
        if name in inputs.sliding_first
        else nothing
        for name in columns
    ]
    longest = max(one.sizes["sample"] for one in paths)
    padded = [one.pad(sample=(0, longest - one.sizes["sample"]), constant_values=np.nan) for one in paths]
    joined: xr.Dataset = xr.concat(padded, dim=xr.Variable("column", list(columns)), combine_attrs="drop_conflicts")
    return joined.assign(scale=("column", np.full(len(columns), scale), {"units": "1", "long_name": "scale"}))


def states_with_slip(inputs: Inputs, column: str, reached: xr.DataArray, slip: xr.Dataset | None) -> xr.DataArray:
    """Return the limit states of a column for fragility and rates; those that its runs do not describe are unknown.

    Parameters
    ----------
    inputs
        Arguments of the assessment.
    column
        Name of the column.
    reached
        States of the runs without slip, over `limit_state`, `record` and `margin_scale`.
    slip
        Margins of slip; None if they were not computed.

    Returns
    -------
    xarray.DataArray
        As `reached`. Of a column that slides before it rocks, tilts and overturning are not known, and displacements
        are those by slip.
    """
    if slip is None or column not in inputs.sliding_first:
        return reached
    unknown = xr.full_like(reached, NOT_KNOWN)
    if "reached" not in slip:
        return unknown
    own = slip["reached"].transpose(*reached.dims).assign_coords(margin_scale=reached["margin_scale"])
    names = [str(name) for name in own[LIMIT_STATE].to_numpy()]
    kept = unknown.sel({LIMIT_STATE: [name for name in reached[LIMIT_STATE].to_numpy() if name not in names]})
    joined: xr.DataArray = xr.concat([kept, own], dim=LIMIT_STATE)
    return joined.sel({LIMIT_STATE: reached[LIMIT_STATE].to_numpy()}).assign_attrs(reached.attrs)
