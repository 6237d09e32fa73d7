"""Options that commands share, and how they join with a TOML file: same names, options win."""

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import wraps
from pathlib import Path
from typing import Annotated, Any

import typer

from stylobate.errors import FileError, ParameterError


def _option(text: str, panel: str) -> Any:
    return typer.Option(help=text, rich_help_panel=panel, show_default=False)


def _axis(text: str) -> Any:
    return typer.Option(help=text, rich_help_panel=_AXES, show_default=False, metavar="NAME FROM TO NUMBER")


def _readable(paths: list[Path] | None) -> list[Path] | None:
    """Return the files, or say at once that one is missing: what reads them takes seconds to import."""
    for path in paths or ():
        if not path.is_file():
            message = f"cannot read {path}: No such file or directory"
            raise FileError(message)
    return paths


_AXES = "Axes"
_RUN, _COLUMN, _MODEL, _MOTION, _OUTPUT = "Run", "Column", "Model", "Base motion", "Output"
_COMPUTING = "Computing"

_AXIS = tuple[str, float, float, int]
X = Annotated[_AXIS | None, _axis("what varies along x: name, from, to, how many values")]
Y = Annotated[_AXIS | None, _axis("what varies along y: name, from, to, how many values")]
XSpacing = Annotated[str | None, _option("linear (by default) or log", _AXES)]
YSpacing = Annotated[str | None, _option("linear (by default) or log", _AXES)]

Tilt = Annotated[tuple[float, float] | None, _option("tilt vector at the start [rad]", _RUN)]
TiltRate = Annotated[tuple[float, float] | None, _option("its rate [rad/s]", _RUN)]
Duration = Annotated[float | None, _option("how long to follow a run [s]", _RUN)]
Periods = Annotated[float | None, _option("for how many periods of its base motion, instead of --duration", _RUN)]
Rtol = Annotated[float | None, _option("relative tolerance, 1e-8 by default", _RUN)]
TiltLimit = Annotated[float | None, _option("tilt that ends a run [rad]", _RUN)]
RestEnergy = Annotated[float | None, _option("energy of rest ε, in c²", _RUN)]
MaxSteps = Annotated[int | None, _option("most integration steps, 200000 by default", _RUN)]
Method = Annotated[str | None, _option("dop853 (by default), or taylor: faster for columns that roll steadily", _RUN)]
Samples = Annotated[int | None, _option("number of samples kept", _RUN)]
Spin = Annotated[float | None, _option("angular velocity about the axis at the start [rad/s]", _RUN)]
Twist = Annotated[float | None, _option("angle of turn about the axis at the start [rad]", _RUN)]
Position = Annotated[tuple[float, float] | None, _option("centre of the footprint at the start [m]", _RUN)]
FrictionCoefficient = Annotated[
    float | None, _option("of the contact: kinetic, of sliding; of others, a run warns where it needs more", _RUN)
]
Velocity = Annotated[
    tuple[float, float, float] | None, _option("of the lowest point at the start, of sliding [m/s]", _RUN)
]
Clearance = Annotated[float | None, _option("its height above the base at the start, of sliding [m]", _RUN)]

Shape = Annotated[str | None, _option("solid, hollow, frustum or dimensionless; told from the others", _COLUMN)]
Radius = Annotated[float | None, _option("base radius [m]", _COLUMN)]
Height = Annotated[float | None, _option("height [m]", _COLUMN)]
Density = Annotated[float | None, _option("density [kg/m³]", _COLUMN)]
InnerRadius = Annotated[float | None, _option("inner radius of a hollow column [m]", _COLUMN)]
TopRadius = Annotated[float | None, _option("top radius of a frustum [m]", _COLUMN)]
Slenderness = Annotated[float | None, _option("r/h of a dimensionless column (m = g = ω0 = 1)", _COLUMN)]
Gravity = Annotated[float | None, _option("gravity [m/s²], 9.80665 by default", _COLUMN)]

