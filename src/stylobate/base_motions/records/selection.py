"""Selection of acceleration files in a folder of records."""

import re
from collections.abc import Iterable
from pathlib import Path

# Other files of a download: velocities, displacements and search results.
_OTHER = re.compile(r".*\.[VD]T2|.*\.(?:VEL|DIS)\.(?:.*\.)?ASC|_SearchResults\.csv", re.IGNORECASE)


def accelerations_among(files: Iterable[Path]) -> list[Path]:
    """Return the files of a folder except files whose names denote other data than accelerations.

    The result excludes velocities, displacements and search results of a PEER download (`.VT2`, `.DT2`,
    `_SearchResults.csv`), velocities and displacements of ESM and ITACA (`….VEL.MP.ASC`, `….DIS.MP.ASC`), and hidden
    files. If nothing else remains, all files that are not hidden are returned.

    >>> names = ["RSN1_A000.AT2", "RSN1_A000.VT2", "RSN1_A000.DT2.gz", "_SearchResults.csv", ".DS_Store"]
    >>> [path.name for path in accelerations_among(map(Path, names))]
    ['RSN1_A000.AT2']
    """
    shown = [path for path in files if not path.name.startswith(".")]
    return [path for path in shown if not _OTHER.fullmatch(path.name.removesuffix(".gz"))] or shown
