"""Outcomes of the runs on one column at one scale, by record: the basis of every verdict."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.inputs import OTHER_LAW
from stylobate.earthquakes.assessment.report.wording import CENTRAL
from stylobate.errors import Outcome
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import VerdictWord

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
        varied=_varied(assessment, column, scale),
        variations_open=_variations_open(assessment, column, scale),
        borderline=_where(_any(runs["uncertain"] > 0)),
        settled=_settled(assessment, column, scale),
        slipping=_slipping(runs, float(assessment.setting["friction_coefficient"][column])),
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
    found: dict[str, tuple[str, ...]] = {}
    for name in _names(margins):
        states = margins["outcome"].sel(record=name, case=cases).sel(margin_scale=scale, method="nearest")
        at = [case.removesuffix(OTHER_LAW) for case in cases if int(states.sel(case=case)) == Outcome.OVERTURNED]
        if at and name not in known:
            found[name] = tuple(at)
    return found


def _in_band(assessment: Assessment, column: str, scale: float) -> dict[str, float]:
    margins = assessment.data["margins"][["band_share", "in_band"]].sel(column=column, scale=scale)
    share, found = margins["band_share"].max("case").fillna(0.0), _where((margins["in_band"] > 0).any("case"))
    return {name: float(share.sel(record=name)) for name in found}


def _varied(assessment: Assessment, column: str, scale: float) -> dict[str, float]:
    if "variations" not in assessment.data:
        return {}
    shares = assessment.data["variations"]["share"].sel(column=column, scale=scale)
    return {name: float(one) for name, one in zip(_names(shares), shares.to_numpy(), strict=True) if one > 0.0}


def _variations_open(assessment: Assessment, column: str, scale: float) -> tuple[str, ...]:
    if "variations" not in assessment.data:
        return ()
    return _where(assessment.data["variations"]["open"].sel(column=column, scale=scale) > 0)


def _settled(assessment: Assessment, column: str, scale: float) -> tuple[str, ...]:
    if "variations" not in assessment.data:
        return ()
    words = assessment.data["variations"]["word"].sel(column=column, scale=scale)
    return _where(words == VerdictWord.STANDS.value)


def _slipping(runs: xr.Dataset, stated: float) -> dict[str, float]:
    need = runs["friction_demand"].max([dim for dim in runs["friction_demand"].dims if dim in _EXTRA])
    return {name: float(one) for name, one in zip(_names(need), need.to_numpy(), strict=True) if one > stated}
