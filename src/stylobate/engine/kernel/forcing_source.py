"""How a kernel evaluates the base motion: lines of source for one time in one lane, and the rows they read."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from stylobate.engine.kernel.layout import Rows


class ForcingSource(Protocol):
    """A kind of base motion that kernels can evaluate."""

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the accelerations: "ax" and "ay", or "ah" in a plane, and "az" where the base moves vertically."""

    @property
    def tag(self) -> str:
        """A short name for file names."""

    def reserve(self, rows: Rows) -> None:
        """Add the rows that the lines read."""

    def lines(self, at: Callable[[str], str], time: str) -> list[str]:
        """Return assignments of the accelerations [g] at the time that the expression gives; `at` names a row."""

    def series_lines(self, at: Callable[[str], str], order: int) -> list[str]:
        """Return assignments of the Taylor coefficients `ax_0`, `ax_1` … below `order` about the time `t`."""

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return what the driver must know to fill the rows."""

    @property
    def columns(self) -> int:
        """How many numbers describe the motion in the table of a batch."""


@dataclass(frozen=True, slots=True)
class Harmonics(ForcingSource):
    """A sum of harmonic terms: in each, one frequency, and an amplitude and phase for each component.

    Parameters
    ----------
    terms
        Number of terms.
    windowed
        Whether the terms may begin later or rise over a time: each is multiplied by α − β cos(window phase).
    components
        ("ax", "ay"), with "az" where the base moves vertically; in a plane "ah" in place of the two.
    """

    terms: int
    windowed: bool
    components: tuple[str, ...]

    @property
    def tag(self) -> str:
        """Such as `h1`, `h2w`; a vertical component shows as `z`."""
        return f"h{self.terms}{'w' * self.windowed}{'z' * ('az' in self.components)}"

    @property
    def columns(self) -> int:
        """Of each term the frequency, amplitude and phase along x, y, z; onset, begin and end of its rise."""
        return self.terms * (7 + 3 * self.windowed)

    def reserve(self, rows: Rows) -> None:
        """Add the rows of all the terms, those of one after those of another."""
        for term in range(self.terms):
            rows.add(f"turns{term}")
            for component in self.components:
                rows.add(f"{component}_amplitude{term}")
                rows.add(f"{component}_phase{term}")
            if self.windowed:
                for name in ("full", "depth", "window_turns", "window_phase"):
                    rows.add(f"{name}{term}")

    def lines(self, at: Callable[[str], str], time: str) -> list[str]:
        """Return the sums of a_i cos 2π(ft + φ_i)."""
        out = []
        for term in range(self.terms):
            out.append(f"turns = {at(f'turns{term}')} * ({time})")
            window = ""
            if self.windowed:
                full, depth, rate, phase = (
                    at(f"{name}{term}") for name in ("full", "depth", "window_turns", "window_phase")
                )
                out.append(f"window = {full} - {depth} * cos_turns({rate} * ({time}) + {phase})")
                window = " * window"
            for component in self.components:
                amplitude, phase = at(f"{component}_amplitude{term}"), at(f"{component}_phase{term}")
                value = f"{amplitude} * cos_turns(turns + {phase}){window}"
                out.append(f"{component} = {value}" if term == 0 else f"{component} = {component} + {value}")
        return out or [f"{component} = 0.0" for component in self.components]

    def series_lines(self, at: Callable[[str], str], order: int) -> list[str]:
        """Return the series of each wave: f″ = −ω²f gives every second coefficient from the one before."""
        out = []
        waves = [wave for term in range(self.terms) for wave in self._waves(at, term)]
        for number, (turns, phase, factor, term) in enumerate(waves):
            out += [f"turns = {turns}", "omega = 6.283185307179586 * turns", "square = -omega * omega"]
            out += [f"per{k} = square * {1.0 / (k * (k - 1))!r}" for k in range(2, order)]
            for component in self.components:
                out += [
                    f"angle = turns * t + {phase} + {at(f'{component}_phase{term}')}",
                    f"size = {factor}{at(f'{component}_amplitude{term}')}",
                    "wave0 = size * cos_turns(angle)",
                    "wave1 = -omega * size * cos_turns(angle - 0.25)",
                    *(f"wave{k} = per{k} * wave{k - 2}" for k in range(2, order)),
                ]
                for k in range(order):
                    name = f"{component}_{k}"
                    out.append(f"{name} = wave{k}" if number == 0 else f"{name} = {name} + wave{k}")
        return out or [f"{component}_{k} = 0.0" for component in self.components for k in range(order)]

    def _waves(self, at: Callable[[str], str], term: int) -> list[tuple[str, str, str, int]]:
        """Return frequency, phase and factor of the plain waves of a term: one that rises is the sum of three."""
        turns = at(f"turns{term}")
        if not self.windowed:
            return [(turns, "0.0", "", term)]
        full, depth, rate, phase = (at(f"{name}{term}") for name in ("full", "depth", "window_turns", "window_phase"))
        return [
            (turns, "0.0", f"{full} * ", term),
            (f"{turns} + {rate}", phase, f"-0.5 * {depth} * ", term),
            (f"{turns} - {rate}", f"(-{phase})", f"-0.5 * {depth} * ", term),
        ]

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return the number of terms, and how their rows lie."""
        return {
            "TERMS": self.terms,
            "WINDOWED": int(self.windowed),
            "FIRST_FORCING": rows["turns0"] if self.terms else 0,
            "FORCING_ROWS": 1 + 2 * len(self.components) + 4 * self.windowed,
            "DEGREE": -1,
        }


