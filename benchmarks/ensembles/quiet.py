"""Waiting for an idle machine."""

import time
from pathlib import Path

_STAT = Path("/proc/stat")
_IDLE_ENOUGH = 0.9
_LOOK = 0.5


def wait_for_quiet(patience: float = 20.0) -> bool:
    """Wait until the cores are idle, at most about `patience` [s]; return whether they are. Linux only."""
    if not _STAT.exists():
        return True
    waited = 0.0
    while waited < patience:
        before = _ticks()
        time.sleep(_LOOK)
        idle, total = (now - then for now, then in zip(_ticks(), before, strict=True))
        if idle > _IDLE_ENOUGH * total:
            return True
        waited += _LOOK
    return False


def _ticks() -> tuple[int, int]:
    """Return the idle clock ticks and all clock ticks, summed over the cores."""
    ticks = [int(word) for word in _STAT.read_text(encoding="ascii").splitlines()[0].split()[1:]]
    return ticks[3] + ticks[4], sum(ticks)
