"""What `map` and `basin` share: many runs computed with progress, to the end or to Ctrl-C, and written."""

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from stylobate.cli.output import STORE, check_writable, save_figure
from stylobate.cli.progress import runs_done
from stylobate.cli.saved import save_dataset
from stylobate.errors import Interrupted, ParameterError, StylobateError

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.spec import Setup
    from stylobate.studies import Dask, Threads

INTERRUPTED = 130

# Options that do not change what is computed.
_HOW = ("source", "figure", "output", "as_json", "resume", "executor", "threads", "confidence")


def is_to_compute(saved: "xr.Dataset | None", given: Mapping[str, Any]) -> bool:
    """Return whether there is something to compute: `saved` results are only shown unless options change them."""
    changes = any(value not in (None, [], ()) for name, value in given.items() if name not in _HOW)
    return saved is None or changes or given["resume"] or _is_store(given["output"])


def check_outputs(given: Mapping[str, Any]) -> None:
    """Raise an error now for an output that could not be written when the work is done; see `check_writable`."""
    check_writable(given["figure"], given["output"], stores=True)


def check_axes(section: str, setup: "Setup") -> None:
    """Raise ParameterError for a quantity along x or y, or a value of it, that cannot be; told by its place."""
    from stylobate.studies.sweeps.quantities import check_quantities, checked_values  # noqa: PLC0415

    for place, (name, values) in zip("xy", setup.options["over"].items(), strict=False):
        check_quantities(f"{section}.{place}", setup.model, [name])
        checked_values(f"{section}.{place}", name, values)


def computed(
    study: Callable[..., "xr.Dataset"], setup: "Setup", given: Mapping[str, Any], what: str
) -> "tuple[xr.Dataset, bool]":
    """Return what `study` finds, and whether it was computed to its end: False after Ctrl-C.

    Raises
    ------
    StylobateError
        If the options say contrary things, the store cannot be used, or the study refuses.
    """
    store, executor = _store(given), _executor(given["executor"], given["threads"])
    try:
        with runs_done(what) as progress:
            found = study(
                setup.model,
                setup.motion,
                **setup.options,
                store=store,
                executor=executor,
                resume=given["resume"],
                progress=progress,
            )
    except Interrupted as stop:
        return stop.partial, False
    except StylobateError as error:
        raise StylobateError(str(error).replace("resume=True", "--resume")) from None
    return found, True


def write(found: "xr.Dataset", given: Mapping[str, Any]) -> None:
    """Write what was found into the files asked for; a store holds it already."""
    output: Path | None = given["output"]
    if output is not None and not _is_store(output):
        save_dataset(found, output)
    if given["figure"] is not None:
        from stylobate import plots  # noqa: PLC0415  heavy imports wait until they are needed

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
    from stylobate import studies  # noqa: PLC0415  heavy imports wait until the options are read

    if text in (None, "threads"):
        return studies.Threads(threads)
    chosen = studies.executor_from(str(text))
    if threads is not None:
        message = f"--threads is for this process and not for {text}, whose workers have one each; leave it out"
        raise ParameterError(message)
    return chosen
