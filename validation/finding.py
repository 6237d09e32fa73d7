"""One comparison: a number of the package beside one of somebody else."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "docs" / "_static" / "validation"
"""Where tables and figures are written."""


class Kind(Enum):
    """What kind of number the package is compared with, and how far it may differ."""

    MATHEMATICS = 1e-6
    """A closed form, or a number that a reference states to many digits."""
    CODE = 1e-2
    """The result of another program, with its own errors of discretisation."""
    EXPERIMENT = math.inf
    """A measurement: judged by statistics, which the finding states in words."""
    RULE = "rule"
    """A rule of practice, which may be right, strict or unsafe: what it costs is stated, not judged."""
    DATA = "data"
    """A check of published data for laws that they must obey."""
    REGRESSION = "regression"
    """The result of an earlier version of this package, which a later one must reach."""


@dataclass(frozen=True, slots=True)
class Finding:
    """A number of the package beside one of somebody else.

    Parameters
    ----------
    source
        Whose number it is: author, title or address, and where in it.
    compared
        What is compared, in words, with units.
    theirs, ours
        The two numbers.
    kind
        What kind of number theirs is.
    scale
        What the difference is divided by; by default the larger of the two numbers.
    allowed
        Largest difference that agrees, if it is not that of the kind, such as half of the last digit that is given.
    remark
        How the number was obtained, or what explains a difference.
    """

    source: str
    compared: str
    theirs: float
    ours: float
    kind: Kind
    scale: float | None = None
    allowed: float | None = None
    remark: str = ""

    @property
    def difference(self) -> float:
        """Difference of the two numbers over `scale`."""
        scale = max(abs(self.theirs), abs(self.ours)) if self.scale is None else self.scale
        return abs(self.ours - self.theirs) / scale if scale else 0.0

    @property
    def bound(self) -> float:
        """Largest difference that agrees; infinite for a measurement, which is judged by its remark."""
        if self.allowed is not None:
            return self.allowed
        return self.kind.value if isinstance(self.kind.value, float) else math.inf

    @property
    def judged(self) -> bool:
        """Whether a bound judges the difference."""
        return math.isfinite(self.bound)

    @property
    def agrees(self) -> bool:
        """Whether the difference is allowed."""
        return self.difference <= self.bound

    @property
    def verdict(self) -> str:
        """The kind of number, with the bound and whether it is kept."""
        if not self.judged:
            return self.kind.name.lower()
        bound = f"{self.bound:.2g}{' absolute' if self.scale == 1.0 else ''}"
        return f"{self.kind.name.lower()}, {bound}: {'agrees' if self.agrees else '**differs**'}"


def table(findings: Iterable[Finding]) -> str:
    """Return a table in Markdown with a row for each finding."""
    head = "| source | compared | theirs | here | difference | class |\n|---|---|---|---|---|---|\n"
    rows = (
        f"| {one.source} | {one.compared}{f'; {one.remark}' if one.remark else ''} | {one.theirs:.6g} | {one.ours:.6g} "
        f"| {one.difference:.1e} | {one.verdict} |\n"
        for one in findings
    )
    return head + "".join(rows)
