"""The description of an assessment: columns, records, dissipation, friction, and what is asked of them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Self

import numpy as np
import numpy.typing as npt
from pydantic import BeforeValidator, Field, ValidationInfo, field_validator

from stylobate.errors import DescriptionError, ParameterError, require_positive
from stylobate.models import Model
from stylobate.motions import Record
from stylobate.spec.axis import Axis
from stylobate.spec.columns import ColumnDescription
from stylobate.spec.description import Description, built
from stylobate.spec.models import ModelDescription, WobblingModel
from stylobate.spec.records import RecordsDescription

_LEVELS = ("low", "central", "high")
_MARGIN = {"from": 0.2, "to": 5.0, "number": 60, "spacing": "log"}


def _with_name(values: Any) -> Any:
    """Return the values of a margin as those of an axis."""
    return {**_MARGIN, **values, "name": "scale"} if isinstance(values, dict) and "values" not in values else values


def _as_source(values: Any) -> Any:
    """Return the values of records; a folder, a pattern or a list of files is their source."""
    return {"source": values} if isinstance(values, (str, list, tuple)) else values


@dataclass(frozen=True, slots=True)
class AssessmentSetup:
    """What a description of an assessment describes: models, records and the other arguments of `studies.assess`."""

    columns: dict[str, Model]
    records: dict[str, Record]
    options: dict[str, Any]


class AssessDescription(Description):
    """An assessment: `columns` by name, `records`, `dissipation`, `friction_coefficient`, and what is asked of them."""

    title: str = "Columns under records"
    columns: dict[str, ColumnDescription]
    model: ModelDescription = WobblingModel()
    dissipation: dict[str, dict[str, float]]
    friction_coefficient: float | dict[str, float]
    records: Annotated[RecordsDescription, BeforeValidator(_as_source)]
    scales: tuple[float, ...] = (1.0,)
    margin: Annotated[Axis, BeforeValidator(_with_name)] = Field(
        default_factory=lambda: Axis.parse({**_MARGIN, "name": "scale"})
    )
    width: float = 5e-3
    tail: float | None = None
    robustness: bool = True
    planar: bool = True
    contact: bool = True
    least_records: int = 10
    rtol: float = 1e-8
    max_steps: int = 200_000
    notes: tuple[str, ...] = ()

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Return the description of these `values`.

        Raises
        ------
        DescriptionError
            With one line for each mistake; one says how to state the dissipation where it is missing.
        """
        problems: list[str] = []
        given = dict(values)
        model = given.get("model")
        if isinstance(model, Mapping):
            given["model"] = {"kind": "wobbling", **model}
        for name, remedy in _NEEDED.items():
            if name not in given:
                problems.append(f"{name} is missing: {remedy}")
                given[name] = _STANDS_IN[name]
        try:
            found = super().parse(given)
        except DescriptionError as error:
            raise DescriptionError([*error.problems, *problems]) from None
        if problems:
            raise DescriptionError(problems)
        return found

    @field_validator("dissipation")
    @classmethod
    def _at_three_levels(cls, given: dict[str, dict[str, float]], info: ValidationInfo) -> dict[str, dict[str, float]]:
        del info
        missing = [level for level in _LEVELS if level not in given]
        if missing:
            message = f"dissipation: {' and '.join(missing)} must be stated too: {_NEEDED['dissipation']}"
            raise ValueError(message)
        return given

    def build(self) -> AssessmentSetup:
        """Return models, records and the other arguments of `stylobate.studies.assess`.

        Raises
        ------
        DescriptionError
            With one line for each part that cannot be.
        """
        problems: list[str] = []
        problems += self._problems_of_the_model()
        models = {name: self._model(name, problems) for name in self.columns}
        if not models:
            problems.append("columns must hold at least one column, such as [columns.tank]")
        scales = built("margin", self.margin.build, problems)
        problems += [] if scales is None else _problems_of_the_margin(scales)
        problems += self._problems_of_the_levels()
        try:
            require_positive("width", self.width)
        except ParameterError as error:
            problems.append(str(error))
        records: dict[str, Record] = {}
        try:
            records = self.records.build()
        except DescriptionError as error:
            problems += error.problems
        if problems:
            raise DescriptionError(problems)
        options = {name: getattr(self, name) for name in _PASSED}
        quiet = {} if self.robustness else {"changes": ()}
        built_models = {name: model for name, model in models.items() if model is not None}
        return AssessmentSetup(built_models, records, {**options, **quiet, "margin_scales": scales})

    def _model(self, name: str, problems: list[str]) -> Model | None:
        column = built(f"columns.{name}", self.columns[name].build, problems)
        if column is None:
            return None
        return built("model", lambda: self.model.build(column), problems) if not self._problems_of_the_model() else None

    def _problems_of_the_model(self) -> list[str]:
        if self.model.kind == "sliding":
            return ["model.kind must be one that holds the contact, such as wobbling, got 'sliding'"]
        told = [name for name in self.dissipation["central"] if name in self.model.model_fields_set]
        return [f"model.{name} is told by dissipation; leave it out" for name in told]

    def _problems_of_the_levels(self) -> list[str]:
        """Return a line where a level loses less than one that is called lower."""
        levels = [self.dissipation[name].get("damping") for name in _LEVELS]
        dampings = [value for value in levels if value is not None]
        if len(dampings) < len(levels) or dampings == sorted(dampings):
            return []
        told = ", ".join(f"{name} {value:g}" for name, value in zip(_LEVELS, dampings, strict=True))
        return [f"dissipation: damping must not fall from low to central to high, got {told}"]


def _problems_of_the_margin(scales: npt.NDArray[np.float64]) -> list[str]:
    if scales.size < 2:  # noqa: PLR2004  edges lie between two
        return [f"margin.number must be 2 or more, got {scales.size}"]
    if np.all(np.diff(scales) > 0.0):
        return []
    return [f"margin.from must be less than margin.to, got {scales[0]:g} and {scales[-1]:g}"]


_NEEDED = {
    "dissipation": (
        "how fast a column in space loses energy decides its fate and is seldom known; state it for three levels, such "
        "as [dissipation] low = {damping = 0.005}, central = {damping = 0.02}, high = {damping = 0.05}"
    ),
    "friction_coefficient": "the friction between column and base, with which what the runs need is compared",
}
_STANDS_IN: dict[str, Any] = {
    "dissipation": {level: {"damping": 0.0} for level in _LEVELS},
    "friction_coefficient": 1.0,
}

_PASSED = (
    *("title", "dissipation", "friction_coefficient", "scales", "width", "tail", "planar", "contact"),
    *("least_records", "notes", "rtol", "max_steps"),
)
