"""The verdict on one column in one line, and the outcomes of its runs by record on which it rests."""

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.inputs import OTHER_LAW
from stylobate.earthquakes.assessment.margins import states_at_scales
from stylobate.earthquakes.assessment.report.wording import (
    CENTRAL,
    OVERTURNED,
    STOOD,
    UNDECIDED,
    at_most,
    listed,
    near_share,
    number,
    records,
    stated_friction,
)
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import VerdictWord, percent

NO_COMPONENT = "none in the record"
"""Cell of a vertical component that a record does not have."""

_ACTS = "with"
_NO_VERTICAL = ", no vertical"
_EXTRA = ("dissipation", "vertical")


@dataclass(frozen=True, slots=True, kw_only=True)
class Cases:
    """Outcomes of the runs on one column at one scale, as names of records.

    Attributes
    ----------
    records
        All records.
    overturned, undecided
        Records that overturned the column, or left it undecided, in the central case: central dissipation, vertical
        component included.
    none_decided
        Whether no run was decided.
    at_other_dissipation
        Records that overturned the column at another dissipation only (vertical component included), with the levels.
    without_vertical
        Records that overturned the column only without their vertical component, with the levels of dissipation.
    undecided_elsewhere
        Records with an undecided run in another case.
    with_other_law
        Records that overturned the column with the other contact law only, with the levels of dissipation.
    in_band
        Records with an overturning scale within 10 %, with the largest share of such scales of all cases; 0 if only
        scales between the 41 counted ones overturned the column.
    varied
        Records under which some small variation overturned the column, with the share of variations.
    variations_open
        Records with a small variation that was not decided.
    borderline
        Records with a run that is numerically uncertain: rounding or the rest threshold could alter its outcome.
    settled
        Records under which small variations decide that the column stands: the interval of their share lies below 5 %.
    slipping
        Records with a run that needed more than the stated friction, with the largest friction needed.
    """

    records: tuple[str, ...]
    overturned: tuple[str, ...]
    undecided: tuple[str, ...]
    none_decided: bool
    at_other_dissipation: dict[str, tuple[str, ...]]
    without_vertical: dict[str, tuple[str, ...]]
    undecided_elsewhere: tuple[str, ...]
    with_other_law: dict[str, tuple[str, ...]]
    in_band: dict[str, float]
    varied: dict[str, float]
    variations_open: tuple[str, ...]
    borderline: tuple[str, ...]
    settled: tuple[str, ...]
    slipping: dict[str, float]

    @property
    def stood(self) -> tuple[str, ...]:
        """Records that did not overturn the column in the central case."""
        return tuple(name for name in self.records if name not in (*self.overturned, *self.undecided))


def cases_of(assessment: Assessment, column: str, scale: float) -> Cases:
    """Collect the outcomes of the runs on a column at a scale."""
    runs = assessment.data["verdicts"].sel(column=column, scale=scale)
    central = runs["overturned"].sel(dissipation=CENTRAL, vertical=_ACTS)
    overturned, undecided = _where(central == 1), _where(central < 0)
    fallen = runs["overturned"] == 1
    at_other = _levels(fallen.sel(vertical=_ACTS), overturned)
    others = runs["overturned"]
    varied, variations_open, settled = _under_variations(assessment, column, scale)
    return Cases(
        records=_names(runs),
        overturned=overturned,
        undecided=undecided,
        none_decided=bool((others < 0).all()),
        at_other_dissipation=at_other,
        without_vertical=_levels(fallen.any("vertical"), (*overturned, *at_other)),
        undecided_elsewhere=tuple(name for name in _where(_any(others < 0)) if name not in undecided),
        with_other_law=_with_other_law(assessment, column, scale, (*overturned, *at_other)),
        in_band=_in_band(assessment, column, scale),
        varied=varied,
        variations_open=variations_open,
        borderline=_where(_any(runs["uncertain"] > 0)),
        settled=settled,
        slipping=_above(runs["friction_demand"].max(_EXTRA), stated_friction(assessment, column)),
    )


def case_name(level: str, vertical: str) -> str:
    """Return the name of a case: a level of dissipation, with the vertical component or without."""
    return level if vertical == _ACTS else f"{level}{_NO_VERTICAL}"


