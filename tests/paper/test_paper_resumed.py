"""A check of the paper that was interrupted goes on where it stopped, and finds what an uninterrupted one finds."""

import importlib

import numpy as np
import pytest
import xarray as xr

from stylobate.errors import FileError
from stylobate.paper.analyses import check_paper, finished
from stylobate.results.findings import ClaimStatus, Finding, PaperSection

paper = importlib.import_module("stylobate.paper.analyses")

HEADINGS = ("First", "The second one", "Third")


@pytest.fixture
def calls(monkeypatch):
    """The headings of the sections that are computed; one that is in `calls.stopping` is interrupted."""

    class Calls(list):
        stopping = ()

    calls = Calls()

    def check(heading):
        def computed():
            calls.append(heading)
            if heading in calls.stopping:
                raise KeyboardInterrupt
            values = np.arange(3) / len(heading)
            data = xr.Dataset(
                {"value": ("x", values), "stable": ("x", values > 0.1)}, {"x": ["a", "b", "c"]}, {"c": 0.1}
            )
            return PaperSection(
                (Finding("(1)", f"{heading} – ν", "1e-3", ClaimStatus.ERRATUM),), {f"data {heading}": data}
            )

        return computed

    monkeypatch.setattr(paper, "_ANALYSES", {heading: paper._Analysis(check(heading), 1.0) for heading in HEADINGS})
    return calls


def described(check):
    return {
        heading: (section.findings, {name: data.to_dict() for name, data in section.data.items()})
        for heading, section in check.sections.items()
    }


def test_finished_sections_are_computed_once_and_the_result_is_the_same(calls, tmp_path):
    whole = described(check_paper())
    calls.clear()
    calls.stopping = ("Third",)
    with pytest.raises(KeyboardInterrupt):
        check_paper(folder=tmp_path)
    calls.stopping = ()
    assert described(check_paper(folder=tmp_path)) == whole
    assert calls == ["First", "The second one", "Third", "Third"]
    check_paper(folder=tmp_path)
    assert len(calls) == 4


def test_progress_counts_what_was_finished_before(calls, tmp_path):
    told = []
    check_paper(folder=tmp_path, progress=lambda *now: told.append(now))
    assert told == [("", 0, 3, 0.0), *((heading, n, 3, n / 3) for n, heading in enumerate(HEADINGS, 1))]
    told.clear()
    check_paper(folder=tmp_path, progress=lambda *now: told.append(now))
    assert told == [("", 3, 3, 1.0)]


def test_a_damaged_section_is_computed_again(calls, tmp_path):
    check_paper(folder=tmp_path)
    files = sorted((tmp_path / "analyses").iterdir())
    assert len(files) == 3
    changed = bytearray(files[0].read_bytes())
    changed[-1] ^= 1
    files[0].write_bytes(changed)
    files[1].write_bytes(b"")
    calls.clear()
    check_paper(folder=tmp_path)
    assert sorted(calls) == ["First", "The second one"]
    assert sorted((tmp_path / "analyses").iterdir()) == files


def test_sections_of_other_code_are_computed_again_and_replaced(calls, tmp_path, monkeypatch):
    check_paper(folder=tmp_path)
    monkeypatch.setattr(finished, "fingerprint", lambda: "0123456789abcdef")
    calls.clear()
    check_paper(folder=tmp_path)
    assert len(calls) == 3
    assert len(list((tmp_path / "analyses").iterdir())) == 3


def test_a_folder_that_cannot_be_written_is_named_in_one_line(calls, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileError, match=r"cannot write into .*file") as refusal:
        check_paper(folder=tmp_path / "file")
    assert "\n" not in str(refusal.value)
