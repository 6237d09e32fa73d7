"""Pack the built documentation with its laboratory into one archive: `python tools/site_archive.py docs/_build/html`.

The archive holds one folder whose `index.html` opens from disk, without a server. The same files give the same bytes.
"""

import sys
import zipfile
from importlib.metadata import version
from pathlib import Path

# Files that only the next build reads.
_LEFT_OUT = (".doctrees/", ".buildinfo")
_NEEDED = ("index.html", "searchindex.js", "laboratory/laboratory.html")
_DATE = (1980, 1, 1, 0, 0, 0)  # the first that a ZIP can state


def pack(site: Path, into: Path, name: str) -> Path:
    """Write the archive of a folder, with `name` as the folder in it; return its path.

    Raises
    ------
    SystemExit
        If the folder lacks the first page, the index of the search or the laboratory.
    """
    missing = [one for one in _NEEDED if not (site / one).is_file()]
    if missing:
        raise SystemExit(f"{site} has no {', '.join(missing)}. Run make site, with Node 20 or newer.")
    paths = sorted(path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file())
    archive = into / f"{name}.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for path in paths:
            if not path.startswith(_LEFT_OUT):
                entry = zipfile.ZipInfo(f"{name}/{path}", _DATE)
                entry.compress_type = zipfile.ZIP_DEFLATED
                entry.external_attr = 0o644 << 16
                packed.writestr(entry, (site / path).read_bytes())
    return archive


if __name__ == "__main__":
    made = pack(Path(sys.argv[1]), Path.cwd(), f"stylobate-{version('stylobate')}-docs")
    print(f"{made.name}: {made.stat().st_size / 1e6:.0f} MB; unpack it, and open index.html")
