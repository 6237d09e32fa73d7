"""Contact history of a run: bars in one row for each kind of contact."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from stylobate.models import Contact
from stylobate.plots.style import BLACK, BLUE, GREY, ORANGE, SKY, VERMILION
from stylobate.results import Response

Floats = npt.NDArray[np.float64]

COLOURS = {
    Contact.RESTING: GREY,
    Contact.SLIDING: ORANGE,
    Contact.ROLLING: BLUE,
    Contact.SLIPPING: VERMILION,
    Contact.FLYING: SKY,
    Contact.JAMMED: BLACK,
}
_THICK = 0.64


@dataclass(frozen=True, slots=True)
class ContactHistory:
    """Kinds of contact of a run: `kinds`[i] between `edges`[i] and `edges`[i + 1] [s]."""

    edges: Floats
    kinds: npt.NDArray[np.integer]

    @classmethod
    def of(cls, run: Response) -> Self:
        """Return the contact history of a run, with changes at its events or, if there is no event, between samples."""
        time = run.data["time"].to_numpy()
        if run.sampler is None:
            return cls(time, run.data["contact"].to_numpy()[:-1])
        edges = np.unique(np.concatenate([time, [event.time for event in run.events]]).clip(time[0], time[-1]))
        return cls(edges, run.sample(0.5 * (edges[1:] + edges[:-1]))["contact"].to_numpy())

    @property
    def shown(self) -> list[Contact]:
        """The kinds that occur, in the order from resting to flight."""
        return [Contact(value) for value in np.unique(self.kinds).tolist()]

    def spans(self, kind: Contact) -> list[tuple[float, float]]:
        """Return begin and length of each stretch of a kind [s]."""
        changes = np.diff((self.kinds == kind).astype(np.int8), prepend=0, append=0)
        begins, ends = self.edges[changes == 1], self.edges[changes == -1]
        return list(zip(begins.tolist(), (ends - begins).tolist(), strict=True))


def draw_contact(axes: Axes, history: ContactHistory) -> None:
    """Draw the contact history, a row for each kind; the shortest intervals are visible as lines."""
    shown = history.shown
    for row, kind in enumerate(shown):
        look: dict[str, Any] = {"facecolor": COLOURS[kind], "edgecolor": COLOURS[kind], "linewidth": 0.6}
        axes.broken_barh(history.spans(kind), (row - 0.5 * _THICK, _THICK), **look)
    axes.set_yticks(range(len(shown)), [kind.name.lower() for kind in shown])
    axes.set_ylim(-0.6, len(shown) - 0.4)
    axes.grid(visible=False, axis="y")
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)
