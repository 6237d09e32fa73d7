"""Check that inherited contact forces belong to the equations of the model."""

from collections.abc import Iterator

import numpy as np

from stylobate.models.consistency.samples import Subject
from stylobate.models.inheritance import belongs_to_equations, owner_of
from stylobate.models.model import Model


def problems_of_forces(subject: Subject) -> Iterator[str]:
    """Yield a line if `contact` is inherited although `rates` are new: its forces belong to other equations."""
    kind = type(subject.model)
    if subject.model.contact is None or belongs_to_equations(kind, "contact"):
        return
    owner = owner_of(kind, "contact")
    if not _moves_as(subject, owner):
        yield (
            f"contact: inherited from {owner.__name__}, returns forces of the equations of {owner.__name__}, which "
            "rates or parameters replace. Define contact for these equations, or set contact = None."
        )


def _moves_as(subject: Subject, owner: type) -> bool:
    """Return whether the equations of `owner` give the same rates with the parameters of the model."""
    assert issubclass(owner, Model)
    for state in subject.random_states(3):
        push = (0.1, -0.2, 0.1)
        try:
            theirs = np.array(owner.rates(*state, *push, *subject.numbers), dtype=float)
        except TypeError:
            return False
        ours = subject.rates(state, push)
        if theirs.shape != ours.shape or not np.allclose(theirs, ours, rtol=1e-9, atol=0.0, equal_nan=True):
            return False
    return True
