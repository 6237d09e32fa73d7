"""Compiled code: from the cache if it is whole and ours, compiled otherwise, and the same bits each time."""

import errno
import linecache
import os
import threading
import time

import numpy as np
import pytest

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.kept import TrustedCache
from stylobate.compiler.machine import Machine
from stylobate.compiler.programs import Written
from stylobate.compiler.unit import ArrayArgument
from stylobate.errors import FileError, UnsupportedError

TEXT = '''"""The sum of a function over an array."""

def advance(x, out):
    total = 0.0
    for i in range(len(x)):
        total += rates(x[i])
    out[0] = total
'''
X = np.linspace(0.0, 1.0, 5)


def square(x):
    return x * x


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def compilations(monkeypatch):
    """Texts that are compiled."""
    texts, compile_it = [], Machine.object_code

    def compiled(machine, text):
        texts.append(text)
        return compile_it(machine, text)

    monkeypatch.setattr(Machine, "object_code", compiled)
    return texts


def squares(text=TEXT):
    """Return what is compiled as in a process of its own."""
    arguments = (ArrayArgument((None,)), ArrayArgument((1,)))
    return Compiled(
        "advance", lambda: Written(text), {"rates": square}, arguments, model="model", description="squares"
    )


def sum_of(compiled):
    out = np.zeros(1)
    compiled(X, out)
    return out[0]


def entry(folder, kind="code"):
    (path,) = folder.glob(f"*.{kind}")
    return path


def test_code_is_compiled_once_and_then_read(folder, compilations, caplog):
    assert sum_of(squares()) == sum_of(squares()) == np.sum(X**2)
    assert len(compilations) == 1
    assert caplog.messages == [f"compiling squares; kept in {folder}"]


@pytest.mark.parametrize("date", [0, 4e9])
def test_the_dates_of_files_do_not_matter(folder, compilations, date):
    sum_of(squares())
    for file in folder.iterdir():  # the clock went back, or forward
        os.utime(file, (date, date))
    assert sum_of(squares()) == np.sum(X**2)
    assert len(compilations) == 1


@pytest.mark.parametrize("length", [0, 40, 500])
def test_damaged_code_is_compiled_again_with_one_line(folder, compilations, caplog, length):
    sum_of(squares())
    whole = entry(folder).read_bytes()
    assert len(whole) > 500
    entry(folder).write_bytes(whole[:length])
    caplog.clear()
    assert sum_of(squares()) == np.sum(X**2)
    assert len(compilations) == 2
    assert sum("it is damaged" in line for line in caplog.messages) == 1
    assert entry(folder).read_bytes() == whole  # the same bytes, whenever they are compiled


def test_changed_code_is_never_run(folder, compilations):
    sum_of(squares())
    sealed = bytearray(entry(folder).read_bytes())
    place = sealed.index(b"advance")  # a name in it
    sealed[place] ^= 1
    entry(folder).write_bytes(sealed)
    sum_of(squares())
    assert len(compilations) == 2


def test_a_full_disk_costs_one_line_and_no_result(folder, compilations, caplog, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(TrustedCache, "write", full)
    assert sum_of(squares()) == np.sum(X**2)
    assert len(compilations) == 1
    assert [line for line in caplog.messages if "compiling" not in line] == [
        f"compiled code cannot be kept in {folder}: No space left on device; name another folder in $STYLOBATE_CACHE, "
        "or every process compiles it"
    ]


def test_a_folder_that_cannot_be_made_costs_one_line_and_no_result(folder, compilations, caplog):
    folder.write_text("in the way")
    assert sum_of(squares()) == np.sum(X**2)
    assert len(compilations) == 1
    assert len([line for line in caplog.messages if f"cannot be kept in {folder}" in line]) == 1


def test_from_a_warm_cache_nothing_is_written(folder, compilations, monkeypatch):
    sum_of(squares())

    def read_only(*_):
        raise OSError(errno.EROFS, "Read-only file system")

    for name in ("write", "held"):
        monkeypatch.setattr(TrustedCache, name, read_only)
    assert sum_of(squares()) == np.sum(X**2)
    assert len(compilations) == 1


@pytest.mark.posix
def test_a_cache_that_others_can_write_to_runs_nothing(folder, compilations):
    sum_of(squares())
    folder.chmod(0o777)
    with pytest.raises(FileError, match=r"\$STYLOBATE_CACHE"):
        sum_of(squares())


def test_of_two_that_need_code_at_once_one_compiles(folder, compilations):
    sum_of(squares())
    places = entry(folder, "places").read_bytes()
    program = entry(folder, "places").stem
    entry(folder, "places").unlink()
    begun = threading.Event()

    def compile_it():
        with TrustedCache(folder).held(program):
            begun.set()
            time.sleep(0.2)
            (folder / f"{program}.places").write_bytes(places)

    thread = threading.Thread(target=compile_it)
    thread.start()
    begun.wait()
    assert sum_of(squares()) == np.sum(X**2)
    thread.join()
    assert len(compilations) == 1


def test_what_cannot_be_compiled_is_named_and_not_kept(folder):
    with pytest.raises(UnsupportedError, match=r"model model cannot be compiled; .*too many positional arguments"):
        sum_of(squares(TEXT.replace("rates(x[i])", "rates(x[i], 2.0)")))
    assert list(folder.glob("*.code")) == []


def test_written_text_is_found_when_others_forget_it(folder, compilations):
    compiled = squares()
    assert compiled.module
    linecache.clearcache()
    assert sum_of(compiled) == np.sum(X**2)


def test_plain_python_computes_the_same_without_compiling(folder, compilations, monkeypatch):
    monkeypatch.setenv("STYLOBATE_PLAIN", "1")
    assert sum_of(squares()) == np.sum(X**2)
    assert compilations == []
    assert not folder.exists()
