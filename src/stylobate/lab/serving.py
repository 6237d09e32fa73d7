"""Serving the laboratory on this machine."""

import socket
import webbrowser
from collections.abc import Callable, Collection

from stylobate.errors import FileError, ParameterError
from stylobate.lab.limits import Limits

PORT = 8642
LOOPBACK = ("127.0.0.1", "localhost", "::1")
_HIGHEST_PORT = 65535


def serve(
    *,
    host: str = LOOPBACK[0],
    port: int = PORT,
    allowed_hosts: Collection[str] = (),
    limits: Limits | None = None,
    started: Callable[[str], object] = webbrowser.open,
) -> None:
    """Serve the laboratory until it is interrupted.

    Parameters
    ----------
    host, port
        Where to listen. Port 0 takes any that is free.
    allowed_hosts
        Names by which browsers reach it besides `host` and those of this machine's own.
    limits
        How much it may be asked for.
    started
        Called with the address when it answers; opens a browser by default.

    Raises
    ------
    ParameterError
        If the port is none.
    FileError
        If it cannot be listened on, for example because it is taken.
    """
    if not 0 <= port <= _HIGHEST_PORT:
        message = f"port must lie between 0 and {_HIGHEST_PORT}, got {port!r}"
        raise ParameterError(message)
    with listening(host, port) as place:
        # What is heavy waits until it is known that there is a place to listen.
        import uvicorn  # noqa: PLC0415

        from stylobate.lab.app import create_app  # noqa: PLC0415

        found = place.getsockname()[1]
        hosts = {f"{_bracketed(name)}:{found}" for name in (host, *LOOPBACK, *allowed_hosts)}
        # The browser that is opened waits in the queue of the socket until the server takes it.
        app = create_app(hosts=hosts, limits=limits, ready=lambda: started(f"http://{_bracketed(host)}:{found}/"))
        settings = uvicorn.Config(app, log_level="warning", timeout_graceful_shutdown=2)
        uvicorn.Server(settings).run(sockets=[place])


def listening(host: str, port: int) -> socket.socket:
    """Return a socket that listens, or raise FileError."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # With the protocol told, asyncio sends answers at once; else each would wait for an acknowledgement of its head.
    place = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        place.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        place.bind((host, port))
        place.listen()
    except OSError as error:
        place.close()
        message = f"cannot listen on {host}:{port}: {error.strerror or error}; give another --port, or 0 for any"
        raise FileError(message) from None
    return place


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