Model = Annotated[
    str | None,
    _option("slender (by default), slender-rolling, wobbling, rolling, sliding or planar-rocking", _MODEL),
]
Damping = Annotated[float | None, _option("viscous friction η, dimensionless", _MODEL)]
SpinDamping = Annotated[float | None, _option("ζ, of a column that may turn: its spin decays at ζω0", _MODEL)]
RollingResistance = Annotated[float | None, _option("lever arm of the normal force, in radii", _MODEL)]
Restitution = Annotated[float | None, _option("part of the tilt rate left after passing the upright", _MODEL)]
Constraint = Annotated[str | None, _option("of wobbling: pure-tilt (by default) or rubber", _MODEL)]
PassageTilt = Annotated[
    float | None, _option("tilt below which the upright is passed [rad], 0.01 c by default", _MODEL)
]

StaticFriction = Annotated[
    float | None, _option("static coefficient of sliding, by default --friction-coefficient", _MODEL)
]
Patch = Annotated[float | None, _option("radius of the contact of sliding, in radii; 0 is a point", _MODEL)]
Incline = Annotated[float | None, _option("angle of the plane of sliding to the horizontal [rad]", _MODEL)]
InclineDirection = Annotated[float | None, _option("azimuth of the way down [rad]", _MODEL)]

MOTIONS_IN_FILES = ("harmonic", "displacement_amplitude", "sum", "one_of", "scaled", "rotated", "delayed")
"""Kinds of base motion whose numbers no option gives."""

Motion = Annotated[
    str | None,
    _option(
        "rest, circular, straight, elliptic, vertical, oblique, stroke, orbit or record; a pulse: half-sine, "
        "half-cosine, one-sine, one-cosine, sinusoidal, type-a, type-b, type-c, ricker, antisymmetric-ricker, gabor, "
        "mavroeidis-papageorgiou; linear-sweep or logarithmic-sweep; in a file also "
        + ", ".join(MOTIONS_IN_FILES).replace("_", "-"),
        _MOTION,
    ),
]
HarmonicMotion = Annotated[str | None, _option("circular, straight or elliptic; a file knows more kinds", _MOTION)]
Acceleration = Annotated[float | None, _option("acceleration amplitude [m/s²]", _MOTION)]
AngularFrequency = Annotated[float | None, _option("angular frequency [rad/s]", _MOTION)]
Frequency = Annotated[
    float | None, _option("frequency of a stroke, a gabor or a mavroeidis-papageorgiou [Hz]", _MOTION)
]
Amplitude = Annotated[tuple[float, float] | None, _option("two amplitudes of an ellipse [m/s²]", _MOTION)]
Phase = Annotated[float | None, _option("phase of the second axis of an ellipse, or of a pulse [rad]", _MOTION)]
Direction = Annotated[float | None, _option("direction of a motion along a line [rad]", _MOTION)]
Angle = Annotated[float | None, _option("angle at which an oblique motion rises [rad]", _MOTION)]
Sense = Annotated[int | None, _option("1 anticlockwise, -1 clockwise", _MOTION)]
Stroke = Annotated[float | None, _option("stroke from peak to peak [m]", _MOTION)]
Diameter = Annotated[float | None, _option("diameter of an orbit [m]", _MOTION)]
Rpm = Annotated[float | None, _option("turns a minute of an orbit", _MOTION)]
StartPhase = Annotated[float | None, _option("phase at the start [rad]", _MOTION)]
Ramp = Annotated[float | None, _option("time over which the amplitude rises [s]", _MOTION)]

_WAVEFORMS: Mapping[str, Any] = {
    "pulse_velocity": Annotated[float | None, _option("velocity of a type-a, -b, -c or wavelet pulse [m/s]", _MOTION)],
    "cycles": Annotated[float | None, _option("number of cycles of a sinusoidal or type-c pulse", _MOTION)],
    "oscillations": Annotated[float | None, _option("oscillations of a gabor or mavroeidis-papageorgiou", _MOTION)],
    "displacement": Annotated[float | None, _option("displacement amplitude of a sine sweep [m]", _MOTION)],
    "frequencies": Annotated[
        tuple[float, float] | None, _option("first and last frequency of a sine sweep [Hz]", _MOTION)
    ],
    "length": Annotated[float | None, _option("how long a sine sweep lasts [s]", _MOTION)],
    "start": Annotated[float | None, _option("when a pulse or a sine sweep starts [s]", _MOTION)],
    "vertical": Annotated[float | None, _option("vertical over horizontal of a pulse or a sine sweep", _MOTION)],
}


