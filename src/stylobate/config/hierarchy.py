"""Describe one case for the model hierarchy."""

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Self

from pydantic import Field, create_model

from stylobate.config.description import Config, built
from stylobate.config.parts import (
    AT_REST,
    DEFAULT_MODEL,
    ColumnConfig,
    MotionConfig,
    default_values,
    described_model,
    number_or_word,
)
from stylobate.config.simulation import (
    OF_OTHER_COMMANDS,
    OneColumn,
    Setup,
    SimulationConfig,
    built_parts,
    built_rules,
    fields_of,
    problems_of_the_numbers,
    with_default_duration,
)
from stylobate.errors import ConfigError, require_positive
from stylobate.models.declared import MODELS, dissipation_of
from stylobate.run_arguments import OneRun, duration_with_tail

# The most general model declares the dissipation parameters of all other models.
_MOST_GENERAL = "rolling"


class _OfAllModels(Config):
    """Dissipation parameters of all models; each model uses those that it declares."""


if TYPE_CHECKING:
    HierarchyDissipation = _OfAllModels
else:
    HierarchyDissipation = create_model(
        "HierarchyDissipation",
        __base__=_OfAllModels,
        __doc__=_OfAllModels.__doc__,
        __module__=__name__,
        **{
            name: ((number_or_word(quantity) if quantity.by_word else float) | None, None)
            for name, quantity in dissipation_of(MODELS[_MOST_GENERAL]).items()
        },
    )


class HierarchyOptions(Config):
    """Slendernesses and reference model of a comparison.

    Parameters
    ----------
    slenderness
        Slendernesses to which the case is scaled, with its tilts and base motion; that of the column by default.
    reference
        Model from which differences are taken.
    """

    slenderness: tuple[float, ...] = ()
    reference: str = "rolling"


class _HierarchyCase(OneColumn):
    column: ColumnConfig
    model: HierarchyDissipation = HierarchyDissipation()
    motion: MotionConfig = AT_REST


class HierarchyConfig(fields_of(OneRun, "duration"), _HierarchyCase):  # type: ignore[misc]
    """A case of the model hierarchy: `column`, damping under `model`, `motion`, numbers of a run, and `hierarchy`."""

    rules: dict[str, float] = Field(default_factory=dict)
    hierarchy: HierarchyOptions = HierarchyOptions()

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; the kind of the model and its unchanged defaults are ignored."""
        of_others = {*OF_OTHER_COMMANDS, *SimulationConfig.model_fields} - set(cls.model_fields)
        kept = {name: value for name, value in values.items() if name not in of_others}
        described = kept.get("model")
        if isinstance(described, Mapping):
            usual = {**default_values(described.get("kind", DEFAULT_MODEL)), "kind": described.get("kind")}
            kept["model"] = {name: one for name, one in described.items() if name not in usual or one != usual[name]}
            shared = HierarchyDissipation.model_fields
            strange = {name: value for name, value in kept["model"].items() if name not in shared}
            if strange:
                raise ConfigError(
                    [
                        f"model.{name}: the models of the hierarchy share {', '.join(shared)} only (got {value!r}). "
                        "Remove it."
                        for name, value in strange.items()
                    ]
                )
        return super().parse(with_default_duration(kept))

    def build(self) -> Setup:
        """Build the most general model and the motion; the options are those of `stylobate.studies.model_hierarchy`.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        problems = problems_of_the_numbers(self)
        for c in self.hierarchy.slenderness:
            built("hierarchy", partial(require_positive, "slenderness", c), problems)
        rules = built("rules", lambda: built_rules(self.rules), problems)
        dissipation = self.model.model_dump(exclude_none=True)
        described = described_model(_MOST_GENERAL, **dissipation)
        model, motion = built_parts(self.column, described, self.motion, problems)
        dissipation = {name: getattr(model, name) for name in dissipation}
        options = self.model_dump(exclude={"column", "model", "motion", "hierarchy"})
        if self.duration is None:
            options["duration"] = duration_with_tail(motion.duration, model.column.frequency_parameter)
        compared = {"slenderness": self.hierarchy.slenderness or None, "reference": self.hierarchy.reference}
        return Setup(model, motion, options | compared | dissipation | {"rules": rules})
