"""Rules of practice beside the simulation: how often each is right, unsafe or needlessly strict."""

from collections.abc import Mapping, Sequence
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.column import Column
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.incremental import incremental_dynamic_analysis
from stylobate.earthquakes.planar_comparison import part_of
from stylobate.earthquakes.study_inputs import Records, named_records
from stylobate.errors import ParameterError
from stylobate.models import Model
from stylobate.practice.rules import rules_of_practice
from stylobate.practice.shaking import Shaking
from stylobate.progress import Progress, shows_progress
from stylobate.run_arguments import RunOptions
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.designs import Floats

_COUNTS = {
    "decided": "runs that overturn or stand",
    "right": "runs with the answer of the rule",
    "unsafe": "runs that overturn although the rule calls them safe",
    "strict": "runs that stand although the rule calls them unsafe",
}


@shows_progress("rules of practice")
def compare_rules(
    models: Model | Mapping[str, Model],
    records: Records,
    *,
    scales: npt.ArrayLike,
    tail: float | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Count how often rules of practice agree with the simulation, are unsafe, or are needlessly strict.

    Parameters
    ----------
    models
        One column with its equations of motion, or a mapping from names to several.
    records, scales, tail
        As for `incremental_dynamic_analysis`.
    executor, progress, **options
        As for `incremental_dynamic_analysis`.

    Returns
    -------
    xarray.Dataset
        Of kind "rules of practice". Over `model`, `record` and `scale`: `overturned` (1, 0, −1 if undecided) and
        `tilt_ratio`; over `rule` too: `safe`, the answer of each rule of `stylobate.practice.rules_of_practice`, and
        `ratio`, demand over capacity. Over `rule` and `model` the counts `right`, `unsafe` (the rule calls safe a
        column that overturns) and `strict` (it calls unsafe one that stands); over `model`, `decided`, their sum.
        Coordinates over `rule`: `clause`, `source`, `checked`.

    Raises
    ------
    ParameterError
        If `models` is neither a model nor a mapping of models, or an argument is out of range.

    Notes
    -----
    A rule of design is meant to be strict. The counts depend on the scales: they describe a set of runs, not a rule.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Wobbling(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.05)
    >>> pulse = sb.Pulse.one_sine(acceleration=1.0, angular_frequency=6.0)
    >>> found = sb.earthquakes.compare_rules(model, pulse, scales=[1.0, 2.2, 9.0])
    >>> found["overturned"].values.ravel().tolist(), found["safe"].sel(rule="West").values.ravel().tolist()
    ([0, 0, 1], [True, False, False])
    """
    named = {"model": models} if isinstance(models, Model) else models
    if not isinstance(named, Mapping) or not named or not all(isinstance(one, Model) for one in named.values()):
        raise ParameterError(f"models: must be a model or a mapping of models (got {models!r}). Pass Wobbling(column).")
    motions = named_records(records)
    shaking = [Shaking.of(motion) for motion in motions.values()]
    total = len(named) * len(motions) * np.size(scales)
    compared = []
    for place, model in enumerate(named.values()):
        runs = incremental_dynamic_analysis(
            model,
            motions,
            scales=scales,
            tail=tail,
            executor=executor,
            progress=part_of(progress, place * total // len(named), total),
            **options,
        )
        compared.append(_answers(model, shaking, runs).assign_attrs(provenance=runs.attrs["provenance"]))
    found = xr.concat(compared, "model", coords="minimal", compat="override")
    return _counted(found.assign_coords(model=[str(name) for name in named]))


def _answers(model: Model, shaking: list[Shaking], runs: xr.Dataset) -> xr.Dataset:
    """Return the outcomes of runs over record and scale, with the answers of the rules."""
    overturned = runs["reached"].sel({LIMIT_STATE: "overturning"}, drop=True)
    return answers_of(model.column, shaking, runs["scale"].to_numpy()).assign(
        overturned=overturned.assign_attrs(long_name="overturned", units="1"), tilt_ratio=runs["tilt_ratio"]
    )


def answers_of(column: Column, shaking: Sequence[Shaking], scales: Floats) -> xr.Dataset:
    """Return the answers of the rules for a column: `safe` and `ratio` over `record`, `scale` and `rule`."""
    answers = [[rules_of_practice(column, one.scaled(float(scale))) for scale in scales] for one in shaking]
    rules = answers[0][0]
    texts = {"ratio": {"units": "1", "long_name": "demand / capacity"}, "safe": {"long_name": "called safe"}}
    values = {
        name: (
            ("record", "scale", "rule"),
            np.array([[[getattr(answer, name) for answer in row] for row in rows] for rows in answers]),
            about,
        )
        for name, about in texts.items()
    }
    about_rules: dict[str, Any] = {
        name: ("rule", [getattr(answer, name) for answer in rules]) for name in ("clause", "source", "checked")
    }
    return xr.Dataset(values, coords={"rule": [answer.rule for answer in rules], **about_rules})


def _counted(found: xr.Dataset) -> xr.Dataset:
    fell, stood, safe = found["overturned"] == 1, found["overturned"] == 0, found["safe"]
    over = ("record", "scale")
    counts = {
        "decided": fell | stood,
        "right": (safe & stood) | (~safe & fell),
        "unsafe": safe & fell,
        "strict": ~safe & stood,
    }
    return found.assign(
        {name: counts[name].sum(over).assign_attrs(units="1", long_name=text) for name, text in _COUNTS.items()}
    ).assign_attrs(kind="rules of practice")
