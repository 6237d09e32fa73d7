"""`stylobate lab`: the laboratory, a page in the browser."""

import sys
import webbrowser
from typing import Annotated

import typer

Port = Annotated[int, typer.Option(help="port to listen on; 0 for any that is free")]
Host = Annotated[
    str, typer.Option(help="address to listen on, 0.0.0.0 for all; by default this machine's own programs only")
]
AllowHost = Annotated[
    list[str] | None,
    typer.Option(help="another name by which browsers reach it; repeat it", metavar="NAME", show_default=False),
]
NoBrowser = Annotated[bool, typer.Option("--no-browser", help="tell the address and open no browser")]


def lab(
    port: Port = 8642, host: Host = "127.0.0.1", allow_host: AllowHost = None, no_browser: NoBrowser = False
) -> None:
    """Open the laboratory: set column and base motion in the browser, and watch it stand, rock, roll or fall.

    It serves this machine only, unless --host is given, and loads nothing from the network. Ctrl-C ends it. Example:

    stylobate lab --port 9000 --no-browser
    """
    from stylobate.lab.pages import NO_PAGE, page_is_built  # noqa: PLC0415  heavy imports wait until they are needed
    from stylobate.lab.serving import LOOPBACK, serve  # noqa: PLC0415

    if host not in LOOPBACK:
        message = "other machines can reach the laboratory; the token in its address lets them use it"
        print(f"stylobate: {message}", file=sys.stderr)
    if not page_is_built():
        print(NO_PAGE, file=sys.stderr)

    def started(address: str) -> None:
        print(f"The laboratory is at {address} (Ctrl-C ends it)", flush=True)
        if not no_browser:
            webbrowser.open(address)

    serve(host=host, port=port, allowed_hosts=allow_host or (), started=started)
