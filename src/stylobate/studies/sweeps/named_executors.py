"""Executors by name, for the command line."""

from stylobate.errors import ParameterError
from stylobate.studies.sweeps.dask_executor import Dask
from stylobate.studies.sweeps.executors import Threads


def executor_from(text: str) -> Threads | Dask:
    """Return the executor that `text` names: `threads`, `dask://` (workers on this machine) or `dask://host:port`.

    Raises
    ------
    ParameterError
        If `text` names no executor.

    Examples
    --------
    >>> executor_from("dask://10.0.0.1:8786")
    Dask(address='tcp://10.0.0.1:8786', workers=None)
    """
    if text == "threads":
        return Threads()
    scheme, separator, place = text.partition("://")
    if scheme == "dask" and separator:
        return Dask(address=f"tcp://{place}" if place else None)
    message = f'executor must be "threads", "dask://" or "dask://host:port", got {text!r}'
    raise ParameterError(message)
