"""Storage of finished sections of the paper's check for reuse by a later check."""

import hashlib
import json
import re
import sys
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path

import xarray as xr

from stylobate.errors import FileError
from stylobate.results import ClaimStatus, Finding, Section, write_netcdf
from stylobate.results.storage import read_tree

_FINDINGS = "findings"


@dataclass(frozen=True, slots=True)
class FinishedAnalyses:
    """Sections by heading in a folder, one netCDF file each, named with the fingerprint of the code."""

    folder: Path

    def read(self, heading: str) -> Section | None:
        """Read the section with this heading; None if it is missing, damaged or from other code."""
        try:
            tree = read_tree(self._file(heading))
        except FileError:
            return None
        if _FINDINGS not in tree.attrs:
            return None
        findings = json.loads(tree.attrs[_FINDINGS])
        found = tuple(
            Finding(where, what, measured, ClaimStatus[verdict]) for where, what, measured, verdict in findings
        )
        return Section(found, {str(name): child.to_dataset() for name, child in tree.children.items()})

    def write(self, heading: str, section: Section) -> Section:
        """Store a section in place of earlier ones; return the stored section.

        Raises
        ------
        FileError
            If the folder cannot be written.
        """
        tree = xr.DataTree.from_dict({f"/{name}": data for name, data in section.data.items()})
        findings = [(f.source, f.statement, f.measured, f.verdict.name) for f in section.findings]
        tree.attrs = {_FINDINGS: json.dumps(findings, ensure_ascii=False)}
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            for earlier in self.folder.glob(f"{_slug(heading)}-*.nc"):
                earlier.unlink()
        except OSError as error:
            raise FileError(f"cannot write into {self.folder}: {error.strerror or error}") from None
        write_netcdf(tree, self._file(heading))
        kept = self.read(heading)
        if kept is None:
            raise FileError(f"cannot read {self._file(heading)}, which has just been written. Check the disk")
        return kept

    def _file(self, heading: str) -> Path:
        return self.folder / f"{_slug(heading)}-{fingerprint()}.nc"


@cache
def fingerprint() -> str:
    """Return a digest of the dependencies of the check: the text of stylobate and the numerical libraries."""
    digest = hashlib.sha256(sys.version.encode())
    for library in ("numpy", "scipy", "llvmlite", "xarray"):
        digest.update(f"{library} {version(library)}\n".encode())
    package = Path(__file__).parents[2]
    for path in sorted(package.rglob("*.py")):
        digest.update(str(path.relative_to(package)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def _slug(heading: str) -> str:
    return re.sub(r"\W+", "-", heading.lower())
