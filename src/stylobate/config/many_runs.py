"""Describe the case that many runs share: column, model, base motion, initial state, duration and tolerances."""

from collections.abc import Mapping, Sequence
from typing import Any, Self

from pydantic import Field

from stylobate.base_motions import BaseMotion
from stylobate.config.description import built
from stylobate.config.motions import is_to_end, made_by
from stylobate.config.run_numbers import fields_of, problems_of_the_numbers
from stylobate.config.simulation import (
    OF_OTHER_COMMANDS,
    Case,
    built_parts,
    built_rules,
    refuse_own_classes,
)
from stylobate.errors import ConfigError, ParameterError
from stylobate.kinds import with_places
from stylobate.models import Model
from stylobate.parameter_quantities import known_names
from stylobate.quantities import parameters_of
from stylobate.results import OutcomeRules
from stylobate.run_arguments import SharedByRuns, SingleRun, duration_with_tail, numbers_of
from stylobate.text import did_you_mean


class ManyRuns(fields_of(SharedByRuns), Case):  # type: ignore[misc]
    """The case that all runs share, with the argument names of `simulate_ensemble`.

    Parameters
    ----------
    column, model, motion
        Column, model and base motion.
    demands
        Whether to report the contact demand of each run.
    recheck
        Whether to repeat runs whose outcome rounding or the rest threshold could alter.
    rules
        Numbers of `OutcomeRules`, by name.
    """

    demands: bool = False
    recheck: bool = False
    rules: dict[str, float] = Field(default_factory=dict)

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; those of other commands are ignored."""
        of_others = {*OF_OTHER_COMMANDS, *numbers_of(SingleRun)} - set(cls.model_fields)
        return super().parse({name: value for name, value in values.items() if name not in of_others})

    def values(self) -> dict[str, Any]:
        """Return the description as plain values for JSON and TOML, without keys that are None."""
        return self.model_dump(mode="json", exclude_none=True, by_alias=True)

    def common(self, problems: list[str], varying: Sequence[str] = ()) -> tuple[Model, BaseMotion, dict[str, Any]]:
        """Build model, motion and the arguments that all runs share, except those `varying`.

        Raises
        ------
        ConfigError
            With one line for each invalid part, and the `problems` known before.
        """
        problems += problems_of_the_numbers(self)
        rules = built("rules", lambda: built_rules(self.rules), problems)
        model, motion = built_parts(self.column, self.model, self.motion, problems)
        options = {name: getattr(self, name) for name in _SHARED} | {"rules": rules or OutcomeRules()}
        if self._lasts_as_its_motion(varying):
            options["duration"] = duration_with_tail(motion.duration, model.column.frequency_parameter)
        return model, motion, options

    def problems_of_the_length(self, names: tuple[str, ...]) -> list[str]:
        """Return a line unless one of `duration` and `periods` is given, or a duration among the `names` that vary.

        A motion that ends needs no duration: see `SimulationConfig`.
        """
        if self._lasts_as_its_motion(names):
            return []
        given = [name for name in ("duration", "periods") if getattr(self, name) is not None]
        given += ["a duration that varies"] if "duration" in names else []
        if len(given) == 1:
            return []
        got = " and ".join(given) or "none of them"
        return [f"duration [s], periods or a duration that varies is needed, one of them; got {got}"]

    def _lasts_as_its_motion(self, names: Sequence[str]) -> bool:
        open_end = self.duration is None and self.periods is None and "duration" not in names
        return open_end and is_to_end(self.motion)


# Values of numbers that vary, by unit.
_STAND_INS = {"m": 1e-3}

_SHARED = (*numbers_of(SharedByRuns), "demands", "recheck")


def with_numbers_that_vary(values: Mapping[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    """Return `values` with a number for each missing required number of the motion that varies over the runs.

    Raises
    ------
    ConfigError
        If a required number of the motion is missing, and a name that varies is unknown: it may be misspelt.
    """
    motion = values.get("motion")
    if not isinstance(motion, Mapping) or (make := made_by(motion.get("kind"))) is None:
        return dict(values)
    declared = parameters_of(make)
    missing = [name for name, one in declared.items() if one.required and name not in motion and name not in names]
    if missing and not _has_own_class(values.get("model")):
        problems = [
            _unknown(name, missing) for name in names if name and name not in known_names() and name not in declared
        ]
        if problems:
            raise ConfigError(problems)
    # If the motion has a path or a velocity, the acceleration depends on the frequency, which is then required.
    by_path = any(one.quantity.unit in ("m", "m/s") for one in declared.values())
    needed = [name for name in names if name in declared and declared[name].required]
    # With an amplitude of 1 m/s² scaling to an acceleration is exact; no base moves by 1 m.
    needed = [name for name in needed if not (by_path and name == "angular_frequency")]
    given = {name: _STAND_INS.get(declared[name].quantity.unit, 1.0) for name in needed}
    return {**values, "motion": {**given, **values["motion"]}}


def _has_own_class(model: object) -> bool:
    return isinstance(model, Mapping) and ":" in str(model.get("kind"))


def _unknown(name: str, missing: Sequence[str]) -> str:
    """Return the line on an unknown name in place of a number of the motion that is `missing`."""
    remedy = did_you_mean(name, known_names()) or f"the base motion needs {' and '.join(missing)}"
    return f"{name} is not known here; {remedy}"


def common_values(provenance: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values that all runs of a saved sweep shared, from its `provenance`.

    Raises
    ------
    UnsupportedError
        If descriptions do not support the model or base motion of the sweep.
    """
    refuse_own_classes(provenance)
    known = ("column", "model", "motion", "rules", *_SHARED, "end_converged")
    return {name: with_places(provenance[name]) for name in known if provenance.get(name) is not None}


def name_of(axis: object) -> str:
    """Return the name in the plain values of an axis, as in Python; "" without a name."""
    name = axis.get("name") if isinstance(axis, Mapping) else None
    return name.replace("-", "_") if isinstance(name, str) else ""


def refuse_design(provenance: Mapping[str, Any], *known: str) -> Mapping[str, Any]:
    """Return the design of a saved sweep, or raise ParameterError if its kind is not among those `known`."""
    design: Mapping[str, Any] = provenance.get("design") or {"kind": "ensemble"}
    if design["kind"] not in known:
        raise ParameterError(
            f"the runs belong to a design {design['kind']!r}; only {' and '.join(known)} can be repeated"
        )
    return design
