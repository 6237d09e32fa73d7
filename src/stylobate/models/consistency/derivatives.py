"""Check of `jacobian` against differences of `rates`."""

from collections.abc import Iterator

import numpy as np

from stylobate.models.consistency.samples import Subject

_AGREE = 1e-5  # relative, above the error of central differences


def problems_of_derivatives(subject: Subject) -> Iterator[str]:
    """Yield a line if an entry of `jacobian` is not the derivative of a rate."""
    model, c = subject.model, subject.slenderness
    if model.jacobian is None:
        return
    for state in subject.random_states(4):
        point = np.array([*state, 0.2 * c, -0.3 * c, 0.1, *subject.numbers])
        found = np.array(model.jacobian(*point.tolist()), dtype=float)
        expected = np.stack([_difference(subject, point, place) for place in range(point.size)], axis=1)
        if found.shape != expected.shape:
            yield f"jacobian: has the shape {found.shape}, not {expected.shape}. Return a row for each state."
            return
        error = np.abs(found - expected) / (1.0 + np.abs(expected))
        if error.max() > _AGREE:
            row, place = np.unravel_index(int(np.argmax(error)), error.shape)
            yield (
                f"jacobian: entry ({row}, {place}) is not the derivative of rates{subject.origin('jacobian')} "
                f"({found[row, place]:.6g}, not {expected[row, place]:.6g}). Define it for these rates, or set "
                "jacobian = None."
            )
            return


def _difference(subject: Subject, point: np.ndarray, place: int) -> np.ndarray:
    step = 1e-5 * max(abs(point[place]), subject.slenderness)
    ahead, behind = point.copy(), point.copy()
    ahead[place] += step
    behind[place] -= step
    rates = [np.array(subject.model.rates(*one.tolist()), dtype=float) for one in (ahead, behind)]
    found: np.ndarray = (rates[0] - rates[1]) / (2.0 * step)
    return found
