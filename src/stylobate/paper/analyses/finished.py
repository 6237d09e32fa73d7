"""Storage of finished sections of the paper's check for reuse by a later check."""

import hashlib
import json
import sys
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path

import xarray as xr

from stylobate.errors import FileError
from stylobate.results.findings import ClaimStatus, Finding, PaperSection
from stylobate.results.keyed_store import KeyedStore

_FINDINGS = "findings"


@dataclass(frozen=True, slots=True)
class FinishedAnalyses:
    """Sections by heading in a folder, each stored with the fingerprint of the code that computed it."""

    folder: Path

    def read(self, heading: str) -> PaperSection | None:
        """Read the section with this heading; None if it is missing, damaged or from other code."""
        tree = KeyedStore(self.folder).read(heading, {"code": fingerprint()})
        if tree is None:
            return None
        findings = json.loads(tree.attrs[_FINDINGS])
        found = tuple(
            Finding(where, what, measured, ClaimStatus[verdict]) for where, what, measured, verdict in findings
        )
        return PaperSection(found, {str(name): child.to_dataset() for name, child in tree.children.items()})

    def write(self, heading: str, section: PaperSection) -> PaperSection:
        """Store a section in place of earlier ones; return the stored section.

        Raises
        ------
        FileError
            If the folder cannot be written.
        """
        tree = xr.DataTree.from_dict({f"/{name}": data for name, data in section.data.items()})
        findings = [(f.source, f.statement, f.measured, f.verdict.name) for f in section.findings]
        tree.attrs = {_FINDINGS: json.dumps(findings, ensure_ascii=False)}
        KeyedStore(self.folder).write(heading, {"code": fingerprint()}, tree, replace=True)
        kept = self.read(heading)
        if kept is None:
            raise FileError(f"cannot read {heading!r} in {self.folder}, which has just been written. Check the disk")
        return kept


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
