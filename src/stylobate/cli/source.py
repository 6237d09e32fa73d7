"""Source of a command: a TOML description, or a saved run."""

from pathlib import Path
from typing import Any

from stylobate import config, results, studies
from stylobate.errors import FileError


def read_source(source: Path | None) -> dict[str, Any]:
    """Read the plain values of a description, or of a saved run or verdict (.nc) to repeat it.

    Raises
    ------
    FileError
        If the file is missing, or is neither a description nor a saved run or verdict.

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
        saved = studies.load(source)
        loaded = saved if isinstance(saved, results.Verdict) else results.Response.load(source)
        return config.config_of(config.relocated(loaded.provenance, source.parent)).values()
    return config.read_config(source)
