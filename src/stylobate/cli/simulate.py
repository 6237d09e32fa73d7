"""`stylobate simulate`: one column and one base motion; its outcome, and how surely it is so."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, engine
from stylobate.cli.command import command
from stylobate.cli.options import Options, overlay, read_source
from stylobate.cli.output import check_animation, check_writable, deliver, print_table
from stylobate.cli.verdict import VERDICT_OPTIONS, VerdictOfCase
from stylobate.config.options import COLUMN, MODEL, MOTION, OUTPUT, RECORD, Option, run_numbers
from stylobate.run_arguments import SingleRun

if TYPE_CHECKING:
    from stylobate.models import Model
    from stylobate.results import Response
    from stylobate.results.summary import Rows


@command(
    Option("animation", "animate the run into this file (.gif, .mp4, .html)", Path),
    Option("speed", "seconds of the run per second of the animation; by default 1, or more for a long run"),
    *VERDICT_OPTIONS,
    argument="TOML description, or a saved run or verdict (.nc) to repeat",
    groups=(run_numbers(SingleRun), COLUMN, MODEL, MOTION, RECORD, OUTPUT),
)
def simulate(options: Options) -> None:
    """Integrate one column; under a record or a pulse also decide how surely it overturns.

    Pass options, or a TOML file with the same names; options override the file. Examples:

    stylobate simulate --radius 0.5 --height 10 --density 2700 --damping 0.02 --motion straight
    --acceleration 1.5 --angular-frequency 4 --start-phase 1.57 --duration 30

    stylobate simulate run.toml --duration 60 --figure run.png --output run.nc

    stylobate simulate --radius 0.3 --height 3 --density 2700 --record quake_NS.txt --record quake_EW.txt --units g

    stylobate simulate run.toml --animation run.html --speed 0.5

    Under a record, a pulse or a sine sweep the duration is optional: the run then adds a free vibration of 20/p. A
    verdict follows: the share of 300 small variations of the case that overturn the column. --single leaves it out.
    """
    check_writable(options["figure"], options["output"])
    if options["animation"] is not None:
        check_animation(options["animation"], options["speed"])
    fields = config.SimulationConfig.model_fields
    values = overlay(read_source(options), options, fields)
    setup = config.SimulationConfig.parse(values).build()
    case = VerdictOfCase.of(options, values.get("verdict"), setup)
    options.refuse_unused()
    run = engine.simulate(setup.model, setup.motion, **setup.options)
    verdict = case.computed()
    deliver(
        run,
        options,
        _save,
        lambda run: {**case.summary(verdict), **_summary(run)},
        lambda run: print_table("run", _rows(run, setup.model, case.rows(run, verdict))),
        label=case.title(run, verdict),
    )
    case.deliver(verdict)
    if options["animation"] is not None:
        _animate(run, options["animation"], options["speed"], case.title(run, verdict))


def _save(run: "Response", path: Path) -> None:
    run.save(path)


def _animate(run: "Response", path: Path, speed: float | None, title: str | None) -> None:
    from stylobate.plots import animate

    animate(run, path, speed=speed, title=title)


def _summary(run: "Response") -> dict[str, Any]:
    return {
        "outcome": run.outcome.name,
        "reason": run.reason,
        "decided_at": run.decided_at,
        "uncertain": run.uncertain,
        "planar": run.planar,
        "events": [{"kind": event.kind, "time": event.time} for event in run.events],
        "measures": dict(run.measures),
        "warnings": list(run.warnings),
        "thresholds": dict(run.thresholds),
        "provenance": dict(run.provenance),
    }


def _rows(run: "Response", model: "Model", outcome: "Rows") -> "Rows":
    from stylobate.results.summary import column_rows, measure_rows, reason_rows

    warnings = [("warning", warning) for warning in run.warnings]
    return [*column_rows(model.column, model.rest_capacity), *outcome, *reason_rows(run), *measure_rows(run), *warnings]
