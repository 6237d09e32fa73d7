"""Every file of tests can be imported on Windows, where some modules and names are missing."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
# Modules, and names of modules, that Python lacks on Windows.
MODULES = ("fcntl", "grp", "pty", "pwd", "resource", "syslog", "termios", "tty")
NAMES = {
    "os": "O_ASYNC O_NONBLOCK chown fork getegid geteuid getgid getuid killpg mkfifo mknod nice "
    "sched_getaffinity sched_setaffinity setsid statvfs sysconf uname",
    "select": "poll",
    "signal": "ITIMER_PROF ITIMER_REAL ITIMER_VIRTUAL SIGALRM SIGCHLD SIGCONT SIGHUP SIGKILL SIGPIPE SIGQUIT SIGSTOP "
    "SIGUSR1 SIGUSR2 SIGVTALRM SIG_BLOCK SIG_SETMASK alarm pthread_sigmask setitimer",
}


def needs_posix(node):
    """Return whether a node of syntax imports such a module or uses such a name."""
    match node:
        case ast.Import(names=names):
            return any(alias.name in MODULES for alias in names)
        case ast.ImportFrom(module=module):
            return module in MODULES
        case ast.Attribute(value=ast.Name(id=module), attr=name):
            return name in NAMES.get(module, "").split()
    return False


def when_imported(node):
    """Yield the nodes that are evaluated when a module is imported: all outside functions, and their decorators."""
    match node:
        case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.Lambda():
            now = [*getattr(node, "decorator_list", []), *node.args.defaults, *filter(None, node.args.kw_defaults)]
        case _:
            now = list(ast.iter_child_nodes(node))
    yield node
    for child in now:
        yield from when_imported(child)


def functions_of(tree):
    return (node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"))


def problems(text):
    """Return the lines that fail on Windows: when a file is imported, or in a test that is not skipped there."""
    tree = ast.parse(text)
    marks = [ast.unparse(node) for node in tree.body if isinstance(node, ast.Assign)]
    found = {node.lineno for node in when_imported(tree) if needs_posix(node)}
    if not any(mark.startswith("pytestmark = pytest.mark.posix") for mark in marks):
        for test in functions_of(tree):
            decorators = " ".join(map(ast.unparse, test.decorator_list))
            if "mark.posix" not in decorators and "mark.skipif" not in decorators:
                found |= {node.lineno for node in ast.walk(test) if needs_posix(node)}
    return sorted(found)


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("import resource", [1]),
        ("import signal\n@mark(signal.SIGKILL)\ndef test_a(): pass", [2]),
        ("import signal\ndef test_a(end=signal.SIGKILL): pass", [2]),
        ("import signal\nclass A:\n    end = signal.SIGHUP", [3]),
        ("def test_a():\n    import fcntl", [2]),
        ("@pytest.mark.posix\ndef test_a():\n    import fcntl", []),
        ("def helper():\n    import fcntl", []),
    ],
)
def test_lines_that_need_posix_are_found(text, lines):
    assert problems(text) == lines


def test_no_file_of_tests_needs_posix_where_it_is_not_skipped():
    found = {file.relative_to(TESTS): problems(file.read_text(encoding="utf-8")) for file in TESTS.rglob("*.py")}
    assert {str(file): lines for file, lines in found.items() if lines} == {}


WINDOWS = """
import os, select, signal, sys
# Libraries and stylobate ask for the platform before they use these names; only the tests must do without.
import distributed, filelock, hypothesis, matplotlib.pyplot, multiprocessing, playwright.sync_api, pytest, schemathesis
import scipy, statsmodels.api, sympy, uvicorn, zarr
for module in {modules}:
    sys.modules[module] = None
for module, names in {names}.items():
    for name in set(names.split()) - {{"sysconf"}}:
        vars(sys.modules[module]).pop(name, None)
options = ["--collect-only", "-q", "-n", "0", "--assert=plain", "-p", "no:cacheprovider", "-m", "", "tests"]
sys.exit(pytest.main(options))
"""


@pytest.mark.slow
@pytest.mark.posix
def test_all_tests_are_collected_without_the_names_that_windows_lacks():
    code = WINDOWS.format(modules=MODULES, names=NAMES)
    command = [sys.executable, "-c", code]
    collected = subprocess.run(command, cwd=TESTS.parent, capture_output=True, text=True, check=False)
    assert collected.returncode == 0, collected.stdout[-3000:] + collected.stderr[-3000:]