def acts_in(assessment: Assessment, record: str, case: str) -> bool:
    """Return whether a case applies to a record: the case without vertical component needs a record with one."""
    return rises(assessment, record) or not case.endswith(_NO_VERTICAL)


def rises(assessment: Assessment, record: str) -> bool:
    """Return whether a record has a vertical component."""
    return float(assessment.data["records"]["peak_acceleration_z"].sel(record=record)) > 0.0


def _names(data: xr.Dataset | xr.DataArray) -> tuple[str, ...]:
    return tuple(str(name) for name in np.atleast_1d(data["record"].to_numpy()))


def _where(flags: xr.DataArray) -> tuple[str, ...]:
    return tuple(name for name, flag in zip(_names(flags), flags.to_numpy(), strict=True) if flag)


def _any(flags: xr.DataArray) -> xr.DataArray:
    return flags.any([dim for dim in flags.dims if dim != "record"])


def _levels(fallen: xr.DataArray, known: tuple[str, ...]) -> dict[str, tuple[str, ...]]:
    """Map each record that is not `known` to the levels of dissipation at which it overturned the column."""
    levels = [str(level) for level in fallen["dissipation"].to_numpy()]
    flags = fallen.transpose("record", "dissipation").to_numpy()
    found = {
        name: tuple(level for level, flag in zip(levels, row, strict=True) if flag)
        for name, row in zip(_names(fallen), flags, strict=True)
    }
    return {name: at for name, at in found.items() if at and name not in known}


def _with_other_law(
    assessment: Assessment, column: str, scale: float, known: tuple[str, ...]
) -> dict[str, tuple[str, ...]]:
    """Map each record that is not `known` to the levels at which it overturned the column with the other law."""
    margins = assessment.data["margins"].sel(column=column)
    cases = [str(name) for name in margins["case"].to_numpy() if str(name).endswith(OTHER_LAW)]
    fallen = states_at_scales(margins, xr.DataArray([scale], dims="scale")).isel(scale=0) == 1
    found: dict[str, tuple[str, ...]] = {}
    for name in _names(margins):
        at = [case.removesuffix(OTHER_LAW) for case in cases if bool(fallen.sel(record=name, case=case))]
        if at and name not in known:
            found[name] = tuple(at)
    return found


def _in_band(assessment: Assessment, column: str, scale: float) -> dict[str, float]:
    margins = assessment.data["margins"][["band_share", "in_band"]].sel(column=column, scale=scale)
    share, found = margins["band_share"].max("case").fillna(0.0), _where((margins["in_band"] > 0).any("case"))
    return {name: float(share.sel(record=name)) for name in found}


def _under_variations(
    assessment: Assessment, column: str, scale: float
) -> tuple[dict[str, float], tuple[str, ...], tuple[str, ...]]:
    """Return `varied`, `variations_open` and `settled` of `Cases`, all empty if nothing was varied."""
    if "variations" not in assessment.data:
        return {}, (), ()
    own = assessment.data["variations"].sel(column=column, scale=scale)
    return _above(own["share"], 0.0), _where(own["open"] > 0), _where(own["word"] == VerdictWord.STANDS.value)


def _above(values: xr.DataArray, limit: float) -> dict[str, float]:
    """Map the records whose value lies above `limit` to their values."""
    return {name: float(one) for name, one in zip(_names(values), values.to_numpy(), strict=True) if one > limit}


# Factor of the highest scale within 10 %, less rounding.
_HIGHEST = 1.1 * (1.0 - 1e-9)
_SLID = {1: OVERTURNED, -1: f"was {UNDECIDED}", 0: STOOD}


class VerdictClass(Enum):
    """The classes of verdicts; the value is its label in the report."""

    OVERTURNED = "NOT shown safe"
    OPEN = "Survival NOT robust"
    SURVIVED = "Survived every run"
    SLIDES = "Slides before it rocks"
    NOT_DESCRIBED = "Not described by these runs"


