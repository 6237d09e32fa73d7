"""Kinds of model and base motion that a command line chooses, including user-defined classes by their file."""

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
        Kinds by part, "model" or "motion"; a part without a chosen kind is missing.
    classes
        User-defined classes among these kinds, by part.
    """

    kinds: Mapping[str, str] = field(default_factory=dict)
    classes: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, kinds: Mapping[str, str], folder: Path = Path()) -> "Chosen":
        """Load user-defined classes among these kinds, such as "mine.py:Tethered"; paths are relative to `folder`.

        Raises
        ------
        ParameterError
            If a file has no such class.
        """
        if not any(":" in kind for kind in kinds.values()):
            return cls(kinds)
        from stylobate.base_motions.declared import MOTIONS  # noqa: PLC0415  heavy imports wait until they are needed
        from stylobate.kinds import with_places  # noqa: PLC0415
        from stylobate.models.declared import MODELS  # noqa: PLC0415

        registries = {"model": MODELS, "motion": MOTIONS}
        placed = {part: with_places({"kind": kind}, folder)["kind"] for part, kind in kinds.items()}
        return cls(placed, {part: registries[part][kind] for part, kind in placed.items() if ":" in kind})
