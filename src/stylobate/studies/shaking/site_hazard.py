"""The hazard curve of a site as it is described, in the intensity of a fragility."""

from stylobate.errors import ParameterError
from stylobate.spec.hazard import HazardPoints
from stylobate.studies.fragility import HazardCurve
from stylobate.studies.shaking.intensities import Intensity, SpectralAcceleration

_UNITS = {"m s-2": "m/s²", "m s-1": "m/s", "1": "1"}


def site_hazard(points: HazardPoints, intensity: Intensity | SpectralAcceleration) -> HazardCurve:
    """Return the curve through `points`.

    Raises
    ------
    ParameterError
        If the points are of another intensity or unit than `intensity`, do not tell a unit that must be told, or are no
        hazard curve.
    """
    _require_unit(points, intensity)
    if points.measure and points.measure != intensity.value.partition(",")[0]:
        message = f"fragility.hazard is of {points.measure!r}, the fragility of {intensity.value!r}; give that of one"
        raise ParameterError(message)
    try:
        return HazardCurve(
            intensity=points.intensity, rate=points.rate, units=intensity.units, quantity=intensity.value
        )
    except ParameterError as error:
        message = f"fragility.hazard: {error}"
        raise ParameterError(message) from None


def _require_unit(points: HazardPoints, intensity: Intensity | SpectralAcceleration) -> None:
    if points.units == intensity.units or (points.units is None and intensity.units == "1"):
        return
    if points.units is None:
        where = f"name it in the first line of {points.source}, such as" if points.source else "give units, such as"
        told = "“PGA [g], annual rate [1/a]”, or give units" if points.source else 'units = "g"'
        message = f"fragility.hazard does not tell the unit of its intensity; {where} {told}"
        raise ParameterError(message)
    message = (
        f"fragility.hazard is of an intensity in {_UNITS[points.units]}, the fragility of {intensity.value!r} in "
        f"{_UNITS[intensity.units]}; give the hazard of that, or another intensity"
    )
    raise ParameterError(message)