@dataclass(frozen=True, slots=True)
class ColumnVerdict:
    """A verdict: its class and one sentence or two."""

    verdict: VerdictClass
    sentence: str

    @property
    def describes(self) -> bool:
        """Whether the runs without slip describe the column."""
        return self.verdict not in (VerdictClass.SLIDES, VerdictClass.NOT_DESCRIBED)

    @property
    def line(self) -> str:
        """Label and sentence together."""
        return f"{self.verdict.value}: {self.sentence}"


def recorded_scale(assessment: Assessment) -> float:
    """Return the stated scale nearest to 1: the scale of the first verdicts."""
    return float(min(assessment.setting["scales"], key=lambda scale: abs(math.log(scale))))


def level_words(scale: float) -> str:
    """Return a scale in words."""
    return "at the recorded level" if scale == 1.0 else f"at {scale:g} times the recorded level"


def slides_at(assessment: Assessment, column: str, scale: float) -> bool:
    """Return whether a column slides before it rocks under some record at a scale: runs without slip do not hold."""
    return bool((assessment.data["margins"]["standing_slip"].sel(column=column) <= scale).any())


def column_verdict(assessment: Assessment, column: str, scale: float) -> ColumnVerdict:
    """Return the verdict on a column at a scale."""
    cases, where = cases_of(assessment, column, scale), level_words(scale)
    total = len(cases.records)
    if slides := _slides_first(assessment, column, scale):
        return ColumnVerdict(VerdictClass.SLIDES, slides)
    if cases.overturned or cases.at_other_dissipation or cases.with_other_law:
        return ColumnVerdict(VerdictClass.OVERTURNED, _overturned(cases, where))
    if cases.none_decided:
        return ColumnVerdict(VerdictClass.NOT_DESCRIBED, f"no run {where} was decided.")
    doubts = _reservations(assessment, column, scale, cases)
    survived = f"did not overturn {where} under {records(len(cases.stood), total)}"
    if doubts:
        sentence = f"{survived} at {CENTRAL} dissipation. Reservations: {'; '.join(doubts)}."
        return ColumnVerdict(VerdictClass.OPEN, sentence)
    tried = int(assessment.setting["variations"])
    laws = ", with both contact laws" if assessment.setting["contact_laws"] else ""
    sentence = (
        f"{survived}, at every stated dissipation{laws}, at every scale tried within 10 % and under each of {tried} "
        "small variations."
    )
    return ColumnVerdict(VerdictClass.SURVIVED, sentence)


def _overturned(cases: Cases, where: str) -> str:
    """List the records that overturned a column at any stated dissipation."""
    total, phrases = len(cases.records), []
    if cases.overturned:
        phrases.append(f"under {records(len(cases.overturned), total)} ({listed(cases.overturned)})")
    if cases.at_other_dissipation:
        names = [f"{name} at {listed(levels, 'and')}" for name, levels in cases.at_other_dissipation.items()]
        count = len(names)
        more = f"{count} more" if cases.overturned else records(count, total)
        phrases.append(f"under {more}, but not at central dissipation ({listed(names)})")
    if cases.with_other_law:
        names = [f"{name} at {listed(levels, 'and')}" for name, levels in cases.with_other_law.items()]
        phrases.append(f"under {records(len(names), total)} with the other contact law only ({listed(names)})")
    undecided = f" Not decided: {listed(cases.undecided)}." if cases.undecided else ""
    if cases.slipping:
        need = number(max(cases.slipping.values()))
        under = listed(tuple(cases.slipping))
        undecided += f" Under {under} it needs a friction of {need}, more than stated: its base would slip."
    return f"overturned {where} {listed(phrases, 'and')}.{_shares(cases)}{undecided}"


def _shares(cases: Cases) -> str:
    """State the largest share of small variations that overturn the column; empty if there are none."""
    if not cases.varied:
        return ""
    record = max(cases.varied, key=lambda name: cases.varied[name])
    up_to = "Up to " if len(cases.varied) > 1 else ""
    return f" {up_to}{percent(cases.varied[record])} of the small variations overturn it ({record})."


