"""Parts of an assessment: what is kept is not computed again, and the progress begins there."""

import logging

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.inputs import Parts


def computing(progress):
    progress(1, 2)
    return xr.Dataset({"value": ("run", np.arange(3.0))})


def test_progress_goes_on_at_the_runs_of_the_parts_that_are_kept(tmp_path, caplog):
    def parts(*names):
        calls = []
        one = Parts(tmp_path, 40, lambda *call: calls.append(call))
        with caplog.at_level(logging.INFO, "stylobate"):
            for name in names:
                one.get(name, 10, {}, computing)
        return calls

    assert [done for _, done, _ in parts("a", "b")] == [0, 5, 10, 10, 15, 20]
    assert not caplog.messages
    assert parts("a", "b", "c") == [("c", done, 40) for done in (20, 25, 30)]
    assert caplog.messages == [f"2 parts were read from {tmp_path}; the assessment resumes there"]
