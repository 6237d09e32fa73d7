"""The source paper, checked: every claim measured, the data of its figures.

"Dynamic of a cylindrical column on a vibrating base" (Vibroengineering Procedia).
"""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context

from stylobate.results import PaperCheck, Section
from stylobate.studies.paper.circular import check_circular
from stylobate.studies.paper.exact import check_exact
from stylobate.studies.paper.free import check_free
from stylobate.studies.paper.modulated import check_modulated
from stylobate.studies.paper.planar import check_planar
from stylobate.studies.paper.standing import check_standing
from stylobate.studies.paper.straight import check_straight
from stylobate.studies.paper.twist import check_twist

__all__ = ["check_paper"]

# In the order of the paper.
_SECTIONS: Mapping[str, Callable[[], Section]] = {
    "Free vibration": check_free,
    "Circular base motion": check_circular,
    "Below the critical frequency": check_modulated,
    "A column that may turn": check_twist,
    "Straight-line base motion": check_straight,
    "Exact periodic orbits": check_exact,
    "Motion in a plane": check_planar,
    "The standing column": check_standing,
}
# The longest first, so that two processes end together.
_SLOWEST_FIRST = ("Exact periodic orbits", "Straight-line base motion", "Below the critical frequency")


def check_paper(*, workers: int = 1, progress: Callable[[str, int, int], None] | None = None) -> PaperCheck:
    """Check every claim of the source paper and compute its figures.

    Parameters
    ----------
    workers
        Processes to use; with 1 everything runs in this one.
    progress
        Called with the heading of each section that is done, how many are done and how many there are.

    Returns
    -------
    PaperCheck
        Findings and data; `stylobate.plots.paper_report` draws them.
    """
    done: dict[str, Section] = {}
    for heading, section in _computed(workers):
        done[heading] = section
        if progress is not None:
            progress(heading, len(done), len(_SECTIONS))
    return PaperCheck({heading: done[heading] for heading in _SECTIONS})


def _computed(workers: int) -> Iterator[tuple[str, Section]]:
    if workers == 1:
        for heading, check in _SECTIONS.items():
            yield heading, check()
        return
    order = sorted(_SECTIONS, key=lambda heading: heading not in _SLOWEST_FIRST)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        futures = {pool.submit(_SECTIONS[heading]): heading for heading in order}
        for future in as_completed(futures):
            yield futures[future], future.result()
