"""Machine code is read only from files that this user alone can have written, and that are whole."""

import errno
import logging
import os
import stat

import filelock
import pytest

from stylobate.compiler.kept import TrustedCache
from stylobate.errors import FileError

NAME, DATA = "kernel.code", b"machine code " * 40

ON_POSIX = pytest.mark.skipif(not hasattr(os, "geteuid"), reason="files have no owners here")


@pytest.fixture
def cache(tmp_path):
    cache = TrustedCache(tmp_path / "cache")
    cache.write(NAME, DATA)
    return cache


@pytest.fixture
def foreign(monkeypatch):
    """Give a file or folder to another user, as this process sees it."""

    def give(path):
        if os.geteuid() == 0:
            os.chown(path, 12345, -1)
        else:
            monkeypatch.setattr(os, "geteuid", lambda: 12345)

    return give


def names(cache):
    return sorted(path.name for path in cache.folder.iterdir())


def test_what_is_written_is_read(cache):
    assert cache.read(NAME) == DATA
    assert cache.read("another.code") is None


@ON_POSIX
def test_folder_and_files_are_made_for_their_owner_alone(cache):
    before = os.umask(0)
    try:
        fresh = TrustedCache(cache.folder / "deeper" / "folder")
        fresh.write(NAME, DATA)
    finally:
        os.umask(before)
    assert stat.S_IMODE(fresh.folder.stat().st_mode) == 0o700
    assert stat.S_IMODE((fresh.folder / NAME).stat().st_mode) == 0o600


SPOILT = {
    "empty": lambda sealed: b"",
    "cut in its head": lambda sealed: sealed[:10],
    "cut behind its head": lambda sealed: sealed[:60],
    "one byte short": lambda sealed: sealed[:-1],
    "one byte long": lambda sealed: sealed + b"\0",
    "one bit changed": lambda sealed: sealed[:-7] + bytes([sealed[-7] ^ 1]) + sealed[-6:],
    "of other contents": lambda sealed: b"import os\n",
}


@pytest.mark.parametrize("spoil", SPOILT.values(), ids=SPOILT)
def test_a_damaged_entry_counts_as_missing_and_is_named_in_one_line(cache, caplog, spoil):
    path = cache.folder / NAME
    path.write_bytes(spoil(path.read_bytes()))
    assert cache.read(NAME) is None
    assert len(caplog.messages) == 1
    assert str(path) in caplog.text
    assert "damaged" in caplog.text
    cache.write(NAME, DATA)
    assert cache.read(NAME) == DATA


def test_the_entry_of_another_name_is_no_substitute(cache):
    (cache.folder / NAME).rename(cache.folder / "another.code")
    assert cache.read("another.code") is None


@ON_POSIX
def test_a_file_that_others_can_have_written_is_not_read(cache, caplog, foreign):
    path = cache.folder / NAME
    path.chmod(0o622)
    assert cache.read(NAME) is None
    path.chmod(0o644)
    assert cache.read(NAME) == DATA
    foreign(path)
    assert cache.read(NAME) is None
    assert "other users can write to it" in caplog.messages[0]
    assert "belongs to another user" in caplog.messages[1]


@ON_POSIX
@pytest.mark.parametrize("mode", [0o777, 0o770])
def test_a_folder_that_others_can_write_to_is_refused(cache, mode):
    cache.folder.chmod(mode)
    with pytest.raises(FileError, match=r"other users can write to it \(got .*\$STYLOBATE_CACHE") as refusal:
        TrustedCache(cache.folder)
    assert "\n" not in str(refusal.value)


@ON_POSIX
def test_a_folder_of_another_user_is_refused(cache, foreign):
    foreign(cache.folder)
    with pytest.raises(FileError, match=r"belongs to another user \(got .*\$STYLOBATE_CACHE"):
        TrustedCache(cache.folder)


def test_a_full_disk_leaves_the_earlier_entry_and_nothing_half_written(cache):
    resource = pytest.importorskip("resource")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (200, hard))
    try:
        with pytest.raises(FileError, match="too large"):
            cache.write(NAME, 2 * DATA)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert names(cache) == [NAME]
    assert cache.read(NAME) == DATA


def test_a_folder_that_cannot_lock_is_used_without_locks(cache, monkeypatch):
    def refused(*_, **__):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(filelock.FileLock, "acquire", refused)
    with cache.held(NAME):
        assert cache.read(NAME) == DATA


def test_a_held_entry_makes_another_process_wait(cache):
    other = filelock.FileLock(cache.folder / f"{NAME}.lock", timeout=0)
    with cache.held(NAME), pytest.raises(TimeoutError):
        other.acquire()
    other.acquire()
    other.release()


def test_an_entry_that_cannot_be_read_counts_as_missing(cache, caplog):
    caplog.set_level(logging.WARNING)
    (cache.folder / "folder.code").mkdir()
    assert cache.read("folder.code") is None
    assert "cannot be read" in caplog.text
