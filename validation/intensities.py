"""Intensity measures on measured tests and on simulated columns: what each predicts of overturning.

The measured tests are those of `shake_table`.
"""

from collections.abc import Iterator, Mapping

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.special import ndtr

import stylobate as sb
from stylobate.earthquakes import compare_intensities, scores
from stylobate.records import EvolvingNoise, intensity_table

from . import shake_table
from .finding import FOLDER, Finding

Floats = npt.NDArray[np.float64]

_SEED, _RECORDS, _PERIOD, _OTHER_PERIODS = 20261128, 60, 1.0, (0.5, 1.5)
_SCALES = np.geomspace(0.3, 12.0, 12)
_ADDS_NOTHING = 0.01
_COLUMNS = {"column of 2 m": (0.2, 2.0), "column of 8 m": (0.6, 8.0)}
"""Radius and height of solid columns [m]."""
NAMES = {
    "pga": "PGA",
    "pgv": "PGV",
    "pgv_over_pga": "PGV/PGA",
    "sa": "Sa(1 s)",
    "sa_avg": "Sa_avg(1 s)",
    "fiv3": "FIV3",
    "cav": "CAV",
    "arias": "Arias",
}
_POWERS = {"pgv_over_pga": 0, "arias": 2}
"""Powers of the motion by which measures grow, where it is not 1: dispersions are divided by them."""


def findings() -> Iterator[Finding]:
    """Write the tables; no measure is compared with a number of somebody else."""
    folder = shake_table.clone()
    if folder is not None:
        known = shake_table.tests(folder)
        measures = known.intensities(_PERIOD)[list(NAMES)]
        compared = {
            name: compare_intensities(measures, xr.DataArray(fell.astype(int), dims="record"), record=known.events)
            for name, fell in known.overturned.items()
        }
        (FOLDER / "measures_of_tests.txt").write_text(table(compared), encoding="utf-8")
        labelled = {label: measures[name].to_numpy() for name, label in NAMES.items()}
        for period in _OTHER_PERIODS:
            labelled[f"Sa_avg({period:g} s)"] = known.intensities(period)["sa_avg"].to_numpy()
        (FOLDER / "measures_held_out.txt").write_text(_held_out(known, labelled), encoding="utf-8")
    (FOLDER / "measures_of_columns.txt").write_text(table(_simulated()), encoding="utf-8")
    return iter(())


def _held_out(known: shake_table.Tests, measures: Mapping[str, Floats]) -> str:
    """Return a table of what each measure alone predicts of earthquakes that its fit does not know."""
    head = [
        "measure",
        *(f"{name}: {column}" for name in known.overturned for column in ("same outcome", "Brier score")),
    ]
    rows = [head, ["---"] * len(head)]
    for label, values in measures.items():
        row = [label]
        for fell in known.overturned.values():
            each = _predicted(values, fell, np.array(known.events))
            found = [scores(one, fell) for one in each]
            same = [one["same_outcome"] for one in found]
            row += [f"{np.mean(same):.3f}", f"{np.mean([one['brier'] for one in found]):.3f}"]
        rows.append(row)
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)


def _predicted(values: Floats, fell: npt.NDArray[np.bool_], events: npt.NDArray[np.str_]) -> Floats:
    """Return the probabilities of tests from fits to the other four fifths of the earthquakes, shape (repeats, n)."""
    random, found = np.random.default_rng(0), np.empty((shake_table.REPEATS, len(fell)))
    for row in found:
        for part in np.array_split(random.permutation(np.unique(events)), 5):
            held_out = np.isin(events, part)
            fit = compare_intensities({"x": values[~held_out]}, fell[~held_out]).isel(measure=0)
            row[held_out] = ndtr(np.log(values[held_out] / float(fit["median"])) / float(fit["dispersion"]))
    return found


def _simulated() -> dict[str, xr.Dataset]:
    random = np.random.default_rng(_SEED)
    records = {name: _synthetic(random, name) for name in (f"synthetic {number}" for number in range(_RECORDS))}
    measures = intensity_table(records.values(), period=_PERIOD, scales=_SCALES)[list(NAMES)]
    found = {}
    for name, (radius, height) in _COLUMNS.items():
        column = sb.Column.solid(radius=radius, height=height, density=2700.0)
        model = sb.Wobbling(column, damping=column.housner_damping())
        runs = sb.earthquakes.incremental_dynamic_analysis(model, records, scales=_SCALES, progress=False)
        found[name] = compare_intensities(measures, runs["reached"].sel(limit_state="overturning", drop=True))
    return found


def _synthetic(random: np.random.Generator, name: str) -> sb.Record:
    """Draw an accelerogram whose frequency and duration differ from others by factors of ten and four."""
    duration = float(np.exp(random.uniform(np.log(5.0), np.log(20.0))))
    noise = EvolvingNoise(
        arias=0.5,
        duration_5_95=duration,
        middle_time=0.5 * duration,
        frequency=float(np.exp(random.uniform(np.log(0.6), np.log(6.0)))),
        bandwidth=0.3,
    )
    return noise.record(random, components=2, name=name)


def table(found: Mapping[str, xr.Dataset]) -> str:
    """Return a table in Markdown: a row for each measure, three columns for each set of tests or runs."""
    head = ["measure", *(f"{name}: {column}" for name in found for column in ("β", "−ln L", "sufficient for"))]
    rows = [head, ["---"] * len(head)]
    for measure, label in NAMES.items():
        row = [label]
        for compared in found.values():
            one = compared.sel(measure=measure)
            p = one["p_value"].to_series().drop(measure)
            power = _POWERS.get(measure, 1)
            beta = float(one["dispersion"]) / power if power else np.nan
            fit = -float(one["log_likelihood"])
            others = ", ".join(NAMES[str(other)] for other in p.index[p > _ADDS_NOTHING])
            row += [f"{beta:.2f}" if np.isfinite(beta) else "–", f"{fit:.1f}", others or "–"]
        rows.append(row)
    rows.append(["best pair", *(cell for compared in found.values() for cell in _best_pair(compared))])
    rows.append(
        ["records not monotonic in PGA", *(cell for compared in found.values() for cell in _reversals(compared))]
    )
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)


def _best_pair(compared: xr.Dataset) -> tuple[str, str, str]:
    """Return dispersion, likelihood and names of the pair of measures that predicts best."""
    pair = compared["pair_log_likelihood"]
    first, second = (str(one) for one in pair.stack(both=("measure", "other")).dropna("both").idxmax().item())
    one = compared.sel(measure=first, other=second)
    exponent = float(one["pair_exponent"])
    return (
        f"{float(one['pair_dispersion']):.2f}",
        f"{-float(one['pair_log_likelihood']):.1f}",
        (f"{NAMES[first]} · {NAMES[second]}^{exponent:.2f}"),
    )


def _reversals(compared: xr.Dataset) -> tuple[str, str, str]:
    count = int(compared["reversed"].sel(measure="pga"))
    about = compared.attrs
    return (
        f"{count} of {about['records']}",
        f"{-about['unknown']:.1f} if unknown",
        (f"{about['runs_reached']} of {about['runs']} overturned"),
    )
