"""Checks of planar against three-dimensional motion: `planar_rates`, `rates`, and the maps between the two."""

from collections.abc import Iterator

import numpy as np

from stylobate.models.consistency.samples import Subject

_STEP = 1e-4
_AGREE = 1e-6  # relative, above the error of the differences


def problems_of_maps(subject: Subject) -> Iterator[str]:
    """Yield a line if `tilt_of` does not return the tilt and the rate from which `start` makes a state."""
    c = subject.slenderness
    given = np.array([0.3 * c, -0.4 * c, 0.1 * c, 0.2 * c])
    state = subject.state((given[0], given[1]), (given[2], given[3]))
    found = np.array(subject.model.tilt_of(*state, *subject.numbers), dtype=float)
    if np.abs(found - given).max() > _AGREE * c:
        yield (
            "tilt_of: does not return the tilt and the rate from which start made the state "
            f"({_listed(given)} became {_listed(found)}). Return x, y, vx, vy, the rate in the time of the model."
        )


def problems_in_planes(subject: Subject) -> Iterator[str]:
    """Yield a line if `rates` along a line differ from `planar_rates`, at random states."""
    model, c = subject.model, subject.slenderness
    if model.planar_rates is None or model.from_plane is None:
        return
    random = subject.generator()
    for _ in range(40 if subject.thorough else 4):
        tilt = min(c * random.uniform(0.1, 2.0), 1.0) * random.choice([-1.0, 1.0])
        rate, horizontal = (c * random.uniform(-1.0, 1.0, 2)).tolist()
        vertical, azimuth = random.uniform(-0.5, 0.5), random.uniform(0.0, 2.0 * np.pi)
        line = (float(np.cos(azimuth)), float(np.sin(azimuth)))
        problem = _mapped_wrongly(subject, (tilt, rate), line) or _moved_wrongly(
            subject, (tilt, rate), line, (horizontal, vertical)
        )
        if problem:
            yield problem
            return


def _state(subject: Subject, motion: tuple[float, float], line: tuple[float, float]) -> np.ndarray:
    """Return the state of a tilt and its rate along a line."""
    assert subject.model.from_plane is not None
    return np.array(subject.model.from_plane(*motion, *line, *subject.numbers), dtype=float)


def _mapped_wrongly(subject: Subject, motion: tuple[float, float], line: tuple[float, float]) -> str:
    found = np.array(subject.model.tilt_of(*_state(subject, motion, line), *subject.numbers), dtype=float)
    if np.abs(found - np.outer(motion, line).ravel()).max() <= _AGREE * subject.slenderness:
        return ""
    return (
        f"from_plane{subject.origin('from_plane')}: does not return a state with the tilt {motion[0]:.3g} rad and the "
        f"rate {motion[1]:.3g} along ({_listed(np.array(line))}) (got {_listed(found)}). Make it agree with tilt_of."
    )


def _moved_wrongly(
    subject: Subject, motion: tuple[float, float], line: tuple[float, float], push: tuple[float, float]
) -> str:
    assert subject.model.planar_rates is not None
    (tilt, rate), side = motion, float(np.sign(motion[0]))
    falling, acceleration = subject.model.planar_rates(tilt, rate, side, *push, *subject.numbers)
    before, after = (_state(subject, (tilt + t * falling, rate + t * acceleration), line) for t in (-_STEP, _STEP))
    planar = (after - before) / (2.0 * _STEP)
    here = tuple(_state(subject, motion, line).tolist())
    spatial = subject.rates(here, (push[0] * line[0], push[0] * line[1], push[1]))
    error = np.abs(planar - spatial)
    if not np.isfinite(spatial).all() or error.max() <= _AGREE * (np.abs(spatial).max() + subject.slenderness):
        return ""
    worst = int(np.argmax(error))
    return (
        f"planar_rates: does not agree with rates{subject.origin('planar_rates')} "
        f"(rate of {subject.model.state_names[worst]} {planar[worst]:.4g}, not {spatial[worst]:.4g} as by rates, "
        f"at tilt {tilt:.3g} rad). Define planar_rates with the terms of rates, or set planar_rates = None."
    )


def _listed(values: np.ndarray) -> str:
    return ", ".join(f"{value:.4g}" for value in values)
