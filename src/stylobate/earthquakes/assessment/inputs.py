"""Checked arguments of an assessment, and the store of its parts."""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any, Self, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BASE_AT_REST, BaseMotion, Record
from stylobate.compiler.machine import arithmetic
from stylobate.config.levels import OF_DISSIPATION, Dissipation, at_levels, levels_by_column
from stylobate.earthquakes.fragility.displacement_limits import (
    LimitState,
    LimitStates,
    Response,
    checked_limit_states,
)
from stylobate.earthquakes.study_inputs import Records, named_records
from stylobate.earthquakes.verdict_study import has_other_contact_law, with_other_contact_law
from stylobate.engine.parameters import changed_model, model_names
from stylobate.errors import ParameterError, require_name, require_not_negative, require_positive
from stylobate.models import Model
from stylobate.progress import Report
from stylobate.provenance import provenance_of_run
from stylobate.results.keyed_store import KeyedStore
from stylobate.run_arguments import RunOptions
from stylobate.studies.sweeps.designs import Floats
from stylobate.studies.sweeps.fingerprint import identity_of
from stylobate.text import did_you_mean

CENTRAL = "central"
NO_VERTICAL = "central, no vertical"
"""The case of margins in which the vertical component does not act."""
OTHER_LAW = ", other contact law"
"""End of the names of the cases with the other contact law."""

# Version of the layout of stored parts; a store of another layout is not read.
_LAYOUT = 4
# Scales that differ by less than this fraction count as equal.
_SAME_SCALE = 1e-9
# Factors of a stated scale near which the share of overturning scales is counted: 41 within 10 %.
_NEAR = np.linspace(0.9, 1.1, 41)


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """The checked arguments of an assessment.

    Parameters
    ----------
    columns
        Model of each column by name, at each level of dissipation.
    records
        Base motions by name, sorted.
    dissipation
        Dissipation parameters of each column at each level.
    friction
        Stated friction coefficient of each column.
    scales
        Scale factors at which verdicts are given.
    margin_scales
        Scale factors of the scan for margins, increasing; they include 41 within 10 % of each of the verdicts' scales.
    scan
        Scale factors of the scan as given, to which a fragility is fitted.
    width
        Relative width to which ends of overturning intervals are located.
    tail
        Free-vibration time after a record [s], by default 20/p.
    contact_laws
        Whether the other contact law is assessed too; False if a model has none.
    variations
        Number of small variations of each verdict; 0 for none.
    seed
        Seed of the small variations.
    least_records
        Minimum number of records for a fragility.
    options
        Options of all runs.
    limits
        Limit states of displacement of each column.
    friction_dispersion
        Standard deviation of the logarithm of the friction coefficient among small variations.
    """

    columns: Mapping[str, Mapping[str, Model]]
    records: Mapping[str, BaseMotion]
    dissipation: Mapping[str, Mapping[str, Mapping[str, float]]]
    friction: Mapping[str, float]
    scales: Floats
    margin_scales: Floats
    scan: Floats
    width: float
    tail: float | None
    contact_laws: bool
    variations: int
    seed: int
    least_records: int
    options: RunOptions
    limits: Mapping[str, tuple[LimitState, ...]] = field(default_factory=dict)
    friction_dispersion: float = 0.1

    @classmethod
    def of(
        cls,
        columns: Mapping[str, Model],
        records: Records,
        dissipation: Dissipation | None,
        friction_coefficient: float | Mapping[str, float] | None,
        scales: npt.ArrayLike,
        margin_scales: npt.ArrayLike,
        *,
        contact_laws: bool,
        limit_states: LimitStates = (),
        **more: Any,
    ) -> Self:
        """Check the arguments of an assessment; raise ParameterError for an invalid one."""
        if not isinstance(columns, Mapping) or not columns:
            raise ParameterError(f"columns must map names to models, at least one, got {columns!r}")
        for name in columns:
            require_name("columns: the name", name)
        levels = _checked_dissipation(dissipation, columns)
        stated = _rising("scales", scales, least=1)
        scan = _rising("margin_scales", margin_scales, least=2)
        return cls(
            columns={name: _at_levels(model, levels[name]) for name, model in columns.items()},
            records=dict(sorted(named_records(records).items())),
            dissipation=levels,
            friction=_frictions(friction_coefficient, list(columns)),
            scales=stated,
            margin_scales=_joined(scan, stated),
            scan=scan,
            limits=_limits(limit_states, columns),
            contact_laws=contact_laws and all(map(has_other_contact_law, columns.values())),
            **more,
        )

    @property
    def levels(self) -> tuple[str, ...]:
        """The names of the levels of dissipation."""
        return tuple(next(iter(self.dissipation.values())))

    @property
    def as_recorded(self) -> int:
        """Index of the scale nearest to 1."""
        return int(np.argmin(np.abs(np.log(self.scales))))

    @property
    def sliding_first(self) -> tuple[str, ...]:
        """The columns that slide before they rock: their friction is below c = r/h."""
        return tuple(
            name for name, levels in self.columns.items() if self.friction[name] < levels[CENTRAL].column.slenderness
        )

    @property
    def limit_names(self) -> tuple[str, ...]:
        """Names of the limit states of displacement of all columns."""
        return tuple(dict.fromkeys(one.name for limits in self.limits.values() for one in limits))

    @property
    def has_vertical(self) -> bool:
        """Whether some record has a vertical component."""
        return any(any(motion.vertical_range(0.0)) for motion in self.records.values())

    @property
    def cases(self) -> tuple[str, ...]:
        """Names of the cases of margins: levels, the central one without vertical component, the other contact law."""
        others = [f"{level}{OTHER_LAW}" for level in self.levels] if self.contact_laws else []
        return (*self.levels, *([NO_VERTICAL] if self.has_vertical else []), *others)

    def model_of(self, column: str, case: str) -> Model:
        """Return the model of a column in a case."""
        if case == NO_VERTICAL:
            return self.columns[column][CENTRAL]
        model = self.columns[column][case.removesuffix(OTHER_LAW)]
        return with_other_contact_law(model) if case.endswith(OTHER_LAW) else model

    def around(self, scale: float) -> npt.NDArray[np.intp]:
        """Return the places in `margin_scales` of the scales near a stated one, counted for `band_share`."""
        return self._places(scale * _NEAR)

    @property
    def scanned(self) -> npt.NDArray[np.intp]:
        """Places in `margin_scales` of the scan as given."""
        return self._places(self.scan)

    def _places(self, near: Floats) -> npt.NDArray[np.intp]:
        places = np.clip(np.searchsorted(self.margin_scales, near), 1, self.margin_scales.size - 1)
        before = near - self.margin_scales[places - 1] < self.margin_scales[places] - near
        return np.asarray(places - before, dtype=np.intp)

    def with_records(self, names: Sequence[str]) -> Self:
        """Return these inputs with the named records only."""
        return replace(self, records={name: self.records[name] for name in names})

    def identity(self, column: str, model: Model | None = None) -> dict[str, Any]:
        """Return the identity of the runs of a column: with one model, or at all levels."""
        chosen = self.columns[column] if model is None else {model.name: model}
        return {
            "version": version("stylobate"),
            "processor": arithmetic(),
            "layout": _LAYOUT,
            "models": {name: _as_values(model) for name, model in chosen.items()},
            "records": identities(self.records),
            "tail": self.tail,
            "options": repr(dict(self.options)),
        }


