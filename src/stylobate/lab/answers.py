"""Answers of the server: their names, types and meaning, from which the OpenAPI document and the page's types follow.

Numbers that are not finite are null. A name with a default may be missing.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Annotated, Any, Literal

import numpy.typing as npt
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, GetJsonSchemaHandler, RootModel, WithJsonSchema
from pydantic.json_schema import models_json_schema
from pydantic_core import CoreSchema

from stylobate.column import Column
from stylobate.errors import Outcome
from stylobate.lab.limits import Limits
from stylobate.lab.requests import JOBS
from stylobate.models.declared import column_quantities
from stylobate.models.sliding.balance import Contact
from stylobate.plots.geometry import Shape
from stylobate.quantities import Quantity, parameters_of
from stylobate.results.outcomes import NUMERICALLY_UNCERTAIN
from stylobate.results.plain import plain_numbers

Schema = dict[str, Any]

REFERENCE = "#/components/schemas/{model}"
"""Reference to a schema by its name."""

_DIGITS = 9
"""Significant digits in answers; the page shows fewer."""


def numbers(values: npt.ArrayLike) -> list[Any]:
    """Return an array as lists of rounded numbers, with None for numbers that are not finite."""
    return plain_numbers(values, _DIGITS)


class Answer(BaseModel):
    """A part of an answer."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    def as_json(self) -> bytes:
        """Return the answer as JSON, without names that were left out, and with null for NaN and infinities."""
        return self.model_dump_json(exclude_unset=True, by_alias=True).encode()


@dataclass(frozen=True, slots=True)
class Names:
    """Annotation of a mapping: its `needed` and its optional names with their meanings, and whether it has `others`."""

    needed: Mapping[str, str]
    optional: Mapping[str, str]
    others: bool = False

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> Schema:
        """Return the schema of the mapping, whose values have one schema."""
        value = handler(core)["additionalProperties"]
        properties = {
            name: value | {"description": text} if text else value
            for name, text in {**self.needed, **self.optional}.items()
        }
        others = value if self.others else False
        needed = list(self.needed)
        return {"type": "object", "properties": properties, "required": needed, "additionalProperties": others}


def in_words(quantity: Quantity) -> str:
    """Return the meaning of a number with its unit."""
    return f"{quantity.text} [{quantity.unit}]" if quantity.unit else quantity.text


def _texts(quantities: Mapping[str, Quantity]) -> dict[str, str]:
    return {name: in_words(one) for name, one in quantities.items()}


def _one_of(words: list[str]) -> WithJsonSchema:
    return WithJsonSchema({"type": "string", "enum": words})


Number = float | None
"""A number, or null if it is not finite or not known."""
Share = Annotated[float, Field(ge=0.0, le=1.0)] | None
Count = Annotated[int, Field(ge=0)]
Pair = tuple[float, float]
Triple = tuple[float, float, float]
Floats = Annotated[list[float], BeforeValidator(numbers)]
Numbers = Annotated[list[Number], BeforeValidator(numbers)]
Pairs = Annotated[list[Pair], BeforeValidator(numbers)]
"""Arrays, which are rounded."""
OutcomeName = Annotated[str, _one_of([one.name for one in Outcome])]
OutcomeLabel = Annotated[str, _one_of([one.label for one in Outcome])]

# Options


class Parameter(Answer):
    """A parameter."""

    name: str = Field(description="name as in descriptions")
    symbol: str = Field(description="symbol in the literature; empty if there is none")
    unit: str = Field(description="unit; empty if there is none")
    about: str = Field(description="one-line description")
    default: Any = Field(description="default value; null if there is none")
    needed: bool = Field(description="whether the parameter is required")
    varies: bool = Field(description="whether maps can vary the parameter")
    first: Number = Field(alias="from", description="lower end of the slider; null if no range suits all cases")
    last: Number = Field(alias="to", description="upper end of the slider")
    choices: list[int | str] | None = Field(None, description="possible values, if there are few")


class Kind(Answer):
    """A kind of column, model or motion."""

    kind: str = Field(description="kind as in descriptions")
    name: str = Field(description="name in words")
    about: str = Field(description="one-line description")
    parameters: list[Parameter]
    moves: bool | None = Field(None, description="for motions: whether the base moves, so that a run needs no duration")


