"""Small variations of one case: how often it ends in each way, and its tilt over time."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.special import ndtri
from scipy.stats import qmc

from stylobate import config, engine
from stylobate.config.simulation import Setup
from stylobate.engine.ensemble import simulate_ensemble
from stylobate.engine.parameters import present_value
from stylobate.errors import Outcome, ParameterError, UnsupportedError
from stylobate.lab import answers
from stylobate.lab.messages import Emit
from stylobate.models.declared import dissipation_of
from stylobate.quantities import Quantity
from stylobate.run_arguments import Accuracy
from stylobate.studies.proportions import wilson_interval

RUNS = 64
_SMALL, _KEPT, _LOSS = 0.01, 0.02, 0.1
"""Standard deviations of the logarithms: of slenderness, shaking and first tilt; of numbers of dissipation that are at
most 1, such as a restitution; and of all others, such as a damping."""

_SAMPLES, _SEED = 160, 1
_LONGER = 3.0
"""Variations of a run that lasts until its outcome is decided may need longer than that run, by this factor."""


def variations(values: Mapping[str, Any], emit: Emit) -> answers.Variations:
    """Compute small variations of the case that `values` describe."""
    del emit
    setup = config.SimulationConfig.parse(values).build()
    run = engine.simulate(setup.model, setup.motion, **{**setup.options, "samples": 2, "recheck": False})
    numbers, losses = _numbers(setup), dissipation_of(type(setup.model))
    normal = ndtri(qmc.Sobol(len(numbers) + 1, rng=np.random.default_rng(_SEED)).random(RUNS))
    spreads = {name: _spread(losses.get(name)) for name in numbers}
    varied = {
        name: np.minimum(value * np.exp(spreads[name] * column), 1.0 if spreads[name] == _KEPT else np.inf)
        for (name, value), column in zip(numbers.items(), normal[:, :-1].T, strict=True)
    }
    tilt = np.exp(_SMALL * normal[:, -1:]) * np.asarray(setup.options["tilt"])
    start = {name: setup.options[name] for name in ("tilt_rate", "spin") if setup.options.get(name) is not None}
    accuracy = {name: setup.options[name] for name in Accuracy.__annotations__ if name in setup.options}
    found = simulate_ensemble(
        setup.model,
        setup.motion,
        **{**start, **accuracy},
        tilt=tilt,
        duration=(_LONGER if setup.options["duration"] is None else 1.0) * run.provenance["duration"],
        parameters=varied,
        samples=_SAMPLES,
        progress=False,
    )
    return _answered(found, spreads)


def _numbers(setup: Setup) -> dict[str, float]:
    """Return the numbers of the case that vary: shape, strength of the shaking, and what dissipates."""
    found = {}
    for name in ("slenderness", "scale", *dissipation_of(type(setup.model))):
        if name == "scale" and setup.motion.duration == 0.0:
            continue
        try:
            found[name] = present_value(setup.model, setup.motion, name)
        except (ParameterError, UnsupportedError):  # this case has no such number
            continue
    return {name: value for name, value in found.items() if value > 0.0}


def _spread(loss: Quantity | None) -> float:
    """Return the standard deviation of the logarithm of a number, which may be one of dissipation."""
    if loss is None:
        return _SMALL
    return _KEPT if loss.le == 1.0 else _LOSS


def _answered(found: Any, spreads: Mapping[str, float]) -> answers.Variations:
    outcome = found["outcome"].to_numpy()
    codes, counts = np.unique(outcome, return_counts=True)
    low, high = wilson_interval(counts, RUNS)
    order = np.argsort(-counts)
    return answers.Variations(
        varied=[answers.Varied(name=name, deviation=spread) for name, spread in spreads.items()],
        runs=RUNS,
        classes=[
            answers.CellClass(
                code=int(codes[i]),
                name=Outcome(int(codes[i])).label,
                share=counts[i] / RUNS,
                low=float(low[i]),
                high=float(high[i]),
            )
            for i in order
        ],
        outcomes=[Outcome(int(one)).name for one in outcome],
        times=found["sample_time"],
        tilts=np.hypot(*np.moveaxis(found["sampled_tilt"].to_numpy(), -1, 0)),
    )
