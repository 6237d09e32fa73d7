"""The laboratory as static files: a folder for any web server, and one file that a browser opens from disk.

Both show the page with recorded answers and send no request to another machine.
"""

import base64
import gzip
import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from stylobate.errors import FileError
from stylobate.files import write_whole
from stylobate.lab import kernels
from stylobate.lab.limits import Limits
from stylobate.lab.options import about, lessons
from stylobate.lab.packing import packed
from stylobate.lab.pages import page_folder, page_is_built
from stylobate.lab.policy import POLICY, digest_of, written_policy
from stylobate.lab.recorded import AT_ONCE, Question, answer_to, questions
from stylobate.progress import Progress, in_parts, report_of, shows_progress

SINGLE_FILE = "laboratory.html"
"""Name of the page in one file."""

_CONTENTS = "answers"
"""Element of the page with the list of answers, beginning of the names of their elements, and their folder."""

_PROGRAMS = "programs"
"""Folder of the programs and records, and beginning of the names of their elements."""

_WORKER = "worker"
"""Name of the script of the workers that compute maps, and of its element."""

_OFFLINE = "offline.js"
"""Script of the service worker by which the folder works without a connection."""

_SCRIPT, _STYLE, _HEAD = (
    '<script type="module" src="main.js"></script>',
    '<link rel="stylesheet" href="main.css" />',
    '<meta charset="utf-8" />',
)
"""Lines of the page that its static forms replace or follow."""

_WAITING = "The laboratory is being set up…"
_FROM_DISK = (
    f'{_WAITING} From disk, open <a href="{SINGLE_FILE}">{SINGLE_FILE}</a> instead: this page needs a web server.'
)
"""Browsers run no script of a folder on disk: then this text stays."""

_FRAMES = "frame-ancestors"
"""Part of the policy that browsers accept from servers only."""
_WASM = "'wasm-unsafe-eval'"
"""Permission to compile WebAssembly; scripts still come from the page alone."""


@dataclass(frozen=True, slots=True)
class Sizes:
    """Sizes of what was written [bytes].

    Attributes
    ----------
    files
        Number of files in the folder, without the page in one file.
    folder, single
        Size of the folder without the page in one file, and of this page.
    first
        Size of what a browser loads for the first motion, compressed by gzip.
    """

    files: int
    folder: int
    single: int
    first: int


@shows_progress("recorded answers", in_parts)
def write(folder: Path, *, progress: Progress = None) -> Sizes:
    """Write the laboratory as static files.

    Parameters
    ----------
    folder
        Folder of the files; it is made if it does not exist. Its `index.html` works on any web server, at any address;
        its `laboratory.html` is the same page in one file.
    progress
        Called with the name of the present question, the number of answered questions and of all; False shows nothing.

    Returns
    -------
    Sizes
        The sizes of the files. The same version of the package writes the same files.

    Raises
    ------
    FileError
        If the page is not built, or a file cannot be written.
    """
    if not page_is_built():
        raise FileError("the page of the laboratory is not built. Run make page, or install a wheel of stylobate.")
    try:
        for part in (_CONTENTS, _PROGRAMS):
            (folder / part).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder}: cannot be made: {error.strerror or error}. Choose another folder.") from None
    report = report_of(progress)
    asked = list(questions())
    answers = {}
    for done, one in enumerate(asked):
        report(one.name, done, len(asked))
        answers[one.name] = packed(answer_to(one))
    programs = kernels.files()
    page, style, script, worker, offline = map(
        _page_file, ("index.html", "main.css", "main.js", f"{_WORKER}.js", _OFFLINE)
    )
    contents = _contents(asked)
    opening = lessons()[0]
    at_once = [ask for ask in AT_ONCE if opening.curves or ask != "response"]
    first = [f"{_CONTENTS}/{ask}-{opening.identity}.json" for ask in at_once]
    first += [f"{_PROGRAMS}/{name}" for name in kernels.files_of(opening.description)]
    files = {
        "main.css": style.encode(),
        "main.js": script.encode(),
        f"{_WORKER}.js": worker.encode(),
        **{f"{_CONTENTS}/{name}.json": answer for name, answer in answers.items()},
        **{f"{_PROGRAMS}/{name}": content for name, content in programs.items()},
    }
    first = [name for name in first if name in files]
    files["index.html"] = _for_server(page, contents, first).encode()
    files[_OFFLINE] = f"const offline = {_listed(files)};\n{offline}".encode()
    single = _single(page, style, (script, worker), contents, answers, programs).encode()
    for name, content in {**files, SINGLE_FILE: single}.items():
        write_whole(folder / name, content)
    loaded = ["index.html", "main.css", "main.js", *first]
    return Sizes(
        files=len(files),
        folder=sum(map(len, files.values())),
        single=len(single),
        first=sum(len(_zipped(files[name])) for name in loaded),
    )


