"""Check of the source paper: measurement of every claim, and data of its figures.

"Dynamic of a cylindrical column on a vibrating base" (Vibroengineering Procedia).
"""

import tempfile
from collections.abc import Callable, Generator, Mapping
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from stylobate.paper.analyses.circular import check_circular, check_exact
from stylobate.paper.analyses.finished import FinishedAnalyses
from stylobate.paper.analyses.free import check_free, check_standing
from stylobate.paper.analyses.modulated import check_modulated
from stylobate.paper.analyses.planar import check_planar
from stylobate.paper.analyses.straight import check_straight
from stylobate.paper.analyses.twist import check_twist
from stylobate.processes import computed
from stylobate.progress import News, Progress, report_of, shows_progress
from stylobate.results.findings import PaperCheck, PaperSection

__all__ = ["check_paper"]


@dataclass(frozen=True, slots=True)
class _Analysis:
    """Check of one section of the paper, and its typical processor time [s]."""

    check: Callable[[], PaperSection]
    cost: float


# In the order of the paper.
_ANALYSES: Mapping[str, _Analysis] = {
    "Free vibration": _Analysis(check_free, 3.0),
    "Circular base motion": _Analysis(check_circular, 2.0),
    "Below the critical frequency": _Analysis(check_modulated, 60.0),
    "Free spin": _Analysis(check_twist, 8.0),
    "Straight-line base motion": _Analysis(check_straight, 30.0),
    "Exact periodic orbits": _Analysis(check_exact, 40.0),
    "Planar motion": _Analysis(check_planar, 3.0),
    "The standing column": _Analysis(check_standing, 1.0),
}


def _in_sections(heading: str, done: int, total: int, fraction: float) -> News:
    return News(heading, f"{done}/{total}", fraction, 1.0)


@shows_progress("checking the paper", _in_sections)
def check_paper(
    *,
    workers: int = 1,
    progress: Progress = None,
    folder: str | Path | None = None,
) -> PaperCheck:
    """Check every claim of the source paper and compute its figures.

    Parameters
    ----------
    workers
        Number of processes; with 1 everything runs in this process.
    progress
        A function that is called after each section with its heading, the number of finished sections, the total
        number, and the finished fraction of the work; a bar by default, False for none. The first call has an empty
        heading and reports the sections of an earlier call.
    folder
        Folder that stores each finished section, in `analyses`. A later call with the same versions of stylobate and
        its libraries reads the section from there, so that an interrupted check resumes.

    Returns
    -------
    PaperCheck
        Findings and data; `stylobate.paper.report` draws them.

    Raises
    ------
    FileError
        If the folder cannot be written.
    WorkerLostError
        If a process ends without a result.
    """
    with tempfile.TemporaryDirectory(prefix="stylobate-") as passing:
        kept = FinishedAnalyses(Path(passing if folder is None else folder) / "analyses")
        done = {heading: section for heading in _ANALYSES if (section := kept.read(heading)) is not None}

        def advance(heading: str) -> None:
            cost, whole = (sum(_ANALYSES[heading].cost for heading in some) for some in (done, _ANALYSES))
            report_of(progress)(heading, len(done), len(_ANALYSES), cost / whole)

        advance("")
        with closing(_computed([heading for heading in _ANALYSES if heading not in done], workers)) as sections:
            for heading, section in sections:
                # Read back, so that the report does not depend on when the section was computed.
                done[heading] = kept.write(heading, section)
                advance(heading)
    return PaperCheck({heading: done[heading] for heading in _ANALYSES})


def _computed(headings: list[str], workers: int) -> Generator[tuple[str, PaperSection], None, None]:
    if workers == 1:
        for heading in headings:
            yield heading, _ANALYSES[heading].check()
        return
    # The longest first, so that the processes end at similar times.
    order = sorted(headings, key=lambda heading: -_ANALYSES[heading].cost)
    yield from computed({heading: _ANALYSES[heading].check for heading in order}, workers=workers)
