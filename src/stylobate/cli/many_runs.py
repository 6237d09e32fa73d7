"""What `map` and `basin` share: many runs computed with progress, to the end or to Ctrl-C, and written."""

import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from stylobate import plots, studies
from stylobate.cli.given import Given
from stylobate.cli.interrupts import INTERRUPTED
from stylobate.cli.output import STORE, check_writable, save_figure
from stylobate.cli.progress import runs_done
from stylobate.errors import Interrupted, ParameterError, StylobateError

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.config import Setup
    from stylobate.studies import Dask, Threads

# Options that do not change what is computed.
_HOW = ("source", "figure", "output", "as_json", "resume", "executor", "threads")


def is_to_compute(saved: "xr.Dataset | None", given: Given, *, shown_with: Sequence[str] = ("confidence",)) -> bool:
    """Return whether there is something to compute: `saved` results are only shown unless options change them.

    Parameters
    ----------
    saved
        The results, or None.
    given
        The options.
    shown_with
        Names of options that change what is shown of saved results, and not the runs.

    Raises
    ------
    ConfigError
        If results are only shown and an option says how to compute them.
    """
    changes = any(name not in (*_HOW, *shown_with) for name in given.flags)
    if saved is None or changes or given["resume"] or _is_store(given["output"]):
        return True
    given.use(*shown_with)
    given.refuse_unused(f"to show {given['source']}, for which it computes nothing")
    return False


def check_outputs(given: Mapping[str, Any]) -> None:
    """Raise an error now for an output that could not be written when the work is done; see `check_writable`."""
    check_writable(given["figure"], given["output"], stores=True)


def check_axes(section: str, setup: "Setup") -> None:
    """Raise ParameterError for a quantity along x or y, or a value of it, that cannot be; told by its place."""
    from stylobate.studies.sweeps.quantities import check_quantities, checked_values  # noqa: PLC0415

    for place, (name, values) in zip("xy", setup.options["over"].items(), strict=False):
        check_quantities(f"{section}.{place}", setup.model, [name])
        checked_values(f"{section}.{place}", name, values)


def computed(study: Callable[..., "xr.Dataset"], setup: "Setup", given: Given, what: str) -> "tuple[xr.Dataset, bool]":
    """Return what `study` finds, and whether it was computed to its end: False after Ctrl-C.

    Raises
    ------
    StylobateError
        If the options contradict each other, nothing uses one of them, the store cannot be used, or the study refuses.
    typer.Exit
        After Ctrl-C before any run was done: there is nothing to write.
    """
    store, resume = _store(given), given["resume"]
    executor = _executor(given["executor"], given["threads"])
    given.refuse_unused()
    try:
        with runs_done(what) as progress:
            found = study(
                setup.model,
                setup.motion,
                **setup.options,
                store=store,
                executor=executor,
                resume=resume,
                progress=progress,
            )
    except Interrupted as stop:
        if store is None and not (stop.partial["outcome"] >= 0).any():
            print("stylobate: no run is done, and nothing is written", file=sys.stderr)
            raise typer.Exit(INTERRUPTED) from None
        return stop.partial, False
    except StylobateError as error:
        raise StylobateError(str(error).replace("resume=True", "--resume")) from None
    return found, True


def write(found: "xr.Dataset", given: Mapping[str, Any]) -> None:
    """Write what was found into the files asked for; a store holds it already."""
    output: Path | None = given["output"]
    if output is not None and not _is_store(output):
        from stylobate.results import write_netcdf  # noqa: PLC0415  heavy imports wait until they are needed

        write_netcdf(found, output)
    if given["figure"] is not None:
        save_figure(plots.plot(found), given["figure"])


def end(found: "xr.Dataset", given: Mapping[str, Any], *, complete: bool) -> None:
    """End the command with status 130 if it was interrupted, and say what there is."""
    if complete:
        return
    store = _store(given)
    remedy = f"; {store} goes on with --resume" if store else "; with --output NAME.zarr it could go on with --resume"
    print(f"stylobate: {int(found['computed'])} of {found['outcome'].size} runs are done{remedy}", file=sys.stderr)
    raise typer.Exit(INTERRUPTED)


def _is_store(path: Path | None) -> bool:
    return path is not None and path.suffix == STORE


def _store(given: Mapping[str, Any]) -> Path | None:
    if _is_store(given["output"]):
        return given["output"]  # type: ignore[no-any-return]  # options by name
    if not given["resume"]:
        return None
    if _is_store(given["source"]):
        return given["source"]  # type: ignore[no-any-return]
    message = "--resume needs the store to continue: give --output NAME.zarr"
    raise ParameterError(message)


def _executor(text: str | None, threads: int | None) -> "Threads | Dask":
    if text in (None, "threads"):
        return studies.Threads(threads)
    chosen = studies.executor_from(str(text))
    if threads is not None:
        message = f"--threads is for this process and not for {text}, whose workers have one each; leave it out"
        raise ParameterError(message)
    return chosen
