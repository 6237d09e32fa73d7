"""Compute many runs with progress, to the end or to Ctrl-C, and write them: `map`, `basin` and other studies."""

import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from stylobate import studies
from stylobate.cli.interrupts import INTERRUPTED
from stylobate.cli.options import Options
from stylobate.cli.output import STORE, check_writable, deliver
from stylobate.cli.overlay import overlay
from stylobate.cli.saved import axes_of, provenance_of
from stylobate.cli.source import read_source
from stylobate.errors import Interrupted, ParameterError, StylobateError

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.config import Setup
    from stylobate.studies import Dask, Threads

# Options that do not change the runs.
_HOW = ("source", "figure", "output", "as_json", "resume", "executor", "threads")


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
    saved: "xr.Dataset | None", options: Options, kind: Any, usual: Mapping[str, Any] | None = None, **of_saved: Any
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
    of_saved
        Further arguments of `kind.of_saved`.
    """
    if saved is None:
        values = {**(usual or {}), **read_source(options["source"])}
    else:
        values = kind.of_saved(provenance_of(saved), axes_of(saved), **of_saved).values()
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


def check_axes(section: str, setup: "Setup") -> None:
    """Raise ParameterError for an impossible quantity or value along x or y; the message names the axis."""
    from stylobate.studies.sweeps.quantities import check_quantities, checked_values  # noqa: PLC0415

    for place, (name, values) in zip("xy", setup.options["over"].items(), strict=False):
        check_quantities(f"{section}.{place}", setup.model, [name], setup.motion)
        checked_values(f"{section}.{place}", name, values)


def computed(study: Callable[..., "xr.Dataset"], setup: "Setup", options: Options) -> "tuple[xr.Dataset, bool]":
    """Compute a study; return the result, and whether it is complete: False after Ctrl-C.

    Raises
    ------
    StylobateError
        If the options contradict each other, an option is unused, or the store or an argument is invalid.
    typer.Exit
        After Ctrl-C before the first run is complete: there is nothing to write.
    """
    store, resume = _store(options), options["resume"]
    executor = executor_of(options)
    options.refuse_unused()
    try:
        result = study(setup.model, setup.motion, **setup.options, store=store, executor=executor, resume=resume)
    except Interrupted as stop:
        if stop.partial is None or (store is None and not (stop.partial["outcome"] >= 0).any()):
            print("stylobate: no run is complete, and nothing is written", file=sys.stderr)
            raise typer.Exit(INTERRUPTED) from None
        return stop.partial, False
    except StylobateError as error:
        raise StylobateError(str(error).replace("resume=True", "--resume")) from None
    return result, True


def save(result: "xr.Dataset", output: Path) -> None:
    """Write a result into a netCDF file; a store already holds its result."""
    if not _is_store(output):
        from stylobate.results import write_netcdf  # noqa: PLC0415  heavy imports wait until they are needed

        write_netcdf(result, output)


def end(result: "xr.Dataset", options: Options, *, complete: bool) -> None:
    """End the command with status 130 if it was interrupted, and report the number of completed runs."""
    if complete:
        return
    store = _store(options)
    remedy = f"{store} continues with --resume" if store else "with --output NAME.zarr, --resume could continue"
    print(f"stylobate: {int(result['computed'])} of {result['outcome'].size} runs are done; {remedy}", file=sys.stderr)
    raise typer.Exit(INTERRUPTED)


def _is_store(path: Path | None) -> bool:
    return path is not None and path.suffix == STORE


def _store(options: Options) -> Path | None:
    if _is_store(options["output"]):
        return options["output"]  # type: ignore[no-any-return]  # options by name
    if not options["resume"]:
        return None
    if _is_store(options["source"]):
        return options["source"]  # type: ignore[no-any-return]
    message = "--resume: the store to continue is missing. Add --output NAME.zarr."
    raise ParameterError(message)


def executor_of(options: Options) -> "Threads | Dask":
    """Return the executor that the options choose."""
    text, threads = options["executor"], options["threads"]
    if text in (None, "threads"):
        return studies.Threads(threads)
    chosen = studies.executor_from(str(text))
    if threads is not None:
        message = f"--threads: the workers of {text} have one thread each (got {threads}). Remove it."
        raise ParameterError(message)
    return chosen
