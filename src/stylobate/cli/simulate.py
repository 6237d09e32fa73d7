"""`stylobate simulate`: one column and one base motion; its outcome, and how surely it is so."""

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, earthquakes, engine, results
from stylobate.cli.command import command
from stylobate.cli.options import Options, overlay, read_source
from stylobate.cli.output import NETCDF, check_animation, check_writable, deliver, print_table, relocated, save_plot
from stylobate.config.options import COLUMN, MODEL, MOTION, OUTPUT, RECORD, Option, run_numbers
from stylobate.errors import Outcome, ParameterError, UnlikelyInputWarning
from stylobate.results.tables import TABLES, write_table
from stylobate.run_arguments import Accuracy, InitialConditions, SingleRun
from stylobate.text import four_digits

if TYPE_CHECKING:
    from stylobate.config.simulation import Setup
    from stylobate.models import Model
    from stylobate.results import Run, Verdict
    from stylobate.results.run_rows import Rows

VERDICT_OPTIONS = (
    Option("single", "this run alone, without small variations", bool, default=False, panel="Verdict"),
    Option("verdict_runs", "number of small variations; 300 by default, none for sliding", int, panel="Verdict"),
    Option("verdict_figure", "draw the verdict into this file (.png, .pdf, .svg)", Path, panel="Verdict"),
    Option("verdict_output", "write the verdict into this file (.nc)", Path, panel="Verdict"),
)

# Options of a run that a verdict shares.
_SHARED = {*vars(InitialConditions)["__annotations__"], *vars(Accuracy)["__annotations__"]} - {"tilt_limit"}


@dataclass(frozen=True, slots=True)
class VerdictOfCase:
    """What `simulate` says about small variations of its case.

    `arguments` are those of `verdict`, None for a case without a verdict; then `why_not` is the reason, empty for a
    motion that does not end. `saved` is a verdict to repeat.
    """

    setup: "Setup"
    arguments: Mapping[str, Any] | None
    why_not: str
    saved: "Verdict | None"
    figure: Path | None
    output: Path | None

    @classmethod
    def of(cls, options: Options, table: Any, setup: "Setup") -> "VerdictOfCase":
        """Check the options and the table `verdict` of a description.

        Raises
        ------
        ParameterError
            If files or a number of runs are stated for a case without a verdict.
        ConfigError
            If the table is invalid.
        """
        figure, output, runs = options["verdict_figure"], options["verdict_output"], options["verdict_runs"]
        check_writable(figure, output)
        ends = 0.0 < setup.motion.duration < math.inf
        why_not = _why_not(setup.model, single=options["single"], asked=runs is not None or table is not None)
        if ends and not why_not:
            given = {name: value for name, value in setup.options.items() if name in _SHARED and value is not None}
            from stylobate.earthquakes.config.verdict import VerdictConfig

            described = {} if table is None else VerdictConfig.of(table)
            arguments = {**given, **described, **({} if runs is None else {"runs": runs})}
            return cls(setup, arguments, "", _saved(options["source"]), figure, output)
        reason = why_not if ends else "a base motion that does not end"
        stated = [flag for flag, value in (("runs", runs), ("figure", figure), ("output", output)) if value is not None]
        if stated or (options["single"] and not ends):
            flag = f"--verdict-{stated[0]}" if stated else "--single"
            raise ParameterError(f"{flag}: there is no verdict (got {reason}). Remove this option.")
        return cls(setup, None, why_not if ends else "", None, None, None)

    def computed(self) -> "Verdict | None":
        """Compute the verdict, or repeat the saved one; None for a case without."""
        if self.arguments is None:
            return None
        if self.saved is not None:
            return earthquakes.repeat_verdict(self.saved)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="damping: ", category=UnlikelyInputWarning)  # a row states it
            return earthquakes.verdict(self.setup.model, self.setup.motion, **self.arguments)

    def rows(self, run: "Run", verdict: "Verdict | None") -> "Rows":
        """Return the rows of model, verdict and outcome, with a remark on a run that does not state the verdict."""
        from stylobate.results.run_rows import damping_rows, outcome_of

        model = [("model", _model(self.setup.model))]
        if verdict is None and not self.why_not:
            return [*model, ("outcome", outcome_of(run))]
        model += damping_rows(self.setup.model.column, None)
        if verdict is None:
            return [*model, ("outcome", f"{outcome_of(run)} in this run; {self.why_not}")]
        from stylobate.earthquakes.verdict_study import undamped
        from stylobate.results.verdict import LABELS, percent

        laws = ", ".join(f"{percent(share)} with {name}" for name, share in verdict.share_by_model.items())
        rows = [*model, ("verdict", str(verdict)), ("overturn by contact law", laws)]
        if remark := undamped(self.setup.model, (self.arguments or {}).get("variations") or {}):
            rows.append(("warning", remark))
        if verdict.deciding:
            rows.append(("decided most by", LABELS.get(verdict.deciding, verdict.deciding)))
        return [*rows, ("outcome", outcome_of(run) + _remark(run, verdict))]

    def title(self, run: "Run", verdict: "Verdict | None") -> str | None:
        """Return the title of figure and animation of a run that does not state the verdict; None if it does."""
        remark = "" if verdict is None else _remark(run, verdict)
        return f"{run.outcome.label}{remark}" if remark else None

    def summary(self, verdict: "Verdict | None") -> dict[str, Any]:
        """Return the verdict for JSON."""
        if verdict is None:
            return {"verdict": None}
        low, high = verdict.interval
        numbers = {"share": verdict.share, "share_low": low, "share_high": high, "confidence": verdict.confidence}
        by_law = {"share_by_model": dict(verdict.share_by_model), "deciding": verdict.deciding}
        return {"verdict": {"word": verdict.word.value, **numbers, "runs": verdict.runs, **by_law}}

    def deliver(self, verdict: "Verdict | None") -> None:
        """Write the verdict into the files that the options name."""
        if verdict is not None and self.output is not None:
            _save(verdict, self.output)
        if verdict is not None and self.figure is not None:
            save_plot(verdict, self.figure)