@dataclass(frozen=True, slots=True)
class Polynomials(ForcingSource):
    """A motion tabulated as one polynomial after another, all of the same `degree`; steps end where pieces do."""

    degree: int
    components: tuple[str, ...]

    @property
    def tag(self) -> str:
        """Such as `p1`, `p15`; a vertical component shows as `z`."""
        return f"p{self.degree}{'z' * ('az' in self.components)}"

    @property
    def columns(self) -> int:
        """Factor, cos and sin of a rotation, vertical factor, delay [s], first piece, number of pieces."""
        return 7

    def reserve(self, rows: Rows) -> None:
        """Add the rows of the present piece."""
        rows.add("middle")
        rows.add("per_half")
        for component in self.components:
            for power in range(self.degree + 1):
                rows.add(f"{component}{power}")

    def lines(self, at: Callable[[str], str], time: str) -> list[str]:
        """Return the polynomials by Horner's rule, in the time from the middle of the piece over half its length."""
        out = [f"u = (({time}) - {at('middle')}) * {at('per_half')}"]
        for component in self.components:
            out.append(f"{component} = {at(f'{component}{self.degree}')}")
            out += [
                f"{component} = {component} * u + {at(f'{component}{power}')}" for power in reversed(range(self.degree))
            ]
        return out

    def series_lines(self, at: Callable[[str], str], order: int) -> list[str]:
        """Return the polynomials expanded anew about the time `t`, by repeated synthetic division."""
        last = self.degree
        out = [f"u = (t - {at('middle')}) * {at('per_half')}", f"power1 = {at('per_half')}"]
        out += [f"power{k} = power{k - 1} * power1" for k in range(2, last + 1)]
        for component in self.components:
            out += [f"b{power} = {at(f'{component}{power}')}" for power in range(last + 1)]
            out += [f"b{j} = b{j} + u * b{j + 1}" for k in range(last) for j in range(last - 1, k - 1, -1)]
            out.append(f"{component}_0 = b0")
            out += [f"{component}_{k} = b{k} * power{k}" for k in range(1, min(last + 1, order))]
            out += [f"{component}_{k} = 0.0" for k in range(last + 1, order)]
        return out

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return the degree, and where the rows begin."""
        return {
            "TERMS": 0,
            "WINDOWED": 0,
            "FIRST_FORCING": rows["middle"],
            "FORCING_ROWS": self.degree + 1,
            "DEGREE": self.degree,
        }
