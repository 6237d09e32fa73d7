"""Progress of the paper's check on stderr: sections done, sections in all, and the time that remains."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def sections_done() -> Iterator[Callable[[str, int, int, float], None]]:
    """Give a function that shows the sections done; a line each where stderr is no terminal."""
    from rich.console import Console  # noqa: PLC0415  heavy imports wait until the options are read
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn  # noqa: PLC0415

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[state]}"), TimeElapsedColumn())
    shown = sys.stderr.isatty()
    with Progress(*columns, console=Console(stderr=True), transient=True, disable=not shown) as bar:
        task = bar.add_task("checking the paper", total=1.0, state="")
        begun: list[tuple[float, float]] = []

        def advance(heading: str, done: int, total: int, fraction: float) -> None:
            begun.append((time.monotonic(), fraction))
            state = f"{done}/{total}{remaining(begun)}"
            bar.update(task, completed=fraction, description=heading or "checking the paper", state=state)
            if not shown:
                print(f"stylobate: {state}{heading and ': '}{heading}", file=sys.stderr)

        yield advance


def remaining(moments: list[tuple[float, float]]) -> str:
    """Return the time that remains in words, from moments [s] and the fraction of the work done at each.

    >>> remaining([(0.0, 0.25), (10.0, 0.5)])
    ', about 20 s remaining'
    >>> remaining([(0.0, 0.25)]), remaining([(0.0, 0.25), (10.0, 1.0)])
    ('', '')
    """
    (begun, before), (now, done) = moments[0], moments[-1]
    if not before < done < 1.0:
        return ""
    return f", about {(now - begun) * (1.0 - done) / (done - before):.0f} s remaining"
