"""`stylobate lab`: the laboratory, a page in the browser."""

import os
import sys
from pathlib import Path

from stylobate.cli.command import command
from stylobate.cli.options import Options
from stylobate.cli.terminal import part_lines
from stylobate.config.options import Option
from stylobate.errors import ParameterError

_OF_SERVER = {"port": 8642, "host": "127.0.0.1", "allow_host": None, "token": None, "no_browser": False}
"""Options of the server with their defaults."""

_VARIABLE = "STYLOBATE_LAB_TOKEN"
"""Environment variable with a chosen token; an empty one chooses none."""


@command(
    Option("port", "port to listen on; 0 for any free port; 8642 by default", int, default=_OF_SERVER["port"]),
    Option(
        "host",
        "address to listen on, 0.0.0.0 for all; by default only programs of this machine can connect",
        str,
        default=_OF_SERVER["host"],
    ),
    Option("allow_host", "another name by which browsers connect; repeat it", list[str], metavar="NAME"),
    Option(
        "token",
        "token that requests must state, at least 12 characters; by default a random one, new at each start. Other "
        f"users of this machine can read the options of a command, but not the environment variable {_VARIABLE}",
        str,
    ),
    Option("no_browser", "print the address, open no browser", bool, default=False),
    Option("static", "write the laboratory as files into this folder, start no server", Path, metavar="FOLDER"),
)
def lab(options: Options) -> None:
    """Open the laboratory in the browser.

    Set column and base motion there, and watch the column stand, rock, roll or overturn.

    The server accepts connections of this machine only, unless --host states another address, and loads nothing from
    the network. It answers requests with the token of the printed address only. Ctrl-C ends the command. Examples:

    stylobate lab --port 9000 --no-browser

    stylobate lab --static FOLDER writes a folder for any web server, and laboratory.html, a page in one file. They show
    the presets and lessons with recorded answers.
    """
    if options["static"] is not None:
        _write_files(options)
        return
    from stylobate.lab.pages import NO_PAGE, page_is_built
    from stylobate.lab.serving import LOOPBACK, serve

    host = options["host"]
    if host not in LOOPBACK:
        message = "other machines can reach the laboratory; its token lets them use it"
        print(f"stylobate: {message}", file=sys.stderr)
    if not page_is_built():
        print(NO_PAGE, file=sys.stderr)

    given, variable = options["token"], os.environ.get(_VARIABLE)
    token = variable or None if given is None else given

    def started(address: str) -> None:
        # Logs keep what is printed: a token that was chosen may be valid for longer than this server.
        shown = address if token is None else f"{address.partition('?')[0]} and asks for the token that you chose"
        print(f"The laboratory is at {shown} (Ctrl-C ends it)", flush=True)

    serve(
        host=host,
        port=options["port"],
        allowed_hosts=options["allow_host"] or (),
        token=token,
        started=started,
        browser=not options["no_browser"],
    )


def _write_files(options: Options) -> None:
    from stylobate.lab.static_site import SINGLE_FILE, write

    for name, default in _OF_SERVER.items():
        if options[name] not in (default, None, []):
            flag = name.replace("_", "-")
            raise ParameterError(f"--static starts no server, so --{flag} has no effect. Leave out --{flag}.")
    folder = options["static"]
    sizes = write(folder, progress=part_lines())
    print(f"{folder / 'index.html'}: for a web server, {sizes.folder / 1e6:.1f} MB in {sizes.files} files")
    print(f"{folder / SINGLE_FILE}: in one file, {sizes.single / 1e6:.1f} MB")
    print(f"loaded before the first motion, compressed: {sizes.first / 1e3:.0f} kB")