def with_waveforms(command: Callable[..., None]) -> Callable[..., None]:
    """Add the numbers of pulses and sine sweeps to the options of a `command`, which reads them from its context."""
    signature = inspect.signature(command)
    own = list(signature.parameters.values())
    place = list(signature.parameters).index("ramp")
    more = [own[place].replace(name=name, annotation=one) for name, one in _WAVEFORMS.items()]

    @wraps(command)
    def taking(**given: Any) -> None:
        command(**{name: value for name, value in given.items() if name not in _WAVEFORMS})

    joined = signature.replace(parameters=[*own[: place + 1], *more, *own[place + 1 :]])
    taking.__signature__ = joined  # type: ignore[attr-defined]  # what typer reads
    return taking


RecordFiles = Annotated[
    list[Path] | None,
    typer.Option(
        help="a file of a record; once more for each component of the same event, whatever its name",
        rich_help_panel=_MOTION,
        show_default=False,
        callback=_readable,
    ),
]
RecordDirections = Annotated[
    list[str] | None,
    _option("direction of a component, once for each --record, in their order: an azimuth, up, N10E, L …", _MOTION),
]
Single = Annotated[
    bool | None,
    typer.Option(
        "--single", help="one component alone is meant: no warning", rich_help_panel=_MOTION, show_default=False
    ),
]
SampleRecord = Annotated[
    str | None, _option('a record that comes with the package: "el centro 1940", or "… corrected"', _MOTION)
]
Units = Annotated[str | None, _option("of a record whose file tells none: g, m/s2 or cm/s2", _MOTION)]
TimeStep = Annotated[float | None, _option("time step of a record whose file tells none [s]", _MOTION)]
Scale = Annotated[float | None, _option("factor of a record", _MOTION)]
Rotation = Annotated[float | None, _option("by which a record is turned about the vertical [rad]", _MOTION)]
Tail = Annotated[float | None, _option("rest after a record [s]", _MOTION)]

Figure = Annotated[Path | None, _option("draw into this file (.png, .pdf, .svg)", _OUTPUT)]
Output = Annotated[Path | None, _option("save the result into this netCDF file (.nc)", _OUTPUT)]
OutputOrStore = Annotated[
    Path | None, _option("save the result: a netCDF file (.nc), or a store (.zarr) that --resume can continue", _OUTPUT)
]
Resume = Annotated[bool, typer.Option("--resume", help="continue the store of --output", rich_help_panel=_COMPUTING)]
Executor = Annotated[
    str | None, _option("threads (by default), dask:// (workers on this machine) or dask://host:port", _COMPUTING)
]
ThreadCount = Annotated[int | None, _option("threads to run on; all cores by default", _COMPUTING)]
Json = Annotated[bool, typer.Option("--json", help="print JSON instead of a table", rich_help_panel=_OUTPUT)]

_COLUMN_NAMES = ("shape", "radius", "height", "density", "inner_radius", "top_radius", "slenderness", "gravity")
_TABLES = ("column", "model", "motion", "records")
_MODEL_NAMES = (
    "damping",
    "spin_damping",
    "rolling_resistance",
    "restitution",
    "constraint",
    "passage_tilt",
    "static_friction_coefficient",
    "patch",
    "incline",
    "incline_direction",
)
_MOTION_NAMES = (
    "acceleration",
    "angular_frequency",
    "frequency",
    "amplitude",
    "phase",
    "direction",
    "angle",
    "sense",
    "stroke",
    "diameter",
    "rpm",
    "start_phase",
    "ramp",
    *(name for name in _WAVEFORMS if name != "pulse_velocity"),
)
_RECORD_NAMES = ("units", "step", "single", "scale", "rotation", "tail")


