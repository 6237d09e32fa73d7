"""What a wheel needs besides its Python files: the laboratory's page and the viewer, bundled with Node where it is."""

import shutil
import subprocess
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_WEB = Path("src/stylobate/lab/web")
_MADE = (Path("src/stylobate/lab/page/index.html"), Path("src/stylobate/plots/animation/viewer.js"))


class Bundles(BuildHookInterface):
    """Makes the bundles before they are packed; without Node a wheel goes without them and says so when it is used."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make what is missing; nothing for an editable installation, where `make page` does."""
        del build_data
        root = Path(self.root)
        if version == "editable" or all((root / made).is_file() for made in _MADE):
            return
        npm = shutil.which("npm")
        if npm is None:
            self.app.display_warning("Node is missing: this build is without the laboratory's page and the viewer")
            return
        try:
            for command in (["ci", "--no-audit", "--no-fund"], ["run", "build"]):
                subprocess.run([npm, *command], cwd=root / _WEB, check=True)  # noqa: S603  fixed arguments
        except subprocess.CalledProcessError as error:
            told = "the laboratory's page and the viewer could not be built; this build is without them"
            self.app.display_warning(f"{told}: {error}")