class Preset(Answer):
    """An example motion."""

    identity: str = Field(alias="id")
    title: str
    about: str
    outcome: OutcomeName = Field(exclude=True, description="expected outcome")
    description: dict[str, Any] = Field(description="body for /api/simulate")
    view: dict[str, Any] = Field(
        description="view on the page: branch of the start, tab, quantities over time; the page chooses what is missing"
    )


class Choice(Answer):
    """One of the choices of a lesson."""

    text: str
    change: dict[str, Any] = Field(description="parts of the description to replace")


class LessonControl(Answer):
    """The control of a lesson: a number with a range, some choices, or both."""

    number: str | None = Field(None, description="name of the number; null for choices alone")
    first: float | None = Field(None, alias="from", description="lower end of the range")
    last: float | None = Field(None, alias="to", description="upper end of the range")
    options: list[Choice] | None = Field(None, description="choices")


class Lesson(Answer):
    """A question about one case, with one control and an answer for each outcome."""

    identity: str = Field(alias="id")
    title: str
    question: str
    task: str = Field(description="what to do")
    curves: bool = Field(False, description="whether the page shows frequency response and maps beside the motion")
    control: LessonControl
    said: dict[str, str] = Field(
        description="text for each outcome; {critical} stands for the critical frequency of the case"
    )
    description: dict[str, Any] = Field(description="body for /api/simulate")
    view: dict[str, Any] = Field(description="view on the page, as for presets")


class About(Answer):
    """Options of the laboratory."""

    version: str = Field(description="version of stylobate")
    limits: Annotated[dict[str, float], Names(dict.fromkeys((one.name for one in fields(Limits)), ""), {})]
    shapes: list[Kind] = Field(description="kinds of columns")
    models: list[Kind] = Field(description="kinds of models")
    motions: list[Kind] = Field(description="kinds of base motions")
    samples: list[str] = Field(description="names of the sample records")
    presets: list[Preset] = Field(description="example motions")
    lessons: list[Lesson] = Field(description="the tour")


class Peaks(Answer):
    """Peak accelerations."""

    x: float | None = Field(None, description="along x [m/s²]")
    y: float | None = Field(None, description="along y [m/s²]")
    z: float | None = Field(None, description="along z [m/s²]")


class UploadedRecord(Answer):
    """An uploaded record."""

    upload: str = Field(description='digest, for the motion {"kind": "record", "upload": …}')
    name: str = Field(description="name of the event")
    samples: Count = Field(description="number of samples")
    step: float = Field(description="time step [s]")
    duration: float = Field(description="duration [s]")
    peaks: Peaks
    provenance: list[str] = Field(description="origin, one line each")
    warnings: list[str] = Field(description="possible mistakes in its files, one line each")
    records: list[str] = Field(description="names of the records in an archive, of which this is one; else none")


class Document(RootModel[dict[str, Any]]):
    """OpenAPI 3.1."""


class Problems(Answer):
    """Reasons for the refusal of a request."""

    problems: list[str] = Field(min_length=1, description="one line each")


# Runs

OF_ANY_COLUMN = {
    **{
        name: one
        for name, one in column_quantities().items()
        if hasattr(Column, name) and name != "height"  # not every column has a height
    },
    "frequency_scale": Quantity(unit="rad/s", text="ω0"),
    "frequency_parameter": Quantity(unit="rad/s", text="frequency parameter √(m g R/K)"),
}
"""The attributes of a column that the page shows."""

_UPLIFT = "c g, the horizontal acceleration at which the standing column uplifts [m/s²]"


class ColumnNumbers(
    RootModel[Annotated[dict[str, float], Names({**_texts(OF_ANY_COLUMN), "uplift_acceleration": _UPLIFT}, {})]]
):
    """The decisive numbers of the column."""


