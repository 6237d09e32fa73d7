"""Presets: motions worth seeing, from `presets.toml` beside this file."""

import tomllib
from dataclasses import dataclass
from importlib.resources import files
from typing import Any


@dataclass(frozen=True, slots=True)
class Preset:
    """A description with a title, a line about it, and the outcome that it is to show."""

    identity: str
    title: str
    about: str
    outcome: str
    description: dict[str, Any]
    view: dict[str, Any]
    """How the page shows it: the start that is followed, the tab, what is drawn over time; by default as suits."""


def presets() -> tuple[Preset, ...]:
    """Return all presets, the first of them shown at the start."""
    text = (files("stylobate.lab") / "presets.toml").read_text(encoding="utf-8")
    return tuple(
        Preset(one["id"], one["title"], one["about"], one["outcome"], one["description"], one.get("view", {}))
        for one in tomllib.loads(text)["preset"]
    )
