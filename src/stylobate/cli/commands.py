"""Table of commands: name, module and one-line help; a module is imported when its command runs."""

from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from stylobate.cli.command import Command


class Entry(NamedTuple):
    """A command: the place of its function, and the first line of its help."""

    place: str
    summary: str

    def load(self) -> "Command":
        """Import the command; that of a study is made from the declaration of the study."""
        module, _, attribute = self.place.partition(":")
        found: Any = getattr(import_module(f"stylobate.{module}"), attribute)
        if hasattr(found, "study"):
            from stylobate.cli.study import study_command

            found = study_command(found)
        command: Command = found
        return command


COMMANDS = {
    "simulate": Entry(
        "cli.simulate:simulate", "Integrate one column; under a record or a pulse also decide how surely it overturns."
    ),
    "hierarchy": Entry("studies:model_hierarchy", "Compare all models of the hierarchy in one case."),
    "response": Entry("studies:response_curves", "Compute amplitude and phase of steady rolling against frequency."),
    "boundary": Entry(
        "studies:stability_boundary", "Compute the stability boundary of steady rolling over two parameters."
    ),
    "map": Entry("studies:overturning_map", "Compute the overturning map over two parameters."),
    "basin": Entry("studies:basins", "Compute basins of attraction over initial conditions, and their fractions."),
    "drift": Entry("conveying:drift", "Compute the mean transport velocity of a column on a vibrating base."),
    "upright": Entry("conveying:upright", "Decide whether a part on a vibrating base stays upright, rocks or falls."),
    "feeder": Entry(
        "cli.feeder:feeder", "Compute the sheet of a feeder: hops, speed, steepest track and posture of a part."
    ),
    "records": Entry("cli.records:records", "List ground-motion records, their components and their intensities."),
    "select": Entry("cli.select:select", "Choose records whose spectra fit a target, and scale them."),
    "assess": Entry("cli.assess:assess", "Assess whether columns survive records, and how robust the answer is."),
    "inventory": Entry(
        "cli.inventory:inventory",
        "Rank the objects of a table by how probably they overturn.",
    ),
    "spectrum": Entry(
        "earthquakes:overturning_intervals", "Compute overturning intervals of the amplitude, or rocking spectra."
    ),
    "fragility": Entry(
        "cli.fragility:fragility", "Fit fragility curves: probability of each limit state versus intensity."
    ),
    "lab": Entry("cli.lab:lab", "Open the laboratory in the browser."),
    "paper": Entry("cli.paper:paper", "Reproduce the source paper: figures, measured claims, corrected misprints."),
}