def _checked_dissipation(
    dissipation: Dissipation | None, columns: Mapping[str, Model]
) -> dict[str, dict[str, dict[str, float]]]:
    """Check the dissipation parameters of each column at each level; words become the numbers of the column.

    Raises
    ------
    ParameterError
        If low, central or high is missing, or the levels of a column state different parameters or none.
    """
    remedy = "State it for low, central and high, such as low = {damping = 0.04}"
    if not isinstance(dissipation, Mapping) or not dissipation:
        raise ParameterError(f"dissipation is missing: it decides the outcome of a three-dimensional column. {remedy}")
    return {
        name: _checked_levels(at_levels(levels, _three_dimensional(name, columns[name]).column), remedy)
        for name, levels in levels_by_column(dissipation, columns).items()
    }


def _checked_levels(levels: Mapping[str, Mapping[str, Any]], remedy: str) -> dict[str, dict[str, float]]:
    names = set(levels[CENTRAL])
    if not names or any(set(level) != names for level in levels.values()):
        given = ", ".join(f"{level} {' and '.join(sorted(numbers)) or 'nothing'}" for level, numbers in levels.items())
        raise ParameterError(f"dissipation must state the same parameters at each level, got {given}. {remedy}")
    unknown = sorted(names.difference(OF_DISSIPATION))
    if unknown:
        raise ParameterError(
            f"dissipation: {unknown[0]} is no parameter of dissipation. Use one of {', '.join(OF_DISSIPATION)}"
        )
    return {
        level: {name: require_not_negative(f"dissipation.{level}.{name}", value) for name, value in numbers.items()}
        for level, numbers in levels.items()
    }


def _three_dimensional(name: str, model: Model) -> Model:
    if not isinstance(model, Model) or model.planar_only:
        raise ParameterError(
            f"columns: {name!r} must be a three-dimensional model (got {model!r}). Use one such as Wobbling."
        )
    return model