def least_overturning_scale(assessment: Assessment, column: str) -> str:
    """State the smallest overturning scale of a column over all cases, or the largest decided scale, in a sentence."""
    least, words = _least(assessment, column)
    decided, highest = largest_decided(assessment, column), float(assessment.setting["margin_scales"][1])
    if math.isnan(decided):
        found = "No decided run overturned it" if math.isnan(least) else f"Overturned at scale {words} or below"
        return f"{found}; some run at the smallest scale was not decided."
    known = decided >= (highest if math.isnan(least) else least)
    open_scales = "" if known else f"; not every scale above {number(decided)} was decided"
    if math.isnan(least):
        return f"No scale up to {number(decided)} overturned it in any case{open_scales}."
    return f"Smallest overturning scale of all cases: at most {words}{open_scales}."


def _least(assessment: Assessment, column: str) -> tuple[float, str]:
    """Return the smallest overturning scale of a column over all cases, and its words; NaN if none overturned it."""
    least = assessment.data["margins"]["least_overturning"].sel(column=column).transpose("case", "record")
    if bool(least.isnull().all()):
        return math.nan, ""
    case, record = np.unravel_index(int(np.nanargmin(least.to_numpy())), least.shape)
    level, _, rest = str(least["case"].to_numpy()[case]).partition(",")
    where = f"{level} dissipation{',' if rest else ''}{rest}"
    scale = float(least.min())
    return scale, f"{at_most(scale)} ({least['record'].to_numpy()[record]}, {where})"


def largest_decided(assessment: Assessment, column: str, record: str | None = None, case: str | None = None) -> float:
    """Return the largest scale up to which every run of the margin was decided; NaN if the first scale was not."""
    margins = assessment.data["margins"].sel(column=column)
    chosen = {name: value for name, value in (("record", record), ("case", case)) if value is not None}
    return float(margins["decided_to"].sel(chosen).min(skipna=False))


def _slides_first(assessment: Assessment, column: str, scale: float) -> str:
    """Explain why a column slides before it rocks; empty if it does not, or if no record makes it slide."""
    slips = (assessment.data["margins"]["standing_slip"].sel(column=column) <= scale).any("case")
    sliding = [str(name) for name in slips["record"].to_numpy()[slips.to_numpy()]]
    if not sliding:
        return ""
    own, total = assessment.data["columns"].sel(column=column), slips.sizes["record"]
    friction, slenderness = float(own["friction_coefficient"]), float(own["slenderness"])
    computed = "sliding" in assessment.data
    answer = (
        f"{_slid(assessment, column, scale)}{_slip_varied(assessment, column, scale)}"
        f"{_limits_reached(assessment, column, scale)}"
        if computed
        else " Runs without slip do not describe it. Set sliding = true to compute its slip."
    )
    return (
        f"μ = {number(friction)} < r/h = {number(slenderness)}. Horizontal accelerations above about "
        f"{number(friction)} g make it slide; {level_words(scale)} this happens under {records(len(sliding), total)} "
        f"({listed(sliding)}).{answer}"
    )


def _slid(assessment: Assessment, column: str, scale: float) -> str:
    """State the outcomes of a column that slides."""
    runs = assessment.data["sliding"].sel(column=column, scale=scale)
    names = runs["record"].to_numpy().astype(str)
    by_state = [(words, names[runs["overturned"].to_numpy() == state]) for state, words in _SLID.items()]
    found = [
        words if some.size == names.size and words == STOOD else f"{words} under {listed(some.tolist())}"
        for words, some in by_state
        if some.size
    ]
    most = float(runs["peak_slip"].max())
    slid = [] if math.isnan(most) else [f"and slid by up to {number(1000.0 * most)} mm"]
    doubtful = names[runs["uncertain"].to_numpy() == 1].tolist()
    doubt = f" Rounding or the rest threshold could alter the outcome under {listed(doubtful)}." if doubtful else ""
    return f" With the sliding model it {', '.join([*found, *slid])}.{doubt}"


