"""Presets: example motions, from `presets.toml` beside this file."""

import tomllib
from dataclasses import dataclass
from importlib.resources import files
from typing import Any


@dataclass(frozen=True, slots=True)
class Preset:
    """A description with a title, a one-line comment, and the expected outcome."""

    identity: str
    title: str
    about: str
    outcome: str
    description: dict[str, Any]
    view: dict[str, Any]
    """View on the page: branch of the initial conditions, tab, quantities over time; by default chosen by the page."""


def presets() -> tuple[Preset, ...]:
    """Return all presets; the page opens with the first one."""
    text = (files("stylobate.lab") / "presets.toml").read_text(encoding="utf-8")
    return tuple(
        Preset(one["id"], one["title"], one["about"], one["outcome"], one["description"], one.get("view", {}))
        for one in tomllib.loads(text)["preset"]
    )
