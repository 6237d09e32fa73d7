"""Commands of studies: made from the declaration of each; computed with progress, to the end or to Ctrl-C, and written.

`study_command` makes the command of a declared study; the other functions serve commands that do more.
"""

import inspect
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stylobate import config, studies
from stylobate.cli.command import Command, Positional
from stylobate.cli.options import Options, merge, overlay, read_source, with_axes
from stylobate.cli.output import (
    STORE,
    axes_of,
    check_writable,
    deliver,
    open_kind,
    print_table,
    provenance_of,
    study_summary,
)
from stylobate.cli.terminal import INTERRUPTED, remark, say
from stylobate.config.study import Analysis, Study, declared_numbers, own_options, study_of
from stylobate.errors import FileError, Interrupted, ParameterError, StylobateError
from stylobate.kinds import loaded
from stylobate.results.tables import TABLES, write_table

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.config.simulation import Setup
    from stylobate.results.tables import ResultTable
    from stylobate.studies import Dask, Threads

# Options that do not change the runs.
_HOW = ("source", "figure", "output", "as_json", "resume", "executor", "threads")


def study_command(function: Callable[..., "xr.Dataset"]) -> Command:
    """Make the command of a declared study."""
    study = study_of(function)
    run: Any = _analyse if isinstance(study, Analysis) else _run
    return Command(
        lambda options: run(function, study, options),
        study.help,
        Positional(text=study.source),
        tuple(own_options(function).values()),
        tuple(study.groups),
    )


def _analyse(function: Callable[..., "xr.Dataset"], study: Analysis, options: Options) -> None:
    """Compute a study without a store, write and print its result."""
    if study.instead is not None and options[study.instead.key]:
        function = loaded(study.instead.place)
        study = study_of(function)
    check_writable(options["figure"], options["output"])
    chosen, kind = study.chosen(options), config.study_config(function)
    values = overlay(read_source(options), options, kind.model_fields)
    own = {one: options[study.renamed.get(one, one)] for one in declared_numbers(function)}
    merge(values, study.name, {one: value for one, value in own.items() if value is not None})
    setup = kind.parse(values).build()
    options.refuse_unused()
    open_ones = {name: one for name, one in chosen.items() if setup.options.get(name) is None}
    of = setup.model.column if "column" in inspect.signature(function).parameters else setup.model
    result = function(of, setup.motion, **(setup.options | open_ones))
    deliver(result, options, _save_flags, study.summary, lambda result: show(*study.tables(result)))


def _run(function: Callable[..., "xr.Dataset"], study: Study, options: Options) -> None:
    kind = config.study_config(function)
    source = options["source"]
    saved = open_kind(source, study.name, study.kinds)

    def completed(saved: "xr.Dataset") -> "xr.Dataset":
        def setup() -> "Setup":
            built: Setup = kind.of_saved(provenance_of(saved), axes_of(saved), saved.attrs["kind"]).build()
            return built

        try:
            return study.completed(saved, setup, options)
        except FileError as error:
            raise FileError(f"{source}: {error}") from None

    def prepared(saved: "xr.Dataset | None") -> "tuple[Callable[..., xr.Dataset], Setup]":
        values = study_values(saved, options, kind, study.usual)
        if study.starts:
            values = _with_sample(values, study.name, options)
        if study.axes:
            values = with_axes(values, options, study.name, (*"xy", *(["scales"] if study.scales else [])))
            if study.axes == ("x", "y?") and not values.get(study.name):
                raise ParameterError(
                    f"{study.name}.x is missing. State what varies: --x acceleration 2 30 29, or "
                    "--x acceleration 9 9 1 for one run."
                )
        with_own_options(values, function, options)
        description = kind.parse(values)
        setup = description.build()
        if study.axes:
            check_axes(study.name, setup, starts=study.starts)
        return loaded(description.instead.place) if description.instead else function, setup

    result, complete = run_study(options, saved, completed, prepared)
    finish(
        result,
        options,
        lambda result: study_summary(result, **study.summary(result)),
        lambda result: show(study.table(result)),
        complete=complete,
    )