def _slip_varied(assessment: Assessment, column: str, scale: float) -> str:
    """State the interval of the largest slip under small variations, and the residual; empty if none was varied."""
    runs = assessment.data["sliding"].sel(column=column, scale=scale)
    if "peak_slip_low" not in runs or not bool((runs["known_variations"] > 0).any()):
        return ""
    phrases = []
    for name, verb in (("peak_slip", "slide"), ("residual_slip", "end")):
        median = runs[f"{name}_median"]
        one = runs.isel(record=int(median.fillna(-1.0).argmax("record")))
        low, high = (number(1000.0 * float(one[f"{name}_{end}"])) for end in ("low", "high"))
        where = "" if name == "peak_slip" else " from its start"
        phrases.append(
            f"it {verb}s {'by ' if verb == 'slide' else ''}{low} to {high} mm{where} ({one['record'].item()})"
        )
    rocks = share_that_rocks(assessment, column, scale)
    left = (
        f" In {percent(rocks)} of the variations friction reaches r/h: they are left out here, and the column may then "
        "rock as runs without slip describe it."
        if rocks > 0.0
        else ""
    )
    return f" Under 90 % of the small variations of record and friction {listed(phrases, 'and')}.{left}"


def share_that_rocks(assessment: Assessment, column: str, scale: float) -> float:
    """Return the share of the small variations whose friction reaches r/h, so that the column need not slide first."""
    known = assessment.data["sliding"]["known_variations"].sel(column=column, scale=scale)
    total = int(assessment.setting["variations"])
    return 1.0 - float(known.max()) / total if total else 0.0


def _limits_reached(assessment: Assessment, column: str, scale: float) -> str:
    """State for each limit state of a column that slides whether it is kept; empty without limit states."""
    runs = assessment.data["sliding"].sel(column=column, scale=scale)
    stated = [one["name"] for one in assessment.setting.get("limit_states", {}).get(column, ())]
    if "reached" not in runs or not stated:
        return ""
    phrases = []
    for name in stated:
        own = runs.sel(limit_state=name)
        state = own["reached"].to_numpy()
        share = float(own["reached_share"].fillna(0.0).max())
        varied = f", and in up to {percent(share)} of the small variations" if share > 0.0 else ""
        unknown = f", not known under {listed(_where(own['reached'] < 0))}" if (state < 0).any() else ""
        if (state == 1).any():
            phrases.append(f"{name} reached under {listed(_where(own['reached'] == 1))}{varied}{unknown}")
        else:
            phrases.append(f"{name} not reached{varied.replace(', and', ', but')}{unknown}")
    return f" Limit states: {'; '.join(phrases)}."


def _reservations(assessment: Assessment, column: str, scale: float, cases: Cases) -> list[str]:
    """List the reservations about the survival of a column, one phrase each."""
    least, words = _least(assessment, column)
    decided = largest_decided(assessment, column)
    undecided = (*cases.undecided, *cases.undecided_elsewhere)
    need = number(max(cases.slipping.values(), default=math.nan))
    under = {
        "not decided under {}": cases.undecided,
        "overturned under {} without the vertical component": tuple(cases.without_vertical),
        "a scale within 10 % overturned it under {}": [
            f"{name} ({near_share(share)})" for name, share in cases.in_band.items()
        ],
        "small variations overturned it under {}": [
            f"{name} ({percent(share)} of them)" for name, share in cases.varied.items()
        ],
        "a small variation was not decided under {}": [one for one in cases.variations_open if one not in undecided],
        "some run was not decided under {}": cases.undecided_elsewhere,
        "rounding or the rest threshold could alter the outcome under {}": [
            name for name in cases.borderline if name not in cases.settled
        ],
        f"the base would slip under {{}} (friction {need} needed)": tuple(cases.slipping),
    }
    holds = {
        f"a smaller scale overturned it: {words}": least < scale,
        f"not every scale up to this one was decided{_beyond(decided)}": not decided >= scale,
        f"not every scale within 10 % was decided{_beyond(decided)}": scale <= decided < _HIGHEST * scale,
        "small variations were not tried": "variations" not in assessment.data,
        "the friction needed was not computed": not assessment.setting["contact"],
    }
    named = [phrase.format(listed(names)) for phrase, names in under.items() if names]
    return [*named, *(phrase for phrase, is_so in holds.items() if is_so)]


def _beyond(decided: float) -> str:
    """Return the largest decided scale in parentheses; empty if the first scale was not decided."""
    return "" if math.isnan(decided) else f" (only up to {number(decided)})"