_OF_EACH_RUN = {
    "peak_tilt": "[rad]",
    "peak_tilt_over_c": "peak tilt over the slenderness",
    "time_of_peak_tilt": "[s]",
    "minimum_tilt": "[rad]",
    "least_passage": "minimum tilt at a passage through the vertical [rad]; null if none",
    "turns": "turns of the contact point round the rim",
    "steps": "steps of the integration",
}
_OF_SOME_RUNS = {
    "mean_rolling_rate": "mean rolling rate over the last periods of the base [rad/s]",
    "repetition": "difference of the last periods, over the slenderness",
    "mean_tilt_late": "mean tilt over the last periods [rad]",
    "minimum_tilt_late": "minimum tilt over the last periods [rad]",
    "peak_tilt_late": "peak tilt over the last periods [rad]",
    "repeats_after": "periods of the base after which the motion repeats; 0 if it does not",
    "modulation_change": "change of the modulation over the second half of the run",
    "rolling_rate_error": "error of the mean rolling rate, from the turns",
    "peak_friction_demand": "peak friction over normal force; null without a normal force",
    "peak_pivoting_demand": "peak moment over normal force and radius",
    "minimum_normal_force": "minimum normal force over weight",
    **{f"time_{one.name.lower()}": f"time {one.name.lower()} [s]" for one in Contact if one is not Contact.JAMMED},
    "residual_displacement": "residual displacement of the centre of the footprint [m]",
    "residual_displacement_x": "[m]",
    "residual_displacement_y": "[m]",
    "residual_twist": "[rad]",
    "walking_distance": "length of the path of the footprint [m]",
    "slip_distance": "length of the path of the contact on the plane [m]",
    "impacts": "number of impacts on the plane",
    "slips": "number of starts of slip",
    "least_painleve_denominator": "1 without friction; dynamic jamming at 0",
}


class Measures(RootModel[Annotated[dict[str, Number], Names(_OF_EACH_RUN, _OF_SOME_RUNS, others=True)]]):
    """Numbers of the run as a whole. Models may add further numbers."""


class Series(Answer, extra="allow"):
    """Histories, all as long as `time`. Models may add further histories."""

    time: Floats = Field(description="[s]")
    base_acceleration: Annotated[list[Triple], BeforeValidator(numbers)] = Field(
        description="base acceleration along x, y, z [m/s²]"
    )
    amplitude: Numbers = Field(description="tilt θ [rad]")
    azimuth: Numbers | None = Field(None, description="azimuth β of the lean [rad]; null if the column stands upright")
    rolling_rate: Numbers | None = Field(None, description="rate of the azimuth [rad/s]")
    spin: Numbers | None = Field(None, description="angular velocity about the axis [rad/s]")
    friction_demand: Numbers | None = Field(None, description="friction over normal force")
    pivoting_demand: Numbers | None = Field(None, description="moment over normal force and radius")
    normal_force: Numbers | None = Field(None, description="normal force over weight")
    contact: list[Contact] | None = Field(
        None, description=", ".join(f"{one.value} {one.name.lower()}" for one in Contact)
    )
    clearance: Numbers | None = Field(None, description="height of the lowest point above the base [m]")
    displacement: Annotated[list[list[Number]], BeforeValidator(numbers)] | None = Field(
        None, description="displacement of the centre of the footprint since the start [m]"
    )
    slip_speed: Numbers | None = Field(None, description="slip speed of the contact on the plane [m/s]")
    extremes: dict[str, Pairs] = Field(
        description="time [s] and value of extremes between the samples, by history; of vectors as displacement_x"
    )


class DrawnPlane(Answer, extra="allow"):
    """The inclined plane."""

    incline: float = Field(description="[rad]")
    incline_direction: float = Field(description="[rad]")


_SHAPE = {name: one.quantity for name, one in parameters_of(Shape).items()}


class DrawnMotion(Answer, extra="allow"):
    """The motion to draw, at equal time steps: lengths in m in the frame of the base, z upwards.

    Null for quantities that the model does not provide.
    """

    column: Annotated[dict[str, float], Names(_texts(_SHAPE), {}, others=True)] = Field(description="the body")
    plane: DrawnPlane
    time: list[float] = Field(description="[s]")
    tilt: list[Pair] = Field(description="tilt vector θ(cos β, sin β) [rad]")
    tilt_rate: list[Pair] = Field(description="rate of the tilt vector [rad/s]")
    twist: list[float] = Field(description="twist χ about the axis [rad]")
    spin: list[float] | None = Field(description="angular velocity about the axis [rad/s]")
    footprint: list[Pair] = Field(description="centre of the circle on the base about which the contact point lies [m]")
    contact_point: list[Pair] = Field(description="[m]")
    resting: list[Literal[0, 1]] = Field(description="1 if the whole base face is in contact")
    clearance: list[float] | None = Field(description="height of the lowest point above the base [m]")
    base: list[Triple] = Field(description="displacement of the base [m]")
    rotation: list[tuple[float, float, float, float]] = Field(description="unit quaternion w, x, y, z")
    centre: list[Triple] = Field(description="centre of the bottom circle [m]")
    friction_demand: list[Number] | None = Field(description="friction over normal force")
    friction_coefficient: Number = Field(description="friction coefficient of the contact, if known")
    outcome: OutcomeName
    decided_at: float = Field(description="[s]")
    title: str = Field(description="a line that states the outcome")


