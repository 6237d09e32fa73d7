"""Source of a command: a TOML description, or a saved run."""

from pathlib import Path
from typing import Any

from stylobate import config, results
from stylobate.errors import FileError


def read_source(source: Path | None) -> dict[str, Any]:
    """Read the plain values of a description, or of a saved run (.nc) to repeat it.

    Raises
    ------
    FileError
        If the file is missing, or is neither a description nor a saved run.

    Notes
    -----
    `config.relocated` finds records that were moved together with a saved run.
    """
    if source is None:
        return {}
    if not source.is_file():
        message = f"cannot read {source}: No such file or directory"
        raise FileError(message)
    if source.suffix == ".nc":
        return config.config_of(config.relocated(results.Response.load(source).provenance, source.parent)).values()
    return config.read_config(source)
