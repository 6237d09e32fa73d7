"""The laboratory's page and the viewer: bundled with Node, packed only if they were built from the sources packed."""

import hashlib
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_WEB = "src/stylobate/lab/web"
_PAGE = "src/stylobate/lab/page"
_BUNDLES = (
    *(f"{_PAGE}/{name}.js" for name in ("main", "worker", "offline")),
    "src/stylobate/plots/animation/viewer.js",
)
_PACKED = [f"{_PAGE}/*", "src/stylobate/plots/animation/viewer.js"]
_WITHOUT = "STYLOBATE_WITHOUT_PAGE"


class Bundles(BuildHookInterface):
    """Pack the bundles; an editable installation needs none of them until `make page`."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build missing or stale bundles; without them end the build, unless that is wanted."""
        if version == "editable":
            return
        if os.environ.get(_WITHOUT) == "1":
            self.app.display_warning(f"{_WITHOUT}=1: this build is without the laboratory's page and the viewer")
            return
        root = Path(self.root)
        if not _is_current(root):
            _bundle(root / _WEB)
        if not _is_current(root):
            self.app.abort(
                "the laboratory's page: missing, or built from other sources than these. Install Node 20 or newer and "
                f"build again, or set {_WITHOUT}=1 to build without the page and the viewer."
            )
        build_data["artifacts"] += _PACKED


def sources_digest(web: Path) -> str:
    """Return the SHA-256 of the files of a folder and below its src, as digest.mjs computes it."""
    files = [path for path in (*web.iterdir(), *(web / "src").rglob("*")) if path.is_file() and path.name[0] != "."]
    total = hashlib.sha256()
    for name, path in sorted((path.relative_to(web).as_posix(), path) for path in files):
        total.update(f"{name} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()


def _is_current(root: Path) -> bool:
    """Return whether the first line of each bundle states the digest of the present sources."""
    first_line = f"/*! sources {sources_digest(root / _WEB)} */\n".encode()
    return all(path.is_file() and path.read_bytes().startswith(first_line) for path in map(root.joinpath, _BUNDLES))


def _bundle(web: Path) -> None:
    """Build the bundles if npm is installed; Node prints its own errors."""
    npm = shutil.which("npm")
    for command in (["ci", "--no-audit", "--no-fund"], ["run", "build"]) if npm else ():
        if subprocess.run([npm, *command], cwd=web, check=False).returncode:  # noqa: S603  fixed arguments
            return