def show(*tables: "ResultTable") -> None:
    """Print tables with their remarks."""
    for table in tables:
        if table.header:
            print_table(table.title, table.rows, table.header)
        for line in table.remarks:
            say(line)


def with_own_options(values: dict[str, Any], function: Callable[..., Any], options: Options) -> None:
    """Override the table of a study by the options of its own numbers; either a tail or a duration is kept."""
    name, own = study_of(function).name, {key: one.name for key, one in own_options(function).items()}
    given, table = options.pick(*own.values()), values.get(name)
    if "tail" in own and options.get("duration") is not None and isinstance(table, Mapping):
        values[name] = {key: one for key, one in table.items() if key != "tail"}
    elif own.get("tail") in given:
        values.pop("duration", None)
    merge(values, name, {key: given[option] for key, option in own.items() if option in given})


def _with_sample(values: dict[str, Any], name: str, options: Options) -> dict[str, Any]:
    """Lay the random sample that options state over the values; it replaces a grid in the file."""
    table = values.get(name, {})
    if not isinstance(table, Mapping):
        return values
    sample = options.pick("random")
    ranges = {name: [low, high] for name, low, high in options["over"] or ()}
    if sample or table.get("random") is not None:
        sample |= options.pick("seed")  # a grid has no seed
    if "random" in sample:
        table = {place: value for place, value in table.items() if place not in ("x", "y")}
    if ranges:
        sample["over"] = ranges
    return {**values, name: {**table, **sample}} if sample else values


def is_to_compute(saved: "xr.Dataset | None", options: Options, *, shown_with: Sequence[str] = ("confidence",)) -> bool:
    """Return whether there are runs to compute: `saved` results are only shown unless options change them.

    Parameters
    ----------
    saved
        The results, or None.
    options
        Options of the command.
    shown_with
        Names of options that change the output of saved results, and not the runs.

    Raises
    ------
    ConfigError
        If results are only shown and an option concerns their computation.
    """
    changes = any(name not in (*_HOW, *shown_with) for name in options.flags)
    if saved is None or changes or options["resume"] or _is_store(options["output"]):
        return True
    options.use(*shown_with)
    options.refuse_unused(f"to show {options['source']}, for which it computes nothing")
    return False


def check_outputs(options: Options) -> None:
    """Raise an error before the computation for an output that is not writable; see `check_writable`."""
    check_writable(options["figure"], options["output"], stores=True)


def run_study(
    options: Options,
    saved: "xr.Dataset | None",
    show_saved: Callable[["xr.Dataset"], "xr.Dataset"],
    prepare: Callable[["xr.Dataset | None"], "tuple[Callable[..., xr.Dataset], Setup]"],
) -> "tuple[xr.Dataset, bool]":
    """Compute a study, or show a saved one if no option changes it.

    Parameters
    ----------
    options
        Options of the command.
    saved
        The saved study, or None.
    show_saved
        Function that completes the saved study.
    prepare
        Function that returns the function of the study, and its arguments as a setup.

    Returns
    -------
    tuple
        The result, and whether it was computed to its end: False after Ctrl-C.
    """
    check_outputs(options)
    if not is_to_compute(saved, options):
        assert saved is not None
        return show_saved(saved), True
    study, setup = prepare(saved)
    return computed(study, setup, options)


