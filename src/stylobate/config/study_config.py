"""The description of a study in a file, made from what the study declares of itself."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, create_model, field_validator

from stylobate.config.axis import Axis, Scales
from stylobate.config.description import Config, built
from stylobate.config.simulation import (
    OF_OTHER_COMMANDS,
    CaseConfig,
    ManyRuns,
    Setup,
    SimulationConfig,
    SteadyCase,
    built_parts,
    common_values,
    fields_of,
    name_of,
    problems_of_the_numbers,
    refuse_design,
    with_numbers_that_vary,
)
from stylobate.config.study import Analysis, Instead, Study, declared_numbers, several, study_of
from stylobate.errors import LARGEST_SEED, MOST_RUNS, require_whole
from stylobate.kinds import loaded
from stylobate.parameter_quantities import quantity_of
from stylobate.quantities import Parameter
from stylobate.run_arguments import numbers_of
from stylobate.units import read_all


class StudyConfig(ManyRuns):
    """A study of many runs: `column`, `model`, `motion`, the arguments of all runs, and the table of the study."""

    study: ClassVar[Study]

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; a motion may omit a number that varies, or the acceleration if it is scaled."""
        study = cls.study
        values = {name: one for name, one in {**study.usual, **values}.items() if study.without.get(name) != ""}
        table = values.get(study.name)
        if study.axes and not study.starts:
            axes = table if isinstance(table, Mapping) else {}
            scaled = study.scales and not (study.instead and axes.get(study.instead.key))
            varied = (*(name_of(axes.get(place)) for place in study.places), *(["acceleration"] if scaled else []))
            values = with_numbers_that_vary(values, varied)
        return super().parse(values)

    @classmethod
    def of_saved(cls, provenance: Mapping[str, Any], axes: Mapping[str, Sequence[float]], kind: str = "") -> Self:
        """Make the description that repeats a saved result.

        Parameters
        ----------
        provenance
            Provenance of the result.
        axes
            Coordinates of a grid: its names with their values, x first; then the scales.
        kind
            Kind of the result; by default that of the study.

        Raises
        ------
        UnsupportedError
            If descriptions do not support the model or base motion of the runs.
        ParameterError
            If the values of the runs follow another design.
        """
        study = cls.study
        table: dict[str, Any] = {}
        design: Mapping[str, Any] = {"kind": "grid"}
        if study.axes and not study.scales:
            design = refuse_design(provenance, *(("grid", "random") if study.starts else ("grid",)))
        if design["kind"] == "random":
            table = {"random": design["count"], "seed": design["seed"], "over": design["values"]}
        else:
            listed = {name: {"name": name, "values": list(values)} for name, values in axes.items()}
            if study.instead and kind == study.instead.kind:
                table[study.instead.key] = True
            elif study.scales:
                table["scales"] = listed.pop("scale")
            table |= dict(zip(study.places, listed.values(), strict=False))
        table |= {name: one for name, one in dict(provenance.get(study.name, {})).items() if one is not None}
        return cls.parse(study.repeated(provenance, {**common_values(provenance), study.name: table}))

    @property
    def instead(self) -> Instead | None:
        """The study that the table asks for in place of its own."""
        other = self.study.instead
        return other if other is not None and getattr(getattr(self, self.study.name), other.key) else None

    def build(self) -> Setup:
        """Build model and motion; the options are the keyword arguments of the study.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        study, problems = self.study, list[str]()
        table = getattr(self, study.name)
        arguments = table.arguments(study, problems)
        names = () if study.starts else tuple(arguments.get("over", ()))
        problems += [
            f"{name}: {why}"
            for name, why in study.without.items()
            if (getattr(self, name) or None) not in (None, type(self).model_fields[name].default)
        ]
        if "tail" in type(table).model_fields:
            names = ("duration",)  # that of each run follows from the end of its base motion
            if table.tail is not None and self.duration is not None:
                problems.append(
                    f"{study.name}.tail: contradicts duration (got a duration of {self.duration!r} s and a tail of "
                    f"{table.tail!r} s). Remove one of them."
                )
        elif "duration" not in study.without:
            problems += self.problems_of_the_length(names)
        model, motion, options = self.common(problems, names)
        for name in study.without:
            del options[name]
        for name in getattr(study.numbers, "__annotations__", ()):
            if getattr(self, name) is not None:
                options[name] = getattr(self, name)
        if study.early and self.end_converged:
            options["end_converged"] = True
        setup = Setup(model, motion, arguments | options)
        setup.options.update(study.arguments(self, setup))
        return setup


class AnalysisConfig(CaseConfig):
    """A study that is computed at once: `column`, `model`, `motion`, numbers at the top, and the table of the study."""

    study: ClassVar[Analysis]

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; those of other commands are ignored."""
        of_others = {*OF_OTHER_COMMANDS, *SimulationConfig.model_fields} - set(cls.model_fields)
        return super().parse(cls.study.read({name: one for name, one in values.items() if name not in of_others}))

    def build(self) -> Setup:
        """Build model and motion; the options are the keyword arguments of the study.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        problems = [*problems_of_the_numbers(self), *self.study.problems(self)]
        setup = Setup(*built_parts(self.column, self.model, self.motion, problems), {})
        setup.options.update(self.study.arguments(self, setup))
        return setup


class StudyTable(Config):
    """The table of a study: its axes, and its own numbers."""

    def arguments(self, study: Study, problems: list[str]) -> dict[str, Any]:
        """Make the arguments of the study; add a line to `problems` for each mistake."""
        fields = type(self).model_fields
        own = {name: getattr(self, name) for name in fields if name not in study.places}
        if study.instead is not None and own.pop(study.instead.key):
            taken = inspect.signature(loaded(study.instead.place)).parameters
            problems += [
                f"{study.name}.{name} is not supported by a {study.instead.kind}. Remove it."
                for name, value in own.items()
                if name not in taken and value != fields[name].default
            ]
            own = {name: value for name, value in own.items() if name in taken}
        elif study.scales and own["scales"] is None:
            problems.append(
                f"{study.name}.scales are missing: factors of the base motion, such as from 0.2 to 5, number 40"
            )
        elif study.scales:
            own["scales"] = built(f"{study.name}.scales", own["scales"].build, problems)
        return ({"over": self.grid(study, problems)} if study.axes else {}) | own

    def grid(self, study: Study, problems: list[str]) -> dict[str, Any]:
        """Make the values along the axes, by name; add a line to `problems` for each mistake."""
        axes = {place: axis for place in study.places if (axis := getattr(self, place)) is not None}
        over = {axis.name: built(f"{study.name}.{place}", axis.build, problems) for place, axis in axes.items()}
        if len(over) < len(axes):
            problems.append(f"{study.name}.x and {study.name}.y must differ, got {axes['x'].name!r} in both")
        return over


class _StartsTable(StudyTable):
    """Initial conditions on a grid of two of them, or drawn at random.

    Parameters
    ----------
    x, y
        Values of an initial condition on a grid: a table as below.
    random
        Number of initial conditions to draw, in place of a grid.
    seed
        Seed of the draw.
    over
        Range of each initial condition that is drawn: minimum and maximum.
    """

    x: Axis | None = None
    y: Axis | None = None
    random: int | None = None
    seed: int = 0
    over: dict[str, tuple[float, float]] = Field(default_factory=dict)

    @field_validator("over")
    @classmethod
    def _written_as_in_python(cls, over: dict[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        return {name.replace("-", "_"): bounds for name, bounds in over.items()}

    @field_validator("over", mode="before")
    @classmethod
    def _read_units(cls, over: Any) -> Any:
        """Read bounds with a unit, such as "5 deg"."""
        if not isinstance(over, Mapping):
            return over
        return {name: read_all(one, quantity_of(str(name).replace("-", "_")).unit) for name, one in over.items()}

    def arguments(self, study: Study, problems: list[str]) -> dict[str, Any]:
        """Make the arguments of the study: a grid over two names, or the ranges and number of a random sample."""
        name = study.name
        axes = [place for place in study.places if getattr(self, place) is not None]
        if self.random is None:
            problems += _problems_of_the_grid(name, axes, self)
            return {"over": self.grid(study, [] if problems else problems)}
        if axes:
            problems.append(
                f"{name}.{f' and {name}.'.join(axes)}: random initial conditions have ranges (over) and no grid"
            )
        if not self.over:
            problems.append(f"{name}.over is missing: the ranges of random initial conditions, by name")
        built(name, lambda: require_whole("random", self.random or 0, least=1, most=MOST_RUNS), problems)
        built(name, lambda: require_whole("seed", self.seed, least=0, most=LARGEST_SEED), problems)
        return {"over": dict(self.over), "count": self.random, "rng": self.seed}


def _problems_of_the_grid(name: str, axes: Sequence[str], table: _StartsTable) -> list[str]:
    if table.over:
        return [f"{name}.random is missing: the number of initial conditions to draw in the ranges over"]
    if not axes:
        return [f"{name}: x and y are missing (a grid of initial conditions), or random and over (a random sample)"]
    return [f"{name}.{place} is missing" for place in "xy" if place not in axes]


@cache
def study_config(function: Callable[..., Any]) -> Any:
    """Make the class that describes a study, such as `stylobate.studies.overturning_map`, in files.

    Returns
    -------
    type[StudyConfig] or type[AnalysisConfig]

    Raises
    ------
    ParameterError
        If the function is no study with a description.
    """
    study = study_of(function)
    if isinstance(study, Analysis):
        return _analysis_config(function, study)
    fields: dict[str, Any] = {
        place.rstrip("?"): (Axis | None, None) if "?" in place else (Axis, ...) for place in study.axes
    }
    if study.scales:
        fields["scales"] = (Scales | None, None)
    if study.instead is not None:
        fields[study.instead.key] = (bool, False)
    numbers_of_study = declared_numbers(function)
    room = study.name.title().replace("_", "")
    make: Any = create_model
    about = {"__doc__": (function.__doc__ or "").partition("\n")[0], "__module__": __name__}
    made: type[StudyTable] = make(
        f"{room}Table",
        __base__=_StartsTable if study.starts else StudyTable,
        __doc__=_about(study, numbers_of_study),
        __module__=__name__,
        **({} if study.starts else fields),
        **_fields(numbers_of_study),
    )
    required = any(one.is_required() for one in made.model_fields.values())
    of_runs = () if study.numbers is None else (fields_of(study.numbers),)
    early = {"end_converged": (bool, False)} if study.early else {}
    found: type[StudyConfig] = make(
        f"{room}Config",
        __base__=(*of_runs, StudyConfig),
        **about,
        **{study.name: (made, ... if required else made())},
        **early,
    )
    found.study = study
    return found


def _analysis_config(function: Callable[..., Any], study: Analysis) -> type[AnalysisConfig]:
    own, room = declared_numbers(function), study.name.title().replace("_", "")
    make: Any = create_model
    fields: dict[str, Any] = {}
    if "rules" in study.numbers.__annotations__:
        fields["rules"] = (dict[str, float], Field(default_factory=dict))
    if own:
        text = _keys(f"The table `{study.name}`.", own)
        table = make(f"{room}Table", __base__=Config, __doc__=text, __module__=__name__, **_fields(own))
        fields[study.name] = (table, table())
    found: type[AnalysisConfig] = make(
        f"{room}Config",
        __base__=(fields_of(study.numbers, "duration"), *([SteadyCase] if study.steady else []), AnalysisConfig),
        __doc__=_keys((function.__doc__ or "").partition("\n")[0], numbers_of(study.numbers)),
        __module__=__name__,
        **fields,
    )
    found.study = study
    return found


def _fields(numbers: Mapping[str, Parameter]) -> dict[str, Any]:
    return {name: (Annotated[_type_of(one), one.quantity], one.default) for name, one in numbers.items()}


def _about(study: Study, numbers: Mapping[str, Parameter]) -> str:
    """Write the docstring of the table of a study: the meaning of each of its keys."""
    if study.starts:
        return str(_StartsTable.__doc__)
    said = dict.fromkeys(study.places, "Values of a quantity: a table as above.")
    if study.scales:
        said["scales"] = "Factors of the base motion: a table as above, without a name."
    if study.instead is not None:
        text = study.instead.text
        said[study.instead.key] = f"{text[:1].upper()}{text[1:]}."
    return _keys(f"The table `{study.name}`.", numbers, said)


def _keys(first: str, numbers: Mapping[str, Parameter], others: Mapping[str, str] | None = None) -> str:
    """Write a docstring with the meaning of each key."""
    said = dict(others or {})
    for name, one in numbers.items():
        text, unit = one.quantity.text, one.quantity.unit
        said[name] = f"{text[:1].upper()}{text[1:]}{f' [{unit}]' if unit else ''}."
    lines = "".join(f"    {name}\n        {text}\n" for name, text in said.items())
    return f"{first}\n\n    Parameters\n    ----------\n{lines}    "


def _type_of(number: Any) -> Any:
    kind = tuple[Annotated[float, number.quantity], ...] if several(number) else number.annotation
    return kind | None if number.optional else kind
