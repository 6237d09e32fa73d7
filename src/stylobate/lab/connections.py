"""Connections of the server: a maximum number at once, and a time limit for requests."""

import asyncio
import json
import sys
from collections.abc import Iterable

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from stylobate.lab.limits import Limits

BACKLOG = 16
"""Connections that one iteration of the event loop accepts. The limit applies to them three iterations later."""

_RESERVED = 3 * BACKLOG + 48
"""Descriptors besides connections: files, pipes to worker processes, connections accepted in three iterations."""

_FEWEST = 8


class BoundedConnection(H11Protocol):
    """A connection with a time limit for its request, which is closed if there are too many connections.

    Attributes
    ----------
    receiving
        Time limit for the arrival of a request, head and body [s].
    most
        Maximum number of connections. Beyond it, the connection that has been incomplete for longest is closed, or else
        the new one.
    """

    receiving: float
    most: int
    begun = 0.0
    _late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Accept the connection, or close one."""
        super().connection_made(transport)
        self._expect()
        ours = [one for one in self.connections if isinstance(one, BoundedConnection)]
        held = [one for one in ours if not one.transport.is_closing()]
        if len(held) > self.most:
            min((one for one in held if one.owes), key=lambda one: one.begun).transport.abort()

    def data_received(self, data: bytes) -> None:
        """Receive a part of a request."""
        super().data_received(data)
        if not self.owes:
            self._expect_no_more()
        elif self._late is None:
            self._expect()

    def connection_lost(self, exc: Exception | None) -> None:
        """Remove the connection."""
        self._expect_no_more()
        super().connection_lost(exc)

    @property
    def owes(self) -> bool:
        """Whether the client has not sent all of its next request."""
        return self.conn.their_state in (h11.IDLE, h11.SEND_BODY)

    def _expect(self) -> None:
        self.begun = self.loop.time()
        self._late = self.loop.call_later(self.receiving, self._give_up)

    def _expect_no_more(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _give_up(self) -> None:
        answering = self.cycle is not None and self.conn.their_state is h11.SEND_BODY and self.cycle.response_started
        if not answering:
            self.transport.write(_too_late(self.receiving))
        self.transport.close()


def close_incomplete(connections: Iterable[object]) -> None:
    """Close the connections whose requests have not arrived."""
    for one in list(connections):
        if isinstance(one, BoundedConnection) and one.owes:
            one.transport.abort()


def bounded(limits: Limits) -> type[BoundedConnection]:
    """Return the class of connections within `limits`, and within the file descriptors of this process."""

    class Bounded(BoundedConnection):
        receiving = limits.receiving
        most = min(limits.connections, max(_descriptors() - _RESERVED, _FEWEST))

    return Bounded


def _descriptors() -> int:
    """Return the maximum number of file descriptors of this process."""
    if sys.platform == "win32":
        return sys.maxsize
    import resource

    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return sys.maxsize if soft == resource.RLIM_INFINITY else soft


def _too_late(seconds: float) -> bytes:
    problem = f"the request did not arrive within {seconds:g} s. Send it again."
    body = json.dumps({"problems": [problem]}).encode()
    head = f"HTTP/1.1 408 Request Timeout\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n"
    return f"{head}Connection: close\r\n\r\n".encode() + body
