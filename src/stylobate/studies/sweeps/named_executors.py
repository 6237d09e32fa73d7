"""Executors by name, for the command line."""

from stylobate.errors import ParameterError
from stylobate.studies.sweeps.dask_executor import Dask
from stylobate.studies.sweeps.executors import Threads


def executor_from(text: str) -> Threads | Dask:
    """Return the executor that `text` names.

    Parameters
    ----------
    text
        `threads`; `dask://` for workers on this machine; `dask://host:port` for a scheduler. `?wait=600` after the port
        sets the time [s] to wait for workers.

    Raises
    ------
    ParameterError
        If `text` names no executor.

    Examples
    --------
    >>> executor_from("dask://10.0.0.1:8786")
    Dask(address='tcp://10.0.0.1:8786', workers=None, wait=10.0)
    """
    if text == "threads":
        return Threads()
    scheme, separator, place = text.partition("://")
    if scheme == "dask" and separator:
        place, asks, wait = place.partition("?wait=")
        address = f"tcp://{place}" if place else None
        return Dask(address=address, wait=_seconds(wait)) if asks else Dask(address=address)
    message = f'executor must be "threads", "dask://" or "dask://host:port", got {text!r}'
    raise ParameterError(message)


def _seconds(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        message = f"wait: not a number of seconds (got {text!r}). Write dask://host:port?wait=600."
        raise ParameterError(message) from None