def _at_levels(model: Model, levels: Mapping[str, Mapping[str, float]]) -> dict[str, Model]:
    lacking = [number for number in levels[CENTRAL] if number not in model_names(model)]
    if lacking:
        raise ParameterError(
            f"dissipation: the model {model.name} has no {lacking[0]}; leave it out or choose another model"
        )
    return {level: changed_model(model, numbers) for level, numbers in levels.items()}


def _frictions(given: float | Mapping[str, float] | None, columns: Sequence[str]) -> dict[str, float]:
    if given is None:
        raise ParameterError(
            "friction_coefficient is missing: the friction between column and base. State one number such as 0.6, or "
            "one for each column."
        )
    if not isinstance(given, Mapping):
        return dict.fromkeys(columns, require_positive("friction_coefficient", given))
    for name in (*given, *columns):
        if (name in given) != (name in columns):
            what = "is no column" if name in given else "has none; state one for each column"
            raise ParameterError(f"friction_coefficient: {name!r} {what}")
    return {name: require_positive(f"friction_coefficient.{name}", given[name]) for name in columns}


def _limits(given: LimitStates, columns: Mapping[str, Model]) -> dict[str, tuple[LimitState, ...]]:
    """Return the limit states of each column; neighbours have a height."""
    by_column = given if isinstance(given, Mapping) else dict.fromkeys(columns, given)
    for name in by_column:
        if name not in columns:
            remedy = did_you_mean(name, columns) or "leave it out"
            raise ParameterError(f"limit_states: {name!r} is no column; {remedy}")
    found = {name: checked_limit_states(by_column.get(name, ()), f"limit_states.{name}") for name in columns}
    for name, limits in found.items():
        for one in limits:
            if one.kind is Response.NEIGHBOURS:
                one.height_on(columns[name].column)
    return found


def _rising(name: str, values: npt.ArrayLike, *, least: int) -> Floats:
    try:
        array = np.atleast_1d(np.array(values, dtype=float))
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.ndim != 1 or array.size < least or not np.all(np.isfinite(array) & (array > 0.0)):
        raise ParameterError(f"{name} must be positive numbers, {least} or more, got {values!r}")
    return np.unique(array)


def _joined(scanned: Floats, stated: Floats) -> Floats:
    """Join the scales `scanned` with those near each stated one, so that margins, shares and verdicts agree."""
    rising = np.unique(np.concatenate([scanned, np.outer(stated, _NEAR).ravel()]))
    apart = np.diff(rising, prepend=0.0) > _SAME_SCALE * rising
    return np.asarray(rising[apart])


def _as_values(model: Model) -> dict[str, Any]:
    provenance = provenance_of_run(model, BASE_AT_REST)
    described = provenance["model"] if provenance["model"].get("kind") != "other" else identity_of(model)
    return {"column": provenance["column"], "model": described}


_log = logging.getLogger("stylobate")

Announce: TypeAlias = Callable[[str, int, int], None]
"""Called with the name of the part, the runs done and the total number of runs."""


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts of an assessment, computed or read from the folder `store`.

    Parameters
    ----------
    store
        Folder of the parts; None stores nothing.
    total
        Approximate number of runs of all parts.
    announce
        Called with the progress while a part is computed; runs of stored parts count as done.
    """

    store: Path | None
    total: int
    announce: Announce
    _done: list[int] = field(default_factory=list, init=False)
    _known: list[str] = field(default_factory=list, init=False)

    def get(
        self, name: str, runs: int, identity: Mapping[str, Any], compute: Callable[[Report], xr.Dataset]
    ) -> xr.Dataset:
        """Return the part `name` of about `runs` runs; compute it if the store has none of the same `identity`.

        Raises
        ------
        FileError
            If the store cannot be written.
        """
        before = sum(self._done)
        store = None if self.store is None else KeyedStore(self.store)
        stored = None if store is None else store.read(name, identity)
        if stored is not None:
            found = stored.to_dataset()
            self._known.append(name)
        else:
            if self._known and len(self._known) == len(self._done):  # the first part that is computed
                _log.info("%d parts were read from %s; the assessment resumes there", len(self._known), self.store)
            self.announce(name, before, self.total)
            found = compute(
                lambda done, total: self.announce(name, before + round(runs * done / max(total, 1)), self.total)
            )
            if store is not None:
                store.write(name, identity, found)
            self.announce(name, before + runs, self.total)
        self._done.append(runs)
        return found

    def report(self) -> None:
        """Log the number of parts that were read from the store, if any."""
        if self._known:
            _log.info(
                "%d of %d parts were read from %s and not computed again", len(self._known), len(self._done), self.store
            )


def identities(motions: Mapping[str, BaseMotion]) -> dict[str, Any]:
    """Return the identities of motions, by name."""
    return {
        name: motion.digest if isinstance(motion, Record) else identity_of(motion) for name, motion in motions.items()
    }
