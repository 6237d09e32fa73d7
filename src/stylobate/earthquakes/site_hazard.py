"""The hazard curve of a description, in the intensity of a fragility."""

from typing import Any

from stylobate.earthquakes.config.hazard import HazardPoints
from stylobate.earthquakes.fragility import HazardCurve
from stylobate.earthquakes.fragility.annual_rate import require_same_component
from stylobate.earthquakes.intensities import IntensityMeasure
from stylobate.errors import ParameterError

_UNITS = {"m s-2": "m/s²", "m s-1": "m/s", "1": "1"}
_FIRST_LINE = "“PGA RotD50 [g], annual rate [1/a]”"
_DAMPING = ", 5 % damping"  # hazard curves with another damping are refused


def site_hazard(points: HazardPoints, intensity: IntensityMeasure) -> HazardCurve:
    """Build the hazard curve through `points`.

    Raises
    ------
    ParameterError
        If the points have another intensity, horizontal component or unit than `intensity`, lack one of these, or are
        no hazard curve.
    """
    quantity = intensity.quantity
    _require_unit(points, intensity)
    if not points.measure and quantity.units != "1":
        named = (
            f"Name it in the first line of {points.source}, such as {_FIRST_LINE}, or give" if points.source else "Give"
        )
        raise ParameterError(
            f'fragility.hazard: intensity measure not stated. {named} measure, such as "PGA" or "SA(0.5 s)".'
        )
    measure = points.measure + (_DAMPING if points.measure.startswith("spectral") else "")
    if measure and measure != quantity.value:
        raise ParameterError(
            f"fragility.hazard uses {measure!r}, but the fragility uses {quantity.value!r}. Provide both for "
            "the same intensity measure."
        )
    common: dict[str, Any] = {"units": quantity.units, "quantity": quantity.value, "component": points.component}
    try:
        require_same_component(intensity.component.value, points.component)
        if points.investigation_time is None:
            return HazardCurve(intensity=points.intensity, rate=points.exceedance, **common)
        time = points.investigation_time
        return HazardCurve.of_probabilities(points.intensity, points.exceedance, investigation_time=time, **common)
    except ParameterError as error:
        raise ParameterError(
            f"fragility.{error}" if str(error).startswith("hazard:") else f"fragility.hazard: {error}"
        ) from None


def _require_unit(points: HazardPoints, intensity: IntensityMeasure) -> None:
    units, name = intensity.quantity.units, intensity.quantity.value
    if points.units == units or (points.units is None and units == "1"):
        return
    if points.units is None:
        where = f"name it in the first line of {points.source}, such as" if points.source else "give units, such as"
        example = f"{_FIRST_LINE}, or give units" if points.source else 'units = "g"'
        raise ParameterError(f"fragility.hazard does not state the unit of its intensity; {where} {example}")
    raise ParameterError(
        f"fragility.hazard uses an intensity in {_UNITS[points.units]}, but the fragility uses {name!r} in "
        f"{_UNITS[units]}. Provide both for the same intensity measure."
    )
