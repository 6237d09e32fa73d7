"""Parameters that a study can vary by name, with their units and valid values."""

from collections.abc import Mapping

from stylobate.base_motions.base import Acceleration, AngularFrequency
from stylobate.base_motions.declared import motion_quantities
from stylobate.column import Column
from stylobate.models.declared import model_quantities
from stylobate.quantities import QUARTER_TURN, Parameter, Quantity, parameters_of

_OF_ALL_CASES: Mapping[str, Quantity] = {
    **{
        f"tilt_{axis}": Quantity(unit="rad", text=f"initial tilt along {axis}", gt=-QUARTER_TURN, lt=QUARTER_TURN)
        for axis in "xy"
    },
    **{f"tilt_rate_{axis}": Quantity(unit="rad/s", text=f"initial rate of tilt along {axis}") for axis in "xy"},
    "spin": Quantity(unit="rad/s", text="initial angular velocity about the axis"),
    "duration": Quantity(unit="s", text="duration", gt=0.0),
    **{name: parameter.quantity for name, parameter in parameters_of(Column).items()},
    "slenderness": Quantity(text="slenderness", gt=0.0),
    "size": Quantity(text="size relative to the given column", gt=0.0),
    "motion": Quantity(text="number of the base motion", ge=0.0, whole=True),
    "acceleration": Quantity(
        unit="m/s²",
        text="peak horizontal acceleration of the base",
        ge=0.0,
        unlikely_above=Acceleration.__metadata__[0].unlikely_above,  # type: ignore[attr-defined]
    ),
    "scale": Quantity(text="factor of the base motion"),
    "angular_frequency": AngularFrequency.__metadata__[0],  # type: ignore[attr-defined]
    "start_phase": Quantity(unit="rad", text="phase of the base motion at the start"),
    "rotation": Quantity(unit="rad", text="rotation of the base motion"),
    "delay": Quantity(unit="s", text="delay of the base motion"),
    **{
        f"offset_{axis}": Quantity(unit="m/s²", text=f"constant acceleration of the base along {axis}") for axis in "xy"
    },
    **{f"amplitude_{axis}": Quantity(unit="m/s²", text=f"acceleration of the base along {axis}") for axis in "xyz"},
    "phase_difference": Quantity(unit="rad", text="phase of the base along y minus phase along x"),
}

_QUANTITIES: Mapping[str, Quantity] = {
    **model_quantities(),
    **{f"{part}{name}": one for name, one in motion_quantities().items() for part in ("", "motion.")},
    **_OF_ALL_CASES,
}

_ANY = Quantity()


def quantity_of(name: str, own: Mapping[str, Parameter] | None = None) -> Quantity:
    """Return the quantity `name`; an unknown name has a quantity that accepts any finite number.

    Parameters
    ----------
    name
        Name of the quantity.
    own
        Declared numbers of the model and base motion at hand, which other classes may declare differently or not at
        all.
    """
    declared = None if own is None or name in _OF_ALL_CASES else own.get(name.removeprefix("motion."))
    return _QUANTITIES.get(name, _ANY) if declared is None else declared.quantity


def known_names() -> frozenset[str]:
    """Return the names of all quantities that a study can vary, of any model and base motion of the package."""
    return frozenset(_QUANTITIES)


def attributes_of(name: str) -> dict[str, str]:
    """Return the attributes of a coordinate that holds the quantity `name`."""
    known = _QUANTITIES.get(name)
    return {} if known is None else {"long_name": known.text, "units": known.cf_units}
