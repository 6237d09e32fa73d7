"""Inheritance of model members: the class that states a member, and whether the member fits the equations."""

from stylobate.models.closed_form import ClosedForm
from stylobate.models.model import Model

_EQUATIONS = ("rates", "parameters")


def owner_of(kind: type[Model], name: str) -> type:
    """Return the class from which `kind` has its member `name`."""
    return next(cls for cls in kind.__mro__ if name in vars(cls))


def belongs_to_equations(kind: type[Model], name: str, *also: str) -> bool:
    """Return whether the class that states `rates` and `parameters`, or a subclass of it, states `name`.

    A subclass that replaces `rates` or `parameters` replaces the equations. An inherited claim about the equations,
    such as the energy of the balance, is then void unless the subclass states it again.

    Parameters
    ----------
    kind
        The class of a model.
    name
        The member that makes the claim.
    *also
        Further members on which the claim depends, such as `energy`.
    """
    place = kind.__mro__.index(owner_of(kind, name))
    return all(place <= kind.__mro__.index(owner_of(kind, other)) for other in (*_EQUATIONS, *also))


def closed_form_of(model: object) -> ClosedForm | None:
    """Return the closed form of steady rolling that a model states for its own equations; None without one."""
    if not isinstance(model, Model) or not belongs_to_equations(type(model), "closed_form", "tilt_of", "start"):
        return None
    return model.closed_form