def _page_file(name: str) -> str:
    return (page_folder() / name).read_text(encoding="utf-8")


def _listed(files: Mapping[str, bytes]) -> str:
    """Return the names of the files and a digest of their contents: a changed site has another digest."""
    digest = hashlib.sha256()
    for name, content in sorted(files.items()):
        digest.update(f"{name} {len(content)}\n".encode() + content)
    return json.dumps({"version": digest.hexdigest()[:16], "files": sorted(files)})


def _contents(asked: Iterable[Question]) -> str:
    """Return the element with the options of the page and the list of its answers."""
    listed = [{"ask": one.ask, "question": one.values, "name": one.name} for one in asked]
    text = json.dumps(
        {"about": json.loads(about(Limits()).as_json()), "answers": listed, "kernels": kernels.described()},
        ensure_ascii=False,
        separators=(",", ":"),
    )
    return _data(_CONTENTS, "application/json", text.replace("<", r"\u003c"))


def _data(identity: str, kind: str, text: str) -> str:
    return f'<script id="{identity}" type="{kind}">{text}</script>'


def _for_server(page: str, contents: str, first: Iterable[str]) -> str:
    """Return the page that finds its script, its style and its answers beside it."""
    policy = {**POLICY, "script-src": f"{POLICY['script-src']} {_WASM}", "worker-src": "'self'"}
    ahead = [f'<link rel="preload" as="fetch" crossorigin href="{name}" />' for name in first]
    return _replaced(
        page,
        {
            _HEAD: "\n    ".join([_HEAD, _policy(policy), f'<meta name="offline" content="{_OFFLINE}" />']),
            _SCRIPT: "\n    ".join([_SCRIPT, *ahead, contents]),
            _WAITING: _FROM_DISK,
        },
    )


def _single(
    page: str,
    style: str,
    scripts: tuple[str, str],
    contents: str,
    answers: Mapping[str, bytes],
    programs: Mapping[str, bytes],
) -> str:
    """Return the page with its scripts, its style, its answers and its programs in it."""
    # In a script only strings can have these words, where an escaped sign is the same.
    script, worker = (one.replace("</script", r"\x3c/script").replace("<!--", r"\x3c!--") for one in scripts)
    policy = {
        **POLICY,
        "script-src": f"{digest_of(script)} {_WASM}",
        "style-src": digest_of(style),
        "img-src": "data: blob:",
        "connect-src": "'none'",
        "worker-src": "blob:",  # made of the script of the workers, an element of the page
    }
    zipped = [
        _data(f"{folder}-{name}", "text/plain", base64.b64encode(_zipped(content)).decode())
        for folder, contained in ((_CONTENTS, answers), (_PROGRAMS, programs))
        for name, content in contained.items()
    ]
    return _replaced(
        page,
        {
            _HEAD: "\n    ".join([_HEAD, _policy(policy)]),
            _STYLE: f"<style>{style}</style>",
            _SCRIPT: f'<script type="module">{script}</script>',
            "</body>": "\n".join([contents, *zipped, _data(_WORKER, "text/plain", worker), "</body>"]),
        },
    )


def _policy(policy: Mapping[str, str]) -> str:
    allowed = {name: sources for name, sources in policy.items() if name != _FRAMES}
    return f'<meta http-equiv="Content-Security-Policy" content="{written_policy(allowed)}" />'


def _zipped(content: bytes) -> bytes:
    return gzip.compress(content, 9, mtime=0)


def _replaced(page: str, parts: Mapping[str, str]) -> str:
    """Return the page with each of these texts, which it has once, replaced."""
    pieces = [page]
    for old, new in parts.items():
        (number,) = (number for number, piece in enumerate(pieces) if old in piece)
        before, after = pieces[number].split(old)
        pieces[number : number + 1] = [before, new, after]
    return "".join(pieces)
