"""Describe base motions by the declarations of their numbers; the key `kind` chooses the motion."""

import inspect
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.declared import MOTIONS
from stylobate.config.declared import config_of_kind, one_of
from stylobate.config.description import Config
from stylobate.config.records import RecordMotion
from stylobate.kinds import Place, with_places
from stylobate.provenance import values_of_motion
from stylobate.quantities import states


class DescribedMotion(Config):
    """A base motion by the numbers of its kind."""

    kind: str

    def build(self) -> BaseMotion:
        """Return the motion."""
        motion: BaseMotion = self.make(**self._numbers())
        return motion

    def _numbers(self) -> dict[str, Any]:
        return {name: value for name, value in self if name not in ("kind", "motion", "motions")}


class MotionOfMotions(DescribedMotion):
    """Several motions, and numbers."""

    motions: tuple["MotionConfig", ...]

    def build(self) -> BaseMotion:
        """Return the motion."""
        motion: BaseMotion = self.make(motions=tuple(one.build() for one in self.motions), **self._numbers())
        return motion


class ChangedMotion(DescribedMotion):
    """Another motion, and numbers of its change: by a method of the motion, or by a user's own class."""

    motion: "MotionConfig"

    def build(self) -> BaseMotion:
        """Return the motion."""
        inner = self.motion.build()
        change = self.make if isinstance(self.make, type) else getattr(inner, self.make.__name__)
        of = {"motion": inner} if isinstance(self.make, type) else {}
        motion: BaseMotion = change(**of, **self._numbers())
        return motion


def _config(kind: str, make: Callable[..., Any]) -> type[Config]:
    """Return the description class of a kind of motion; that of a record reads files."""
    if make is Record:
        return RecordMotion
    arguments = inspect.signature(make).parameters
    several, changed = "motions" in arguments, "motion" in arguments or "self" in arguments
    base = MotionOfMotions if several else ChangedMotion if changed else DescribedMotion
    return config_of_kind(base, "kind", kind, make)


def _of_own(place: Place) -> type[Config]:
    """Return the description class of a user's own motion."""
    return _config(place, MOTIONS[place])


_BY_KIND = {kind: _config(kind, make) for kind, make in MOTIONS.items()}

if TYPE_CHECKING:
    MotionConfig = DescribedMotion
else:
    MotionConfig = one_of(_BY_KIND.values(), "kind", _of_own)

for _one in _BY_KIND.values():
    _one.model_rebuild()

AT_REST: Any = _BY_KIND["rest"].parse({"kind": "rest"})
"""The description of a base at rest."""


def is_to_end(motion: object) -> bool:
    """Return whether a `motion`, described or in plain values, ends.

    Its class states so by `ends`; a motion made of motions ends if all of them end.
    """
    values = dict(motion) if isinstance(motion, (Mapping, Config)) else {}
    members = values.get("motions", [values["motion"]] if "motion" in values else None)
    if members is not None:
        return isinstance(members, (list, tuple)) and bool(members) and all(is_to_end(one) for one in members)
    make = motion.make if isinstance(motion, Config) else made_by(values.get("kind"))
    return states(make, "ends")


def made_by(kind: object) -> Callable[..., Any] | None:
    """Return the class or constructor of a kind of motion in plain values; None for an unknown kind."""
    return MOTIONS[kind] if isinstance(kind, Place) or (isinstance(kind, str) and kind in MOTIONS) else None


def describe_motion(motion: BaseMotion) -> Config:
    """Return the description of `motion`; raise UnsupportedError if there is none."""
    values = with_places(values_of_motion(motion))
    kind = values["kind"]
    config = _BY_KIND[kind] if kind in _BY_KIND else _of_own(kind)
    return config.parse({**values, "kind": str(kind)})
