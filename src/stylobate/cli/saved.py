"""Saved results of studies: reading of netCDF files and stores, writing of netCDF files."""

import json
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, studies
from stylobate.cli.output import NETCDF, STORE
from stylobate.errors import FileError
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr


def open_saved(source: Path | None) -> "xr.Dataset | None":
    """Read the runs saved in a netCDF file (.nc) or a store (.zarr), finished or not; None for any other source.

    Raises
    ------
    FileError
        If the file cannot be read, or holds no runs of a study.
    """
    if source is None or source.suffix not in (NETCDF, STORE):
        return None
    if not source.exists():
        message = f"cannot read {source}: No such file or directory"
        raise FileError(message)
    if source.suffix == STORE:
        return relocated(studies.open_sweep(source, load=True), source)
    from stylobate.results import read_dataset  # noqa: PLC0415

    data = read_dataset(source)
    if "outcome" not in data.data_vars or "provenance" not in data.attrs or "format" in data.attrs:
        message = f"{source} holds no map or basins saved by stylobate"
        raise FileError(message)
    return relocated(data, source)


def open_study(source: Path | None, kinds: Collection[str], *, lacks: str, store: str) -> "xr.Dataset | None":
    """Read a saved study of one of these kinds from a netCDF file; None for any other source.

    Parameters
    ----------
    source
        The file.
    kinds
        The kinds of study that the command shows.
    lacks
        Noun for the message about a file of another kind, which lacks it.
    store
        Message about a store: the problem and the remedy.

    Raises
    ------
    FileError
        If the source is a store or of another kind, or cannot be read.
    """
    if source is not None and source.suffix == STORE:
        message = f"{source} is {store}"
        raise FileError(message)
    saved = open_saved(source)
    if saved is not None and saved.attrs["kind"] not in kinds:
        message = f"{source}: no {lacks} (got a {saved.attrs['kind']})."
        raise FileError(message)
    return saved


def relocated(data: "xr.Dataset", source: Path) -> "xr.Dataset":
    """Return `data` with new paths of records that were moved together with the file."""
    return data.assign_attrs(provenance=json.dumps(config.relocated(provenance_of(data), source.parent)))


def provenance_of(data: "xr.Dataset") -> dict[str, Any]:
    """Return the provenance of `data`."""
    provenance: dict[str, Any] = json.loads(data.attrs["provenance"])
    return provenance


def model_named(data: "xr.Dataset") -> str:
    """Return the model of the runs in `data` in words, with its damping unless the damping varies."""
    model = provenance_of(data).get("model", {})
    damping = "" if "damping" not in model or "damping" in data.dims else f", damping {model['damping']:g}"
    return f"model {model.get('kind', 'unknown')}{damping}"


def axes_of(data: "xr.Dataset") -> dict[str, list[float]]:
    """Return the values along each dimension of the runs in `data`, by name; none for a random sample."""
    names = [str(dim) for dim in data["outcome"].dims]
    return {name: data[name].to_numpy().tolist() for name in names if name in data.coords}


def study_summary(data: "xr.Dataset", **own: Any) -> dict[str, Any]:
    """Describe a study for JSON: kind, axes, `own` values, number of computed runs, provenance."""
    done = {"computed": int(data["computed"]), "runs": data["outcome"].size}
    return {"kind": data.attrs["kind"], **plain_axes(data), **own, **done, "provenance": provenance_of(data)}


def number_of_runs(data: "xr.Dataset", over: str = "", word: str = "run") -> str:
    """Describe in words the number of runs of a study, and the number of computed runs."""
    done, total = int(data["computed"]), data["outcome"].size
    return f"{plural(total, word)}{over}" + (f", {done} of them done" if done < total else "")


def plain_axes(data: "xr.Dataset") -> Mapping[str, Any]:
    """Return name, ends and number of the values along each axis, for JSON."""
    axes = axes_of(data).items()
    return {
        place: {"name": name, "from": values[0], "to": values[-1], "number": len(values)}
        for place, (name, values) in zip("xy", axes, strict=False)
        if values
    }
