"""Words, numbers and displacements of an assessment report: verdicts without promises, three significant digits."""

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import product

import numpy as np
import xarray as xr

from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.earthquakes.figures.overturning_intervals import undecided_reasons
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import percent

CENTRAL = "central"
TOO_FEW = "too few records"
OVERTURNING = "overturning"
"""Name of the limit state."""
OVERTURNED, STOOD, UNDECIDED = "overturned", "did not overturn", "not decided"
_MOST_NAMES = 8
# A relative difference of the size of rounding does not raise the last digit of an upper bound.
_ROUNDING = 1e-12
_OF_STATE = {1: OVERTURNED, 0: STOOD, -1: UNDECIDED}


def verdict(state: float) -> str:
    """Return the words for the state of a run: 1 overturned, 0 did not overturn, −1 undecided."""
    return _OF_STATE[int(state)]


def number(value: float, digits: int = 3) -> str:
    """Format a number with `digits` significant digits; a dash for NaN."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞"
    return f"{value:.{digits}g}"


# Digits of a scale that a bisection bounds, by default to within 0.5 %.
_OF_A_BOUND = 3


def at_most(value: float) -> str:
    """Format an upper bound with three significant digits, rounded up; a dash for NaN.

    >>> at_most(0.77251), at_most(0.7725), at_most(0.772)
    ('0.773', '0.773', '0.772')
    """
    return _rounded(value, lambda parts: math.ceil(parts * (1.0 - _ROUNDING)))


def at_least(value: float) -> str:
    """Format a lower bound with three significant digits, rounded down; a dash for NaN.

    >>> at_least(0.77251), at_least(0.772)
    ('0.772', '0.772')
    """
    return _rounded(value, lambda parts: math.floor(parts * (1.0 + _ROUNDING)))


def _rounded(value: float, rounding: Callable[[float], int]) -> str:
    if not math.isfinite(value) or value <= 0.0:
        return number(value)
    step = 10.0 ** (math.floor(math.log10(value)) + 1 - _OF_A_BOUND)
    return number(rounding(value / step) * step, _OF_A_BOUND)


def tilt(value: float) -> str:
    """Format a peak tilt over α_c; infinity means overturned."""
    return OVERTURNED if math.isinf(value) else number(value)


def least_scale(margins: xr.Dataset) -> str:
    """State the smallest overturning scale of one column, case and record, and the next smaller run that survived."""
    if int(margins["intervals"]) == 0:
        if undecided := _undecided_scales(margins):
            return f"none found; {undecided}"
        return f"none up to {number(float(margins['margin_scale'][-1]))}"
    found, below = float(margins["least_overturning"]), float(margins["largest_below"])
    if not math.isnan(below):
        return f"at most {at_most(found)} (not at {at_least(below)})"
    if bool(margins["undecided_below"][0]):
        return f"at most {at_most(found)} (not decided just below)"
    return f"at most {at_most(found)}"


def intervals(margins: xr.Dataset) -> str:
    """List the overturning intervals of one column, case and record, and the undecided scales."""
    names = ("interval_from", "interval_to", "open_below", "open_above", "undecided_below", "undecided_above")
    found = []
    for low, high, below, above, unknown_below, unknown_above in zip(
        *(margins[name].to_numpy() for name in names), strict=True
    ):
        if math.isnan(low):
            continue
        ends = [number(low, 4), number(high, 4)]
        words = ends[0] if ends[0] == ends[1] else " to ".join(ends)
        words += " and below" * bool(below and not unknown_below) + " and beyond" * bool(above and not unknown_above)
        found.append(words)
    undecided = _undecided_scales(margins)
    return "; ".join([*(found or ["none found" if undecided else "none"]), *([undecided] if undecided else [])])


def _undecided_scales(margins: xr.Dataset) -> str:
    """List the undecided scales of one column, case and record, with the reasons; empty if there are none."""
    pairs = zip(margins["undecided_from"].to_numpy(), margins["undecided_to"].to_numpy(), strict=True)
    stretches = [f"{number(low, 4)} to {number(high, 4)}" for low, high in pairs if not math.isnan(low)]
    if not stretches:
        return ""
    return f"not decided from {' and from '.join(stretches)} ({', '.join(undecided_reasons(margins['outcome']))})"


def listed(names: Sequence[str], last: str = "") -> str:
    """Join at most eight names with commas; the word `last` stands before the last name.

    >>> listed(("low", "high"), "and")
    'low and high'
    """
    shown = [*names[:_MOST_NAMES], *([f"{len(names) - _MOST_NAMES} more"] if len(names) > _MOST_NAMES else [])]
    if last and len(shown) > 1:
        return f"{', '.join(shown[:-1])} {last} {shown[-1]}"
    return ", ".join(shown)


def in_g(acceleration: float) -> str:
    """Format an acceleration [m/s²] in g."""
    return number(acceleration / STANDARD_GRAVITY)


def scales(values: np.ndarray) -> str:
    """Format scale factors."""
    return ", ".join(f"{value:g}" for value in values)


def degrees(angle: float) -> str:
    """Format an azimuth [rad] in degrees from x."""
    return "–" if math.isnan(angle) else f"{math.degrees(angle) % 360.0:.0f}°"


def near_share(share: float) -> str:
    """State the share of the scales within 10 % that overturned a column; 0 if only scales between them did."""
    return f"{percent(share)} of 41" if share > 0.0 else "an interval between them"


def records(count: int, total: int) -> str:
    """State a number of records in words."""
    if total == 1:
        return "the one record" if count == 1 else "not the one record"
    if count == total:
        return f"all {total} records"
    return f"{count} of {total} records"


_MM = 1000.0
SMALLEST_TILT = 1e-3
"""Smallest tilt over α_c that is worth a figure."""
# Smallest tilt over α_c, tilt [°] and displacement [mm] that are shown as numbers; smaller ones are shown as "< …".
_LEAST = (SMALLEST_TILT, 0.01, 0.1)
TILT_HEADER = ("tilt / α_c", "tilt [°]", "displacement [mm]")


def displacement(angle: float, *, radius: float, height: float) -> float:
    """Compute the horizontal displacement of a point of the axis, relative to the base [m].

    The column stands on its rim and the contact point does not move. A point at the height H of the axis then moves
    by H sin θ + r (1 − cos θ), for any direction of the tilt θ.

    Parameters
    ----------
    angle
        Tilt θ [rad].
    radius, height
        Base radius r, height H of the point above the base [m].
    """
    return height * math.sin(angle) + radius * (1.0 - math.cos(angle))


def shown_point(column: xr.Dataset) -> tuple[float, str]:
    """Return height [m] and name of the displaced point: the top, or the centre of mass if the height is unknown."""
    height = float(column["height"])
    return (float(column["mass_height"]), "centre of mass") if math.isnan(height) else (height, "top")


def tilt_cells(ratio: float, column: xr.Dataset) -> tuple[str, str, str]:
    """Format a peak tilt as a fraction of α_c, in degrees, and as the displacement of the shown point in mm."""
    if not math.isfinite(ratio):
        return tilt(ratio), "–", "–"
    angle = ratio * float(column["tipping_angle"])
    moved = displacement(angle, radius=float(column["radius"]), height=shown_point(column)[0])
    fraction, degrees, millimetres = map(_at_least, (ratio, math.degrees(angle), _MM * moved), _LEAST)
    return fraction, degrees, millimetres


def _at_least(value: float, least: float) -> str:
    return f"< {least:g}" if 0.0 < value < least else number(value)


def tilt_words(ratio: float, column: xr.Dataset) -> str:
    """Describe a peak tilt in words."""
    fraction, angle, moved = tilt_cells(ratio, column)
    return f"{angle}° ({fraction} α_c), which displaces its {shown_point(column)[1]} by {moved} mm"


def labels(data: xr.Dataset | xr.DataArray, dim: str = "record") -> list[str]:
    """Return the labels of `data` along `dim` as text."""
    return [str(name) for name in data[dim].to_numpy()]


def counts(cell: xr.Dataset, *names: str) -> tuple[str, ...]:
    """Format the whole numbers of a cell."""
    return tuple(f"{int(cell[name])}" for name in names)


def numbers(cell: xr.Dataset, *names: str) -> tuple[str, ...]:
    """Format the numbers of a cell with three significant digits."""
    return tuple(number(float(cell[name])) for name in names)


def stated_friction(assessment: Assessment, column: str) -> float:
    """Return the stated friction coefficient of a column."""
    return float(assessment.setting["friction_coefficient"][column])


def cells(data: xr.Dataset, *dims: str) -> Iterator[tuple[tuple[str, ...], xr.Dataset]]:
    """Yield the labels of each cell over `dims` as text, and its data; the last dimension varies fastest."""
    for values in product(*(data[dim].to_numpy() for dim in dims)):
        labels = tuple(f"{value:g}" if dim == "scale" else str(value) for dim, value in zip(dims, values, strict=True))
        yield labels, data.sel(dict(zip(dims, values, strict=True)))


def cells_of(assessment: Assessment, part: str, *dims: str) -> Iterator[tuple[tuple[str, ...], xr.Dataset]]:
    """Yield the cells of a part of an assessment; none if it was not computed."""
    if part in assessment.data:
        yield from cells(assessment.data[part], *dims)


def how_to_read(assessment: Assessment) -> str:
    """Explain the meaning and the limits of a verdict."""
    repeated = (
        "Verdicts were therefore repeated under small variations: read their shares, not single runs."
        if assessment.setting["variations"]
        else "No verdict was repeated under small variations here, so it is not known whether any is repeatable."
    )
    return (
        "A verdict reports runs of a rigid column under these records only. “Did not overturn” does "
        "not prove that the column cannot overturn. Near the overturning limit, a single rocking run is barely "
        f"repeatable. {repeated}"
    )


ASSUMPTIONS: tuple[tuple[str, str], ...] = (
    ("body", "a rigid body of revolution in one piece, symmetric about its axis, on a flat circular base"),
    ("ground", "rigid, level and flat; the base acceleration acts on the whole footprint at once"),
    ("start", "upright and at rest, without cracks or wear of the rim"),
    (
        "contact",
        "the base does not slip, pivot freely or lift off; the section Contact demand lists the friction needed: "
        "compare it with the friction that the joint provides",
    ),
    ("dissipation", "as stated by the author of the study, at low, central and high levels; not measured or checked"),
    ("after the record", "the base stands still; the run continues for the stated free-vibration time"),
    ("scaled records", "one factor multiplies all components; the time axis does not change"),
    ("direction", "a round column on level ground has no weak direction: rotating the record only rotates the motion"),
)

NOT_COVERED: tuple[tuple[str, str], ...] = (
    ("several drums or blocks", "joints open and slide; the column is taken as one piece"),
    ("flexible soil and foundation", "rocking and uplift of the footing, amplification of the ground motion"),
    ("flexible superstructure", "a floor, pedestal or shaking building changes the record before it reaches the base"),
    ("sloshing liquid", "the liquid in a tank moves against its wall"),
    ("anchors, dowels, clamps", "they restrain the column until they break"),
    ("bases that are not circular", "square plinths, broken rims, feet"),
    ("contact that yields", "crushing of the edge, wear, mortar and lead beds"),
    ("neighbours", "impact against walls, other columns, an architrave on top"),
    ("other ground motions", "only the records listed were run; whether they represent the site is not judged here"),
)

SLIP_AND_FLIGHT: dict[bool, tuple[str, str]] = {
    False: ("slip and flight", "the sliding model (kind sliding) was not run: sliding = false"),
    True: (
        "slip and flight",
        "slip was computed only for columns that slide before they rock: on the whole base, and by the sliding model "
        "(kind sliding) at the central dissipation where the base falls faster than g; all other runs assume that the "
        "base neither slips nor lifts off",
    ),
}
"""Remark on slip and flight, by the option `sliding`."""

VERDICT_CLASSES: tuple[tuple[str, str], ...] = (
    (
        "NOT shown safe",
        "at least one record overturned the column at some stated dissipation, with the given or the other contact law",
    ),
    (
        "Survival NOT robust",
        "no record overturned it at any stated dissipation and contact law, but the vertical component, another scale "
        "within 10 % or below, a small variation, an undecided run or too little friction (with the "
        "given contact law) leaves the verdict open",
    ),
    (
        "Survived every run",
        "no record overturned it at any stated dissipation and contact law, at any scale tried within 10 %, or in any "
        "small variation; all runs were decided, and the stated friction suffices with the given contact law; a run "
        "whose outcome rounding could alter counts only if small variations do not settle the case",
    ),
    (
        "Slides before it rocks",
        "the stated friction is less than r/h, and a record makes the column slide; with sliding = true its slip, and "
        "whether it keeps the stated limits, are computed",
    ),
    ("Not described by these runs", "no run was decided"),
)

INTENSITIES = (
    "PGA, PGV and Sa (5 % damping) are RotD50: the median, over all horizontal directions, of the peak along a "
    "direction (Boore 2010). For a record along one axis they are the values of that component. “Vector” is the "
    "peak of the horizontal vector, which is never below RotD50. Compare hazard curves and design spectra with "
    "RotD50. A record drifts if its velocity at the end exceeds 5 % of its PGV along x, y or z."
)
"""Explanation of the intensities of records."""

TILT = (
    "The tipping angle α_c = arctan(r/h) is the tilt at which the centre of mass stands above the rim. The "
    "displacement is horizontal and relative to the base: H sin θ + r (1 − cos θ) for a tilt θ and a point of the "
    "axis at the height H, with the contact point at rest. H is the height of the column, or the height of the "
    "centre of mass if only that is known. The edge of a wide top can move farther."
)
"""Explanation of tilts and displacements."""

PLANAR = (
    "The usual calculation applies each horizontal component alone to a planar block, which loses energy at impacts "
    "by the formula of Housner (1963). It is shown for comparison; no verdict depends on it.",
    "The two calculations differ for this reason: a planar block hits the ground with its whole base in every half "
    "cycle, and each impact takes a fixed fraction of its energy. A round column under two components rolls on its rim "
    "and seldom passes through the vertical, so it has hardly any impacts. It loses energy only by the stated damping, "
    "a different mechanism from restitution. It can therefore reach several times the tilt of the planar block under "
    "the same record; for cylinders in three dimensions see Vassiliou et al. (2017). The comparison depends on the "
    "stated damping.",
    "A positive mean logarithm means that the column tilts more in three dimensions. The mean covers the records under "
    "which both columns rock by more than 0.001 α_c and neither overturns. The last columns of the table count the "
    "records under which only one of them overturns.",
)

RULES = (
    "Hand formulas and clauses for unanchored bodies, beside the simulation at central dissipation with the vertical "
    "component. No verdict depends on them. A rule of design is meant to be strict: it may call a column unsafe that "
    "survives. A cell such as 3 (2) / 1 (0) means that the rule calls 3 records unsafe, of which the column survives "
    "2, and 1 record safe, of which none overturns the column; without parentheses the column slides first. Where "
    "“clause checked” states no, the text of the clause was not compared: check it before quoting it."
)
"""Explanation of the rules of practice."""

REFERENCES: tuple[tuple[str, str], ...] = (
    (
        "rocking, planar block",
        "G. W. Housner, The behavior of inverted pendulum structures during earthquakes, Bull. Seismol. Soc. Am. 53, "
        "403–417, 1963",
    ),
    (
        "cylinders in three dimensions",
        "M. F. Vassiliou, S. Burger, M. Egger, J. A. Bachmann, M. Broccardo, B. Stojadinović, The three-dimensional "
        "behavior of inverted pendulum cylindrical structures during earthquakes, Earthquake Engng Struct. Dyn. 46, "
        "2261–2280, 2017",
    ),
    (
        "displacements of rocking bodies",
        "N. Reggiani Manzo, M. F. Vassiliou, Displacement-based analysis and design of rocking structures, Earthquake "
        "Engng Struct. Dyn. 48, 2019, doi 10.1002/eqe.3217",
    ),
    (
        "RotD50",
        "D. M. Boore, Orientation-independent, nongeometric-mean measures of seismic intensity from two horizontal "
        "components of motion, Bull. Seismol. Soc. Am. 100, 1830–1835, 2010",
    ),
    (
        "scaled records",
        "D. Vamvatsikos, C. A. Cornell, Incremental dynamic analysis, Earthquake Engng Struct. Dyn. 31, 491–514, 2002",
    ),
    (
        "rules of practice",
        "documentation of stylobate, page Rules of practice: the source of each formula and clause",
    ),
    (
        "equations of motion",
        "documentation of stylobate, pages Models and Equations: a rigid body whose rim rolls without slip, with "
        "viscous damping of the tilt",
    ),
    (
        "damping",
        "no published value is used: the author of the study stated the levels",
    ),
)
