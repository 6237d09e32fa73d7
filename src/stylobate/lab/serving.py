"""Server of the laboratory on this machine."""

import signal
import socket
import threading
import webbrowser
from collections.abc import Callable, Collection
from contextlib import suppress
from types import FrameType
from typing import TYPE_CHECKING

from stylobate.errors import FileError, ParameterError
from stylobate.lab.limits import Limits

if TYPE_CHECKING:
    import uvicorn
    from starlette.applications import Starlette

PORT = 8642
LOOPBACK = ("127.0.0.1", "localhost", "::1")
_ALL = ("0.0.0.0", "::", "")  # noqa: S104  addresses that stand for all of this machine's
_HIGHEST_PORT = 65535
_ELSEWHERE = ("192.0.2.1", 9)
"""An address of no machine (RFC 5737), for finding the address by which this machine reaches others."""


def serve(
    *,
    host: str = LOOPBACK[0],
    port: int = PORT,
    allowed_hosts: Collection[str] = (),
    limits: Limits | None = None,
    token: str | None = None,
    started: Callable[[str], object] = print,
    browser: bool = True,
) -> None:
    """Serve the laboratory until it is interrupted.

    Parameters
    ----------
    host, port
        Address to listen on. Port 0 takes any free port.
    allowed_hosts
        Names by which browsers reach the laboratory besides `host` and the names of this machine.
    limits
        Limits on requests.
    token
        Token that requests must state: 12 to 128 letters, digits, "-", ".", "_" or "~". By default a random one, new at
        each start.
    started
        Called with the address, which contains the token, once the server answers; prints it by default.
    browser
        Whether to open the page in the browser, by an address that is valid once.

    Raises
    ------
    ParameterError
        If the port or the token is not valid.
    FileError
        If the server cannot listen on the port, for example because it is in use.
    """
    if not 0 <= port <= _HIGHEST_PORT:
        raise ParameterError(f"port must lie between 0 and {_HIGHEST_PORT}, got {port!r}")
    with listening(host, port) as place:
        # Heavy imports wait until the socket listens.
        from stylobate.lab.app import create_app
        from stylobate.lab.entrance import new_token

        found = place.getsockname()[1]
        own = () if host in LOOPBACK else own_names()
        hosts = {f"{_bracketed(name)}:{found}" for name in (host, *LOOPBACK, *own, *allowed_hosts)}
        name = own[0] if own and host in _ALL else host
        known = new_token() if token is None else token

        def ready() -> None:
            # The browser's connection waits in the queue of the socket until the server accepts it.
            address = f"http://{_bracketed(name)}:{found}/?token="
            started(address + known)
            if browser:
                webbrowser.open(address + app.state.entrance.key())

        app = create_app(hosts=hosts, token=known, limits=limits, ready=ready)
        _end_with_the_terminal()
        server_of(app).run(sockets=[place])


def server_of(app: "Starlette") -> "uvicorn.Server":
    """Return a server for the application, which ends without waiting for requests."""
    import uvicorn

    from stylobate.lab.app import end_processes

    class Server(uvicorn.Server):
        async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
            end_processes(app)
            await super().shutdown(sockets)

    settings = uvicorn.Config(
        app,
        http="h11",
        ws="none",
        log_level="warning",
        access_log=False,  # it would contain the token of the address
        timeout_graceful_shutdown=1,
    )
    return Server(settings)


def listening(host: str, port: int) -> socket.socket:
    """Return a socket that listens, or raise FileError."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # With a named protocol, asyncio sends answers at once; otherwise each answer would wait for an acknowledgement.
    place = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        place.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        place.bind((host, port))
        place.listen()
    except OSError as error:
        place.close()
        raise FileError(
            f"cannot listen on {host}:{port}: {error.strerror or error}. Give another --port, or 0 for any."
        ) from None
    return place


def own_names() -> tuple[str, ...]:
    """Return the addresses and names by which other machines may reach this one, the usual address first."""
    name = socket.gethostname()
    found = [name, f"{name}.local"]
    with suppress(OSError):  # the name may not resolve
        found += sorted({str(info[4][0]) for info in socket.getaddrinfo(name, None)})
    with suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as outward:  # there may be no network
        outward.connect(_ELSEWHERE)  # a datagram socket sends nothing
        found.insert(0, outward.getsockname()[0])
    return tuple(dict.fromkeys(found))


def _end_with_the_terminal() -> None:
    """Handle the end of the terminal like Ctrl-C: end worker processes and remove files."""

    def interrupt(number: int, frame: FrameType | None) -> None:
        del number, frame
        signal.raise_signal(signal.SIGTERM)

    alone = threading.current_thread() is threading.main_thread()  # only the main thread can set signals
    if alone and hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        signal.signal(signal.SIGHUP, interrupt)


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