def study_values(
    saved: "xr.Dataset | None", options: Options, kind: Any, usual: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Override the values of a file or of a saved study by the options.

    Parameters
    ----------
    saved
        The saved study, or None.
    options
        Options of the command.
    kind
        Class of the configuration.
    usual
        Values that a file may leave out.
    """
    if saved is None:
        values = {**(usual or {}), **read_source(options)}
    else:
        values = kind.of_saved(provenance_of(saved), axes_of(saved), saved.attrs["kind"]).values()
    return overlay(values, options, kind.model_fields)


def finish(
    result: "xr.Dataset",
    options: Options,
    summary: Callable[["xr.Dataset"], Any],
    show: Callable[["xr.Dataset"], None],
    *,
    complete: bool,
) -> None:
    """Write and print a result; end with status 130 if it was interrupted."""
    deliver(result, options, save, summary, show)
    end(result, options, complete=complete)


def check_axes(section: str, setup: "Setup", *, starts: bool = False) -> None:
    """Raise ParameterError for an impossible quantity or value along an axis; the message names the axis."""
    from stylobate.studies.checks import require_starts
    from stylobate.studies.sweeps.designs import check_quantities, checked_values

    drawn = "count" in setup.options
    for place, (name, values) in zip(("over",) * 9 if drawn else "xy", setup.options["over"].items(), strict=False):
        where = f"{section}.{place}"
        if starts:
            require_starts(where, {name: None})
        else:
            check_quantities(where, setup.model, [name], setup.motion)
            checked_values(where, name, values)


def computed(study: Callable[..., "xr.Dataset"], setup: "Setup", options: Options) -> "tuple[xr.Dataset, bool]":
    """Compute a study; return the result, and whether it is complete: False after Ctrl-C.

    Raises
    ------
    StylobateError
        If the options contradict each other, an option is unused, or the store or an argument is invalid.
    click.exceptions.Exit
        After Ctrl-C before the first run is complete: there is nothing to write.
    """
    store, resume = _store(options), options["resume"]
    executor = executor_of(options)
    options.refuse_unused()
    try:
        result = study(setup.model, setup.motion, **setup.options, store=store, executor=executor, resume=resume)
    except Interrupted as stop:
        if stop.partial is None or (store is None and not (stop.partial["outcome"] >= 0).any()):
            remark("no run is complete, and nothing is written")
            raise click.exceptions.Exit(INTERRUPTED) from None
        return stop.partial, False
    except StylobateError as error:
        raise StylobateError(str(error).replace("resume=True", "--resume")) from None
    return result, True


def save(result: "xr.Dataset", output: Path) -> None:
    """Write a result into a netCDF file or a table; a store already holds its result."""
    if output.suffix in TABLES:
        write_table(result, output)
    elif not _is_store(output):
        from stylobate.results.storage import write_netcdf

        write_netcdf(result, output)


def _save_flags(result: "xr.Dataset", output: Path) -> None:
    """Write a result into a netCDF file; truth values become integers."""
    flags = {name: data.astype("int8") for name, data in result.data_vars.items() if data.dtype == bool}
    save(result.assign(flags), output)


def end(result: "xr.Dataset", options: Options, *, complete: bool) -> None:
    """End the command with status 130 if it was interrupted, and report the number of completed runs."""
    if complete:
        return
    store = _store(options)
    remedy = f"{store} continues with --resume" if store else "with --output NAME.zarr, --resume could continue"
    remark(f"{int(result['computed'])} of {result['outcome'].size} runs are done; {remedy}")
    raise click.exceptions.Exit(INTERRUPTED)


def _is_store(path: Path | None) -> bool:
    return path is not None and path.suffix == STORE


def _store(options: Options) -> Path | None:
    if _is_store(options["output"]):
        return options["output"]  # type: ignore[no-any-return]  # options by name
    if not options["resume"]:
        return None
    if _is_store(options["source"]):
        return options["source"]  # type: ignore[no-any-return]
    raise ParameterError("--resume: the store to continue is missing. Add --output NAME.zarr.")


def executor_of(options: Options) -> "Threads | Dask":
    """Return the executor that the options choose."""
    text, threads = options["executor"], options["threads"]
    if text in (None, "threads"):
        return studies.Threads(threads)
    from stylobate.studies.sweeps.dask_executor import executor_from

    chosen = executor_from(str(text))
    if threads is not None:
        raise ParameterError(f"--threads: the workers of {text} have one thread each (got {threads}). Remove it.")
    return chosen
