"""Onset of motion: the base acceleration at which a standing column slides, rocks or lifts off."""

import json

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BASE_AT_REST
from stylobate.errors import ParameterError, UnsupportedError, require_finite
from stylobate.models import Model, Sliding
from stylobate.provenance import provenance_of_run
from stylobate.results.outcomes import flag_attributes
from stylobate.studies.sweeps.designs import checked_values
from stylobate.theory import FirstMotion, start_of_motion

Floats = npt.NDArray[np.float64]

_LONG_NAMES = {
    "acceleration": "minimum base acceleration that moves the column",
    "slide": "acceleration at the onset of sliding",
    "rock": "acceleration at the onset of rocking",
    "lift_off": "acceleration at lift-off",
}
_ATTRIBUTES = {
    "slenderness": {"units": "1", "long_name": "slenderness c"},
    "friction_coefficient": {"units": "1", "long_name": "static friction coefficient"},
    "vertical_ratio": {"units": "1", "long_name": "vertical over horizontal acceleration"},
    "incline": {"units": "rad", "long_name": "angle of the plane to the horizontal"},
}
_OVER = tuple(_ATTRIBUTES)


def start_boundary(
    model: Model,
    *,
    slenderness: npt.ArrayLike,
    friction_coefficient: npt.ArrayLike | None = None,
    vertical_ratio: npt.ArrayLike = 0.0,
    vertical_phase: float = 0.0,
    incline: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Compute the minimum base acceleration that moves a standing column, and the motion that begins first.

    The base vibrates harmonically along a line and along the normal of the plane. The frequency does not matter: the
    onset follows from forces alone. On an incline the line is the line of steepest descent.

    Parameters
    ----------
    model
        A `Sliding` model. Supplies gravity and all parameters not given below.
    slenderness
        Values of c.
    friction_coefficient
        Values of the static friction coefficient μ; by default that of the model.
    vertical_ratio
        Values of the ratio of the amplitudes along the normal and along the line.
    vertical_phase
        Phase of the motion along the normal [rad]; 0 is an oblique line.
    incline
        Angles of the plane [rad]; by default that of the model.

    Returns
    -------
    xarray.Dataset
        Of kind "start boundary". Over `slenderness`, `friction_coefficient`, `vertical_ratio` and `incline`:
        `acceleration`, the minimum amplitude along the line that moves the column [m/s²]. It is 0 if the column does
        not stay on the plane at rest, and infinite if the column always stays. `first_motion` is a
        `theory.FirstMotion`. At the amplitudes `slide`, `rock` and `lift_off` [m/s²] friction is exceeded, the
        resultant force leaves the base, and the normal force vanishes, respectively.

    Raises
    ------
    ParameterError
        If a list is empty or contains a number out of range.
    UnsupportedError
        If the model does not slide.

    See Also
    --------
    stylobate.theory.start_of_motion : the closed form.
    stylobate.studies.overturning_map : the motion after the onset.

    Notes
    -----
    The smaller of μ and c determines the first motion. If μ < c, the column slides from rest, and |T| ≤ μN < cN holds
    for every base motion: the column never tips while it stays on the plane. If c < μ, the column rocks; its contact
    demand grows during fall and spin, so it may slip on its rim. If μ = c exactly, both begin together; any real
    difference decides, so compute values below and above.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Sliding(sb.Column.solid(radius=0.5, height=10.0, density=2700.0), friction_coefficient=0.3)
    >>> found = sb.conveying.start_boundary(model, slenderness=[0.1, 0.5], vertical_ratio=[0.0, 1.0]).squeeze()
    >>> print(found["acceleration"].values.round(3).tolist())
    [[0.981, 0.892], [2.942, 2.263]]
    >>> [sb.theory.FirstMotion(first).name for first in found["first_motion"].sel(vertical_ratio=0.0).values]
    ['ROCK', 'SLIDE']
    """
    if type(model) is not Sliding:
        raise UnsupportedError(
            f"model {getattr(model, 'name', model)!s} does not slide: a start boundary needs Sliding(column)"
        )
    phase = require_finite("vertical_phase", vertical_phase, "rad")
    given = {
        "slenderness": slenderness,
        "friction_coefficient": model.numbers.static if friction_coefficient is None else friction_coefficient,
        "vertical_ratio": vertical_ratio,
        "incline": model.incline if incline is None else incline,
    }
    values = {name: _values(name, some) for name, some in given.items()}
    c, mu, ratio, slope = np.meshgrid(*values.values(), indexing="ij")
    start = start_of_motion(1.0, ratio, c=c, friction=mu, phase=phase, incline=slope)
    gravity = model.column.gravity
    amplitudes = {"acceleration": start.amplitude, "slide": start.slide, "rock": start.rock, "lift_off": start.lift_off}
    flags = flag_attributes("first motion", [kind.name for kind in FirstMotion])
    return xr.Dataset(
        {
            **{
                name: (_OVER, gravity * amplitude, {"units": "m s-2", "long_name": _LONG_NAMES[name]})
                for name, amplitude in amplitudes.items()
            },
            "first_motion": (_OVER, start.first.astype(np.int8), flags),
        },
        coords={name: (name, some, _ATTRIBUTES[name]) for name, some in values.items()},
        attrs={
            "kind": "start boundary",
            "vertical_phase": phase,
            "gravity": gravity,
            "provenance": json.dumps(provenance_of_run(model, BASE_AT_REST)),
        },
    )


def _values(name: str, given: npt.ArrayLike) -> Floats:
    """Return the values of a parameter, one or more, or raise ParameterError."""
    values = checked_values(name, name, given, scalar=True)
    if not values.size:
        raise ParameterError(f"{name} must have at least one value, got none")
    return values
