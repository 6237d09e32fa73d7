"""Rules of practice: a famous formula, published medians of contents, and counts beside simulations of columns."""

from collections.abc import Iterator

import numpy as np

import stylobate as sb
from stylobate.practice import Shaking, fema_contents, housner_half_sine

from .finding import Finding, Kind

_FEMA = "FEMA P-58, second edition"
_INCH = 0.0254
_CONTENTS = {
    "bookcase, 2 shelves": (12.625, 29.0, 0.724),
    "bookcase, 3 shelves": (12.625, 41.0, 0.493),
    "bookcase, 4 shelves": (12.625, 56.0, 0.361),
    "bookcase, 5 shelves": (12.625, 71.0, 0.290),
    "bookcase, 6 shelves": (12.625, 81.25, 0.251),
    "vertical filing cabinet, 2 drawers": (15.0, 24.0, 1.229),
    "vertical filing cabinet, 4 drawers": (15.0, 52.0, 0.498),
    "lateral filing cabinet, 4 drawers": (18.6, 52.5, 0.688),
    "lateral filing cabinet, 5 drawers": (18.6, 67.75, 0.526),
}
"""Depth and height [in], and median peak floor velocity of overturning [m/s]."""
_SEED, _COLUMNS, _DIRECTIONS = 20261128, 30, 12
_SCALES = np.geomspace(0.1, 3.0, 16)


def findings() -> Iterator[Finding]:
    """Yield all comparisons of this part."""
    yield from _half_sine()
    yield from _contents()
    yield from _counts()


def _half_sine() -> Iterator[Finding]:
    slender = sb.Column.dimensionless(slenderness=1e-3)
    housner = housner_half_sine(slender, acceleration=1.0, angular_frequency=2.0 * slender.frequency_parameter)
    exact = float(sb.theory.half_sine_overturning(2.0, 1.0))
    source = "G. W. Housner, Bull. Seism. Soc. Am. 53 (1963)"
    yield Finding(
        source,
        "half sine that overturns a slender block, ω/p = 2, a/(α g)",
        housner.capacity / slender.slenderness,
        exact,
        Kind.RULE,
        remark="his formula is unconservative",
    )
    low, high = 1.7, 1.9
    for _ in range(24):
        middle = 0.5 * (low + high)
        pulse = sb.Pulse.half_sine(acceleration=1e-3 * middle, angular_frequency=2.0)
        fell = sb.simulate(sb.Slender(slender), pulse, rtol=1e-11).outcome is sb.Outcome.OVERTURNED
        low, high = (low, middle) if fell else (middle, high)
    compared = "the same, closed form of the escape condition and bisected runs"
    yield Finding("J. Zhang and N. Makris, J. Eng. Mech. 127 (2001)", compared, exact, low, Kind.MATHEMATICS)


def _contents() -> Iterator[Finding]:
    record = sb.sample_record("el centro 1940 corrected")
    directions = np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    lines = {f"{angle:.3f}": _along(record, float(angle)) for angle in directions}
    speed = np.array([Shaking.of(line).peak_velocity for line in lines.values()])
    scales = np.geomspace(0.2, 12.0, 120)
    for name, (depth, height, theirs) in _CONTENTS.items():
        block = sb.PlanarRocking.block(width=depth * _INCH, height=height * _INCH, density=500.0)
        fit = fema_contents(block.column, Shaking.of(record)).capacity
        runs = sb.earthquakes.incremental_dynamic_analysis(block, lines, scales=scales)
        fell = runs["reached"].sel(limit_state="overturning").to_numpy() == 1
        planar = float(np.median(speed * scales[fell.argmax(axis=1)]))
        yield Finding(
            _FEMA,
            f"{name}: median overturning velocity and 2.83 b^1.5/h [m/s]",
            theirs,
            fit,
            Kind.RULE,
            remark="fitted to these nine medians; planar block under El Centro in "
            f"{_DIRECTIONS} directions: {planar:.2f}",
        )


def _along(record: sb.Record, angle: float) -> sb.Record:
    turned = record.rotated(-angle)
    return sb.Record(samples=turned.samples * [1.0, 0.0, 0.0], step=record.step)


def _counts() -> Iterator[Finding]:
    random = np.random.default_rng(_SEED)
    heights = np.exp(random.uniform(np.log(0.5), np.log(12.0), _COLUMNS))
    slenderness = random.uniform(0.08, 0.3, _COLUMNS)
    models = {}
    for place, (height, c) in enumerate(zip(heights, slenderness, strict=True)):
        column = sb.Column.solid(radius=0.5 * c * height, height=height, density=2700.0)
        models[str(place)] = sb.Wobbling(column, damping=column.housner_damping())
    record = sb.sample_record("el centro 1940 corrected")
    found = sb.earthquakes.compare_rules(models, record, scales=_SCALES, progress=False)
    decided = int(found["decided"].sum())
    sample = f"{_COLUMNS} columns, {_SCALES.size} scales of El Centro"
    for rule in found["rule"].to_numpy():
        of_rule = found.sel(rule=rule)
        right, unsafe, strict = (int(of_rule[name].sum()) for name in ("right", "unsafe", "strict"))
        yield Finding(
            str(of_rule["source"].item()),
            f"{rule}: answers equal to the simulation, {sample}",
            decided,
            right,
            Kind.RULE,
            remark=f"unsafe {unsafe}, needlessly strict {strict}",
        )
