"""Kinds of base motion that kernels evaluate, and the buffer rows of their coefficients; see `driver/push`."""

from dataclasses import dataclass
from typing import Protocol

from stylobate.engine.kernel.columns import Tabulated, Wave
from stylobate.engine.kernel.layout import Rows


class KernelForcing(Protocol):
    """A kind of base motion that kernels can evaluate."""

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the accelerations: "ax" and "ay", or "ah" if planar, and "az" if the base moves vertically."""

    @property
    def tag(self) -> str:
        """Short name for file names."""

    def reserve(self, rows: Rows) -> None:
        """Add the rows of the coefficients."""

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return the constants that the driver needs to fill the rows."""

    @property
    def columns(self) -> int:
        """Number of columns that describe the motion in the table of a batch."""


@dataclass(frozen=True, slots=True)
class Harmonics(KernelForcing):
    """Sum of harmonic terms, each with one frequency, and an amplitude and phase for each component.

    Parameters
    ----------
    terms
        Number of terms.
    windowed
        Whether the terms may begin later or rise over a time: each is multiplied by α − β cos(window phase).
    components
        ("ax", "ay"), or ("ah",) if planar; with "az" if the base moves vertically.
    """

    terms: int
    windowed: bool
    components: tuple[str, ...]

    @property
    def tag(self) -> str:
        """Short name such as `h1`, `h2w`; `z` marks a vertical component."""
        return f"h{self.terms}{'w' * self.windowed}{'z' * ('az' in self.components)}"

    @property
    def columns(self) -> int:
        """Number of columns, those of `Wave` for each term."""
        return self.terms * (len(Wave) if self.windowed else Wave.ONSET)

    def reserve(self, rows: Rows) -> None:
        """Add the rows of all terms, term by term."""
        for term in range(self.terms):
            rows.add(f"turns{term}")
            for component in self.components:
                rows.add(f"{component}_amplitude{term}")
                rows.add(f"{component}_phase{term}")
            if self.windowed:
                for name in ("full", "depth", "window_turns", "window_phase"):
                    rows.add(f"{name}{term}")

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return the number of terms and the layout of their rows."""
        return {
            "TERMS": self.terms,
            "WINDOWED": int(self.windowed),
            "FIRST_FORCING": rows["turns0"] if self.terms else 0,
            "FORCING_ROWS": 1 + 2 * len(self.components) + 4 * self.windowed,
            "DEGREE": -1,
        }


@dataclass(frozen=True, slots=True)
class Polynomials(KernelForcing):
    """Motion tabulated as successive polynomials of the same `degree`; steps end where the pieces end."""

    degree: int
    components: tuple[str, ...]

    @property
    def tag(self) -> str:
        """Short name such as `p1`, `p15`; `z` marks a vertical component."""
        return f"p{self.degree}{'z' * ('az' in self.components)}"

    @property
    def columns(self) -> int:
        """Number of columns, those of `Tabulated`."""
        return len(Tabulated)

    def reserve(self, rows: Rows) -> None:
        """Add the rows of the present piece."""
        rows.add("middle")
        rows.add("per_half")
        for component in self.components:
            for power in range(self.degree + 1):
                rows.add(f"{component}{power}")

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return the degree and the first row."""
        return {
            "TERMS": 0,
            "WINDOWED": 0,
            "FIRST_FORCING": rows["middle"],
            "FORCING_ROWS": self.degree + 1,
            "DEGREE": self.degree,
        }