class RunEvent(Answer):
    """An uplift, an impact or another event."""

    kind: str = Field(description="kind of event")
    time: float = Field(description="time [s]")


class Described(Answer):
    """The snippets and the column of a description, without a run."""

    toml: str = Field(description="the description as a file for the command line")
    python: str = Field(description="the same run as a Python program")
    column: ColumnNumbers


class Run(Described):
    """One run."""

    outcome: OutcomeName
    label: OutcomeLabel = Field(description="the outcome in words")
    reason: str = Field(description="reason for the outcome")
    decided_at: float = Field(description="time at which the outcome was decided [s]")
    uncertain: bool = Field(description=f"whether the outcome is {NUMERICALLY_UNCERTAIN}")
    planar: bool = Field(description="whether the motion stayed in one vertical plane")
    warnings: list[str] = Field(description="one line each")
    events: list[RunEvent] = Field(description="uplifts, impacts and other events")
    measures: Measures
    summary: list[tuple[str, str]] = Field(description="labels and values")
    thresholds: dict[str, Number] = Field(description="the thresholds that decided the outcome")
    drawn: DrawnMotion
    series: Series


# Response curves, and initial conditions on them

Sense = Annotated[Literal["anticlockwise", "clockwise"], Field(description="sense of rolling, seen from above")]


class CurveBranch(Answer):
    """One branch of steady rolling; null at frequencies without such rolling."""

    sense: Sense
    branch: Literal["lower", "upper"] = Field(description="one of the two solutions")
    amplitude: Numbers = Field(description="tilt [rad]")
    phase: Numbers = Field(description="phase of the lean relative to the base acceleration [rad]")
    stable: list[bool] = Field(description="whether the motion is stable")


class CriticalFrequency(Answer):
    """The frequency at which the upper branch loses its stability."""

    sense: Sense
    angular_frequency: Number = Field(description="[rad/s], null if there is none")


class ResponseCurves(Answer):
    """Steady rolling over frequency, from theory; all lists are as long as `angular_frequency`."""

    angular_frequency: Floats = Field(description="[rad/s]")
    branches: list[CurveBranch] = Field(description="one for each sense and branch")
    backbone: Numbers = Field(description="tilt of free rolling [rad], null if there is no such rolling")
    critical: list[CriticalFrequency]
    averaged: bool = Field(description="whether the curves are approximate (averaging) rather than exact")


class OrbitFamily(Answer):
    """A family of exact orbits; all its lists have the same length."""

    name: str = Field(description="name of the family")
    angular_frequency: Floats = Field(description="[rad/s]")
    mean_tilt: Floats = Field(description="[rad]")
    minimum_tilt: Floats = Field(description="[rad]")
    peak_tilt: Floats = Field(description="[rad]")
    phase: Numbers = Field(description="[rad]")
    stable: list[bool] = Field(description="whether the motion is stable")
    tilt: Pairs = Field(description="tilt at t = 0, along x and y [rad]")
    tilt_rate: Pairs = Field(description="tilt rate at t = 0 [rad/s]")


class Bifurcation(Answer):
    """A bifurcation of a family."""

    kind: str = Field(description="kind, such as Neimark-Sacker")
    angular_frequency: float = Field(description="[rad/s]")
    mean_tilt: float = Field(description="[rad]")
    supercritical: bool | None = Field(description="whether it is supercritical; null if undecided")


class ExactOrbits(Answer):
    """Exact periodic orbits, the result of a job `exact`."""

    families: list[OrbitFamily]
    bifurcations: list[Bifurcation]


class Start(Answer):
    """Initial conditions of a run."""

    tilt: Annotated[Pair, BeforeValidator(numbers)] = Field(description="tilt along x and y [rad]")
    tilt_rate: Annotated[Pair, BeforeValidator(numbers)] = Field(description="[rad/s]")
    spin: float = Field(description="angular velocity about the axis [rad/s]")
    warnings: list[str] = Field(description="one line if the start is approximate, or its orbit unstable")


