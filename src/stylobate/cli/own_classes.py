"""The kinds of model and base motion that a command line chooses, those of a user's own by their place among them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


@dataclass(frozen=True, slots=True)
class Chosen:
    """The kinds that a command line and its file choose.

    Parameters
    ----------
    kinds
        By part, "model" or "motion"; a part whose kind is not chosen is missing.
    classes
        The classes of a user's own among them, by part.
    """

    kinds: Mapping[str, str] = field(default_factory=dict)
    classes: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, kinds: Mapping[str, str], folder: Path = Path()) -> "Chosen":
        """Load the classes among these kinds, such as "mine.py:Tethered"; their files are relative to `folder`.

        Raises
        ------
        ParameterError
            If a place holds no such class.
        """
        if not any(":" in kind for kind in kinds.values()):
            return cls(kinds)
        from stylobate.base_motions.declared import MOTIONS  # noqa: PLC0415  heavy imports wait until they are needed
        from stylobate.kinds import with_places  # noqa: PLC0415
        from stylobate.models.declared import MODELS  # noqa: PLC0415

        registries = {"model": MODELS, "motion": MOTIONS}
        placed = {part: with_places({"kind": kind}, folder)["kind"] for part, kind in kinds.items()}
        return cls(placed, {part: registries[part][kind] for part, kind in placed.items() if ":" in kind})