def overlay(described: Mapping[str, Any], given: Mapping[str, Any], fields: Iterable[str]) -> dict[str, Any]:
    """Lay the options `given` over the values `described` in a file.

    Parameters
    ----------
    described
        Values of a TOML file, or nothing.
    given
        All options of the command by name; None is not given.
    fields
        Names that the description knows at its top: options that it does not know are not read.
    """
    values = dict(described)
    _section(values, "column", _column(values.get("column"), _pick(given, _COLUMN_NAMES)), tag="shape")
    _section(values, "model", _model(values, given))
    _section(values, "motion", _motion(values.get("motion"), given), tag="kind")
    slides = _slides(values.get("model"))
    chosen = _pick(given, [name for name in fields if name not in (*_TABLES, *(_CONTACT if slides else ()))])
    for name, other in (("duration", "periods"), ("periods", "duration")):
        if name in chosen and other not in chosen:
            values.pop(other, None)  # how long is said in one way
    return values | chosen


# A number of the model where that slides, of the run otherwise: see `FrictionCoefficient`.
_CONTACT = ("friction_coefficient",)


def _slides(model: Any) -> bool:
    """Return whether the described model has a coefficient of friction of its own."""
    return isinstance(model, Mapping) and model.get("kind") == "sliding"


def _motion(described: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of the base motion, with underscores for hyphens.

    Raises
    ------
    ParameterError
        If its numbers can be given in a file only, and the file describes another motion.
    """
    options = _pick(given, _MOTION_NAMES)
    if given.get("pulse_velocity") is not None:
        options["velocity"] = given["pulse_velocity"]  # --velocity is that of the column at the start
    if not given.get("motion"):
        return {**options, **_record(described, given)}
    kind = given["motion"].replace("-", "_")
    if kind in MOTIONS_IN_FILES and not (isinstance(described, Mapping) and described.get("kind") == kind):
        message = (
            f"--motion: no options give the numbers of this motion (got {given['motion']}). "
            f'Describe it in a file: [motion], kind = "{kind}".'
        )
        raise ParameterError(message)
    return {"kind": kind, **options, **_record(described, given)}


def _record(described: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of a record: its files make the motion one, and only files can lack a component."""
    known = described if isinstance(described, Mapping) else {}
    files = [str(path) for path in given.get("record") or ()]
    which: dict[str, Any] = {"path": files[0] if len(files) == 1 else files} if files else {}
    if given.get("sample_record"):
        which["sample"] = given["sample_record"]
    if given.get("record_direction"):
        which["directions"] = [_azimuth_or_name(text) for text in given["record_direction"]]
    kind = {"kind": "record"} if which and not given.get("motion") else {}
    of_files = ("path" in which) or ("sample" not in which and "path" in known)
    return {**kind, **which, **_pick(given, [name for name in _RECORD_NAMES if of_files or name != "single"])}


def _azimuth_or_name(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _column(described: Any, options: dict[str, Any]) -> dict[str, Any]:
    """Return the options of the column with its shape told; they may not change the shape of a file unasked."""
    from stylobate.config.columns import implied_shape  # noqa: PLC0415  heavy imports wait until the options are read

    implied = implied_shape(options)
    before = described.get("shape", implied_shape(described) or "solid") if isinstance(described, Mapping) else None
    if not options or "shape" in options:
        return options
    if before is None:
        return options | {"shape": implied or "solid"}
    if before == "given" or implied not in (None, before):
        wanted = implied or "solid"
        message = (
            f"column: the file has a column of shape {before!r}; to replace it add --shape {wanted} "
            "and all of its numbers"
        )
        raise ParameterError(message)
    return options | {"shape": before}


def _model(values: dict[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of the model, with underscores for hyphens.

    Another kind than that of the file keeps what it knows of the numbers there, and `values` lose the others: the same
    column by another model.
    """
    from stylobate.config.models import known_values  # noqa: PLC0415  heavy imports wait until the options are read

    described = values.get("model", {})
    if given.get("model") and isinstance(described, Mapping):
        kind = given["model"].replace("-", "_")
        values["model"] = {**known_values(described, kind), "kind": kind}
    options = _pick(given, (*_MODEL_NAMES, *(_CONTACT if _slides(values.get("model")) else ())))
    if "constraint" in options:
        options["constraint"] = options["constraint"].replace("-", "_")
    return options


def _pick(given: Mapping[str, Any], names: Iterable[str]) -> dict[str, Any]:
    return {name: given[name] for name in names if given.get(name) is not None}


def overlay_ladder(described: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values `described` with the slendernesses and the reference `given` in the table `ladder`."""
    values = dict(described)
    chosen: dict[str, Any] = {}
    if given.get("scaled_to"):
        chosen["slenderness"] = given["scaled_to"]
    if given.get("reference"):
        chosen["reference"] = given["reference"].replace("-", " ").replace("_", " ")
    _section(values, "ladder", chosen)
    return values


def overlay_axes(described: Mapping[str, Any], given: Mapping[str, Any], section: str) -> dict[str, Any]:
    """Return the values `described` with the axes `given` as options x, y, x_spacing, y_spacing in a table of them.

    Parameters
    ----------
    section
        Name of the table.
    """
    values = dict(described)
    table = values.get(section, {})
    if not isinstance(table, Mapping):
        return values
    table = dict(table)
    for place in "xy":
        if given.get(place) is not None:
            name, first, last, number = given[place]
            table[place] = {"name": name, "from": first, "to": last, "number": number}
        table |= overlay_spacing(table, place, given)
    return {**values, section: table} if table else values


def overlay_spacing(table: Mapping[str, Any], name: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the axis `name` of this `table` with its spacing, if that is `given`; listed values have none."""
    described = table.get(name)
    if not isinstance(described, Mapping) or "values" in described or given.get(f"{name}_spacing") is None:
        return {}
    return {name: {**described, "spacing": given[f"{name}_spacing"]}}


def overlay_late(described: Mapping[str, Any], given: Mapping[str, Any], section: str) -> dict[str, Any]:
    """Return the values `described` with the option `late`, where it is given, in a table of them."""
    values = dict(described)
    _section(values, section, _pick(given, ("late",)))
    return values


def overlay_sample(described: Mapping[str, Any], given: Mapping[str, Any], section: str) -> dict[str, Any]:
    """Return the values `described` with the random sample `given` as options random, seed and over in a table."""
    values, sample = dict(described), _pick(given, ("random",))
    ranges = dict(_range(text) for text in given.get("over") or ())
    table = values.get(section, {})
    if "random" in sample or (isinstance(table, Mapping) and table.get("random") is not None):
        sample |= _pick(given, ("seed",))  # nothing is drawn for a grid
    if not (sample or ranges) or not isinstance(table, Mapping):
        return values
    if "random" in sample:  # instead of a grid that the file describes
        table = {name: value for name, value in table.items() if name not in ("x", "y")}
    return {**values, section: {**table, **sample, **({"over": ranges} if ranges else {})}}


def joined_ranges(arguments: Sequence[str]) -> list[str]:
    """Return `arguments` with the three values of each option --over as one: typer knows no lists of tuples."""
    joined: list[str] = []
    rest = list(arguments)
    while rest:
        joined.append(rest.pop(0))
        if joined[-1] == "--over":
            joined.append(" ".join(rest[:_RANGE]))
            del rest[:_RANGE]
    return joined


def _range(text: str) -> tuple[str, list[str]]:
    name, *bounds = text.split()
    if len(bounds) != _RANGE - 1:
        message = f"--over must be followed by a name, its lowest and its highest value; got {text!r}"
        raise ParameterError(message)
    return name, bounds


_RANGE = 3


def _section(values: dict[str, Any], name: str, options: dict[str, Any], tag: str = "") -> None:
    described = values.get(name, {})
    if not isinstance(described, Mapping):
        return
    other = tag in options and options[tag] != described.get(tag)
    merged = options if other else {**described, **options}
    if merged or name in values:
        values[name] = merged
