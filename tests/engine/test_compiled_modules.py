"""Compiled modules: from the cache if it is whole and ours, compiled otherwise, and the same bits each time."""

import errno
import functools
import threading
import time

import numpy as np
import pytest

from stylobate.engine.compiling import arithmetic, modules
from stylobate.engine.compiling.apart import compile_apart
from stylobate.engine.compiling.trusted_cache import TrustedCache
from stylobate.errors import FileError, UnsupportedError

SOURCE = '''"""The sum of a function over an array."""
from stylobate.engine.compiling.loading import kept

@kept("float64(float64[::1])")
def advance(x):
    total = 0.0
    for i in range(x.size):
        total += rates(x[i])
    return total
'''
X = np.linspace(0.0, 1.0, 5)


def square(x):
    return x * x


@functools.cache
def machine_code(name, source):
    """Compile in a process apart, once for all tests."""
    return compile_apart(name, source, {"rates": square})


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def compilations(monkeypatch):
    """Names of what is compiled, which takes no time here."""
    names = []

    def compiled(name, source, _):
        names.append(name)
        return machine_code(name, source)

    monkeypatch.setattr(modules, "compile_apart", compiled)
    return names


def squares(source=SOURCE):
    return modules.compiled_module(
        "squares", source, {"rates": square}, imported=(arithmetic,), told="squares", of="model"
    )


def entry(folder):
    (path,) = folder.glob("*.code")
    return path


def test_a_module_is_compiled_once_and_then_read(folder, compilations, caplog):
    first, second = squares(), squares()
    assert first.advance(X) == second.advance(X) == np.sum(X**2)
    assert len(compilations) == 1
    assert caplog.messages == [f"compiling squares; kept in {folder}"]
    for module in (first, second):  # both from the bytes, so that the first process computes what later ones do
        assert (sum(module.advance.stats.cache_hits.values()), sum(module.advance.stats.cache_misses.values())) == (
            1,
            0,
        )


@pytest.mark.parametrize("length", [0, 40, 5000])
def test_damaged_machine_code_is_compiled_again_with_one_line(folder, compilations, caplog, length):
    squares()
    whole = entry(folder).read_bytes()
    assert len(whole) > 5000
    entry(folder).write_bytes(whole[:length])
    caplog.clear()
    assert squares().advance(X) == np.sum(X**2)
    assert len(compilations) == 2
    assert sum("it is damaged" in line for line in caplog.messages) == 1
    assert entry(folder).read_bytes() == whole


def test_changed_machine_code_is_never_run(folder, compilations):
    squares()
    sealed = bytearray(entry(folder).read_bytes())
    place = sealed.index(b"total") + 1  # a name in its code for Python
    sealed[place] ^= 1
    entry(folder).write_bytes(sealed)
    squares()
    assert len(compilations) == 2


def test_a_full_disk_costs_one_line_and_no_result(folder, compilations, caplog, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(TrustedCache, "write", full)
    assert squares().advance(X) == np.sum(X**2)
    assert len(compilations) == 1
    assert [line for line in caplog.messages if "compiling" not in line] == [
        f"compiled code cannot be kept in {folder}: No space left on device; name another folder in $STYLOBATE_CACHE, "
        "or every process compiles it"
    ]


def test_a_folder_that_cannot_be_made_costs_one_line_and_no_result(folder, compilations, caplog):
    folder.write_text("in the way")
    assert squares().advance(X) == np.sum(X**2)
    assert len(compilations) == 1
    assert len([line for line in caplog.messages if f"cannot be kept in {folder}" in line]) == 1


def test_from_a_warm_cache_nothing_is_written(folder, compilations, monkeypatch):
    squares()

    def read_only(*_):
        raise OSError(errno.EROFS, "Read-only file system")

    for name in ("write", "held"):
        monkeypatch.setattr(TrustedCache, name, read_only)
    assert squares().advance(X) == np.sum(X**2)
    assert len(compilations) == 1


def test_a_cache_that_others_can_write_to_runs_nothing(folder, compilations):
    squares()
    folder.chmod(0o777)
    with pytest.raises(FileError, match=r"\$STYLOBATE_CACHE"):
        squares()


def test_of_two_that_need_a_module_at_once_one_compiles(folder, compilations):
    begun = threading.Event()
    name = f"squares_{modules._key(SOURCE, {'rates': square}, (arithmetic,))}"

    def compile_it():
        cache, entry = TrustedCache(folder), f"{name}.{modules._machine()}.code"
        with cache.held(entry):
            begun.set()
            time.sleep(0.2)
            cache.write(entry, machine_code(name, SOURCE))

    thread = threading.Thread(target=compile_it)
    thread.start()
    begun.wait()
    assert squares().advance(X) == np.sum(X**2)
    thread.join()
    assert compilations == []


def test_what_cannot_be_compiled_is_named_and_not_kept(folder, monkeypatch):
    monkeypatch.setattr(modules, "compile_apart", lambda *_: b"")  # as it fails in a process apart
    source = SOURCE.replace("rates(x[i])", "rates(x[i], 'text')")
    with pytest.raises(UnsupportedError, match="model model cannot be compiled"):
        squares(source)
    assert list(folder.glob("*.code")) == []
