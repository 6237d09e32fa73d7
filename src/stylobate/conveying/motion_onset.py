"""From which acceleration on a standing column slides, rocks or is lifted, over its slenderness."""

import json

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BASE_AT_REST
from stylobate.config import provenance_of_run
from stylobate.errors import ParameterError, UnsupportedError, require_finite
from stylobate.models import Model, Sliding
from stylobate.results.outcomes import flag_attributes
from stylobate.studies.sweeps.quantities import checked_values
from stylobate.theory import FirstMotion, start_of_motion

Floats = npt.NDArray[np.float64]

_LONG_NAMES = {
    "acceleration": "least acceleration of the base that moves the column",
    "slide": "acceleration from which it slides",
    "rock": "acceleration from which it rocks",
    "lift_off": "acceleration from which it is lifted",
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
    """Return the least acceleration of the base that moves a standing column, and what it then does first.

    The base moves along a line and along the normal of the plane, harmonically, at any frequency: what begins to move
    follows from forces alone. On an incline the line is that of the steepest way.

    Parameters
    ----------
    model
        `Sliding`: its gravity counts, and what is not listed below.
    slenderness
        Values of c.
    friction_coefficient
        Values of the static μ; by default that of the model.
    vertical_ratio
        Values of the amplitude along the normal over that along the line.
    vertical_phase
        Phase of the motion along the normal [rad]; 0 is an oblique line.
    incline
        Angles of the plane [rad]; by default that of the model.

    Returns
    -------
    xarray.Dataset
        Of kind "start boundary". Over `slenderness`, `friction_coefficient`, `vertical_ratio` and `incline`:
        `acceleration`, the least amplitude along the line that moves the column [m/s²], 0 where it does not stay on
        the plane at rest, infinite where it always stays; `first_motion`, a `theory.FirstMotion`; and the amplitudes
        `slide`, `rock` and `lift_off` at which it leaves the cone of friction, at which the forces leave its base, and
        at which its weight is gone [m/s²].

    Raises
    ------
    ParameterError
        If a list is empty or holds a number out of range.
    UnsupportedError
        If the model does not slide.

    See Also
    --------
    stylobate.theory.start_of_motion : the closed form.
    contact_map : what a column does after that.

    Notes
    -----
    The smaller of μ and c alone decides what begins. What comes after it is not symmetrical. A column that slides
    from rest, μ < c, bears |T| ≤ μN < cN whatever the base does: it never tips as long as it stays on the plane. One
    that rocks, c < μ, bears more as it falls and turns, and may slip on its rim.

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
        message = f"model {getattr(model, 'name', model)!s} does not slide: a start boundary needs Sliding(column)"
        raise UnsupportedError(message)
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
    flags = flag_attributes("what it does first", [kind.name for kind in FirstMotion])
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
    values = checked_values(name, name, np.atleast_1d(np.asarray(given)))
    if not values.size:
        message = f"{name} must have at least one value, got none"
        raise ParameterError(message)
    return values