def _remark(run: "Run", verdict: "Verdict") -> str:
    """Return the remark on a run that does not state the verdict on its case; empty if it states the same."""
    overturned = run.outcome is Outcome.OVERTURNED
    match verdict.word:
        case results.VerdictWord.UNDECIDED:
            variations = "small variations leave it undecided"
        case results.VerdictWord.STANDS if overturned:
            variations = "nearly all small variations do not overturn it"
        case results.VerdictWord.OVERTURNS if not overturned:
            variations = "nearly all small variations overturn it"
        case _:
            return ""
    return f" in this run alone; {variations}"


def _why_not(model: "Model", *, single: bool, asked: bool) -> str:
    """Name the reason for which a case has no verdict; empty if it has one."""
    if single:
        return "small variations were not tried (--single)"
    if model.planar_only:
        return "small variations were not tried (planar model)"
    if model.switches and not asked:
        return "small variations were not tried (they take minutes with sliding: --verdict-runs 300)"
    return ""


def _saved(source: Path | None) -> "Verdict | None":
    """Read a saved verdict; None for any other source."""
    if source is None or source.suffix != NETCDF:
        return None
    from stylobate.results.storage import read_dataset

    found = read_dataset(source)
    if found.attrs.get("kind") != "verdict":
        return None
    return results.Verdict(relocated(found, source))


def _model(model: "Model") -> str:
    """Name a model with its damping, and its other numbers that are not the default."""
    if not is_dataclass(model):
        return model.name
    stated = {one.name: (getattr(model, one.name), one.default) for one in fields(model) if one.name != "column"}
    named = [
        f"{name.replace('_', ' ')} {four_digits(value) if isinstance(value, float) else value}"
        for name, (value, default) in stated.items()
        if name == "damping" or value != default
    ]
    return ", ".join([model.name, *named])


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


def _save(result: "Run | Verdict", path: Path) -> None:
    if path.suffix in TABLES:
        write_table(result.data, path)
    else:
        result.save(path)


def _animate(run: "Run", path: Path, speed: float | None, title: str | None) -> None:
    from stylobate.plots import animate

    animate(run, path, speed=speed, title=title)


def _summary(run: "Run") -> dict[str, Any]:
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


def _rows(run: "Run", model: "Model", outcome: "Rows") -> "Rows":
    from stylobate.results.run_rows import column_rows, measure_rows, reason_rows

    warnings = [("warning", warning) for warning in run.warnings]
    return [*column_rows(model.column, model.rest_capacity), *outcome, *reason_rows(run), *measure_rows(run), *warnings]
