"""Which files of a folder hold accelerations."""

import re
from collections.abc import Iterable
from pathlib import Path

# Beside the accelerations of a download: velocities, displacements, the list of what was searched for.
_OTHER = re.compile(r".*\.[VD]T2|.*\.(?:VEL|DIS)\.(?:.*\.)?ASC|_SearchResults\.csv", re.IGNORECASE)


def accelerations_among(files: Iterable[Path]) -> list[Path]:
    """Return the files of a folder without those whose names say that they hold no accelerations.

    Left out are the velocities, displacements and search results of a PEER download (`.VT2`, `.DT2`,
    `_SearchResults.csv`), those of ESM and ITACA (`….VEL.MP.ASC`, `….DIS.MP.ASC`), and hidden files. Where nothing
    else is there, all are returned that are not hidden.

    >>> names = ["RSN1_A000.AT2", "RSN1_A000.VT2", "RSN1_A000.DT2.gz", "_SearchResults.csv", ".DS_Store"]
    >>> [path.name for path in accelerations_among(map(Path, names))]
    ['RSN1_A000.AT2']
    """
    shown = [path for path in files if not path.name.startswith(".")]
    return [path for path in shown if not _OTHER.fullmatch(path.name.removesuffix(".gz"))] or shown
