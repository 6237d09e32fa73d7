"""Table of commands: name, module and one-line help; a module is imported when its command runs."""

from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from stylobate.cli.command import Command


class Entry(NamedTuple):
    """A command: its module, its name in the module, and the first line of its help."""

    module: str
    attribute: str
    summary: str

    def load(self) -> "Command":
        """Import the command."""
        command: Command = getattr(import_module(f"stylobate.cli.{self.module}"), self.attribute)
        return command


COMMANDS = {
    "simulate": Entry(
        "simulate", "simulate", "Integrate one column; under a record or a pulse also decide how surely it overturns."
    ),
    "hierarchy": Entry("hierarchy", "hierarchy", "Compare all models of the hierarchy in one case."),
    "response": Entry("response", "response", "Compute amplitude and phase of steady rolling against frequency."),
    "boundary": Entry("boundary", "boundary", "Compute the stability boundary of steady rolling over two parameters."),
    "map": Entry("map", "overturning_map", "Compute the overturning map over two parameters."),
    "basin": Entry("basin", "basin", "Compute basins of attraction over initial conditions, and their fractions."),
    "drift": Entry("drift", "drift", "Compute the mean transport velocity of a column on a vibrating base."),
    "upright": Entry("upright", "upright", "Decide whether a part on a vibrating base stays upright, rocks or falls."),
    "feeder": Entry(
        "feeder", "feeder", "Compute the sheet of a feeder: hops, speed, steepest track and posture of a part."
    ),
    "records": Entry("records", "records", "List ground-motion records, their components and their intensities."),
    "assess": Entry("assess", "assess", "Assess whether columns survive records, and how robust the answer is."),
    "spectrum": Entry("spectrum", "spectrum", "Compute overturning intervals of the amplitude, or rocking spectra."),
    "fragility": Entry(
        "fragility", "fragility", "Fit fragility curves: probability of each limit state versus intensity."
    ),
    "lab": Entry("lab", "lab", "Open the laboratory in the browser."),
    "paper": Entry("paper", "paper", "Reproduce the source paper: figures, measured claims, corrected misprints."),
}