# Jobs


class PlaneAxis(Answer):
    """A quantity that varies."""

    name: str = Field(description="name as in the description")
    values: Numbers = Field(description="in SI units")
    long_name: str | None = Field(None, description="name in words")
    units: str | None = Field(None, description="unit such as rad s-1")


class PlaneAxes(Answer):
    """The axes of a map or basin."""

    x: PlaneAxis
    y: PlaneAxis


class PlaneBegun(Answer):
    """The first event of a map or basin: its axes, and the meanings of the codes of cells."""

    axes: PlaneAxes
    names: list[tuple[int, str]] = Field(description="codes and their meanings")


class PlaneCells(Answer):
    """Computed cells, from coarse to fine."""

    stride: Count = Field(description="step between known values along x and y")
    cells: list[tuple[Count, Count, int]] = Field(description="index along x, index along y, and code")


class CellClass(Answer):
    """A class of cells: a kind of outcome or of contact, or an attractor."""

    code: Count = Field(description="code in the cells")
    name: str
    share: Share = Field(description="share of all runs")
    low: Share = Field(description="lower end of the interval of the share; null if there is none")
    high: Share = Field(description="upper end")


class GridResult(Answer):
    """The result of a map or basin: the class of each cell."""

    runs: Count = Field(description="number of runs")
    uncertain: Count = Field(description=f"runs whose outcome is {NUMERICALLY_UNCERTAIN}")
    codes: list[list[int]] = Field(
        description="a row for each value of x, with a code for each value of y; -1 if not computed"
    )
    classes: list[CellClass]


class Varied(Answer):
    """A number that varies."""

    name: str = Field(description="name as in the description; scale is the strength of the base motion")
    deviation: float = Field(description="standard deviation of its logarithm")


class Variations(Answer):
    """Small variations of one case."""

    varied: list[Varied]
    runs: Count = Field(description="number of runs")
    classes: list[CellClass] = Field(description="outcomes that occur, the most frequent first")
    outcomes: list[OutcomeName] = Field(description="of each run")
    times: Annotated[list[list[Number]], BeforeValidator(numbers)] = Field(description="of each run [s]")
    tilts: Annotated[list[list[Number]], BeforeValidator(numbers)] = Field(description="of each run [rad]")


class Begun(Answer):
    """A new job."""

    id: str = Field(description="identity of the job in requests")


JobState = Literal["waiting", "running", "done", "failed", "cancelled"]


class Job(Begun):
    """The state of a job."""

    kind: Annotated[str, _one_of([*JOBS])] = Field(description="kind of computation")
    state: JobState
    done: Count = Field(description="number of completed runs")
    total: Count = Field(description="number of runs; 0 while unknown")
    note: str = Field(description="a line about the computation, such as the compilation of a kernel")
    events: list[PlaneBegun | PlaneCells] = Field(description="events, from the number `after` on")
    next: Count = Field(description="value of `after` in the next request")
    problems: list[str] = Field(description="reasons for the failure, one line each")
    result: ExactOrbits | GridResult | None = Field(
        description="the result when the job is done; null before, and for an animation, which has a file"
    )


ANSWERS = (About, Document, UploadedRecord, Problems, Run, Variations, Described, ResponseCurves, Start, Begun, Job)
"""The answers of endpoints."""


def schemas() -> dict[str, Schema]:
    """Return the JSON schema of each answer and of its parts, by name."""
    _, found = models_json_schema([(one, "serialization") for one in ANSWERS], ref_template=REFERENCE)
    return {name: _plain(schema) for name, schema in sorted(found["$defs"].items())}


def _plain(schema: Any) -> Any:
    """Return a schema without titles; what may be missing is not null."""
    if isinstance(schema, list):
        return [_plain(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    if "default" in schema and "anyOf" in schema:
        kinds = [one for one in schema["anyOf"] if one != {"type": "null"}]
        rest = {name: one for name, one in schema.items() if name not in ("anyOf", "default")}
        schema = {**rest, **(kinds[0] if len(kinds) == 1 else {"anyOf": kinds})}
    return {name: _plain(part) for name, part in schema.items() if name != "title" or not isinstance(part, str)}
