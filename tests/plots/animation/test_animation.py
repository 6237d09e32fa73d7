"""Animations hold every picture, take their time, and say in one line what they cannot do."""

import base64
import hashlib
import json
import re
import sys
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

import stylobate as sb
from stylobate.errors import FileError, ParameterError, UnlikelyInputWarning, UnsupportedError
from stylobate.plots.animation import formats
from stylobate.plots.animation.animation import Animation
from stylobate.plots.animation.drawing import Drawing
from stylobate.plots.animation.motion import drawn_motion

SMALL = {"size": (320, 280), "frames_per_second": 12}


@pytest.fixture(scope="module")
def run():
    column = sb.Column.solid(radius=0.1, height=0.6, density=2700.0)
    return sb.simulate(sb.Rolling(column, damping=0.02), tilt=(0.15, 0.0), tilt_rate=(0.0, 0.3), duration=1.0)


@pytest.fixture(scope="module")
def animation(run):
    return sb.animate(run, **SMALL)


@pytest.fixture(scope="module")
def gif(animation):
    return animation.gif()


def pictures_of(data):
    with Image.open(BytesIO(data)) as opened:
        for number in range(opened.n_frames):
            opened.seek(number)
            yield opened.convert("RGB"), opened.info["duration"]


def test_a_gif_has_every_picture_and_takes_its_time(animation, gif):
    durations = [duration for _, duration in pictures_of(gif)]
    assert len(durations) == len(animation) == 13
    # 12 frames per second in hundredths of a second: 80 and 90 ms by turns, 1 s in all, and a pause at the end.
    assert set(durations[:-1]) == {80, 90}
    assert sum(durations[:-1]) == 1000
    assert durations[-1] == 2500
    with Image.open(BytesIO(gif)) as opened:
        assert opened.info["loop"] == 0


def test_a_gif_shows_what_was_painted(animation, gif):
    for painted, (shown, _) in zip(animation.pictures(), pictures_of(gif), strict=True):
        apart = np.abs(np.asarray(painted).astype(int) - np.asarray(shown)).max(axis=-1)
        assert apart.mean() < 2.0
        assert (apart > 60).mean() < 1e-3


def test_a_column_that_stands_still_passes_the_time():
    column = sb.Column.solid(radius=0.1, height=0.6, density=2700.0)
    standing = sb.animate(sb.simulate(sb.Rolling(column), duration=1000.0), size=(320, 280), speed=1000.0)
    # The clock changes in each picture, the column in none.
    shown = list(pictures_of(standing.gif()))
    assert len(shown) == len(standing) == 26
    assert sum(duration for _, duration in shown[:-1]) == 1000


def test_slower_motion_has_more_pictures(run, animation):
    slow = sb.animate(run, **SMALL, speed=0.5)
    assert len(slow) == 25
    np.testing.assert_allclose(slow.motion.time[::2], animation.motion.time, atol=1e-12)


def test_too_few_pictures_of_a_swing_are_told_with_the_speed_that_shows_it():
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    fast = sb.Harmonic.straight(acceleration=0.05, angular_frequency=60.0)
    run = sb.simulate(model, fast, tilt=(0.03, 0.0), duration=1.0)
    with pytest.warns(UnlikelyInputWarning, match=r"base frequency of 9.549 Hz. Multiply speed by 0.31 or less"):
        sb.animate(run, **SMALL)
    sb.animate(run, **SMALL, speed=0.31)


def test_a_notebook_shows_the_gif(animation, gif):
    shown = animation._repr_html_()
    data = re.search(r'src="data:image/gif;base64,([^"]+)"', shown)[1]
    assert base64.b64decode(data) == gif
    assert 'alt="still moving' in shown


def test_progress_is_told_after_each_picture(animation, tmp_path):
    told = []
    animation.save(tmp_path / "run.gif", progress=lambda done, total: told.append((done, total)))
    assert told == [(number, 13) for number in range(1, 14)]


def test_a_file_is_written_by_its_suffix_and_nothing_else(run, animation, gif, tmp_path):
    found = sb.animate(run, tmp_path / "run.GIF", **SMALL)
    assert isinstance(found, Animation)
    assert (tmp_path / "run.GIF").read_bytes() == gif
    assert animation.save(str(tmp_path / "again.gif")) == tmp_path / "again.gif"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["again.gif", "run.GIF"]


def test_an_mp4_has_every_picture_and_holds_the_last(animation, tmp_path):
    import imageio_ffmpeg

    animation.save(tmp_path / "run.mp4")
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(tmp_path / "run.mp4"))
    assert frames == 13 + 18
    assert seconds == pytest.approx(frames / 12, abs=0.05)
    assert [path.name for path in tmp_path.iterdir()] == ["run.mp4"]


def test_an_mp4_without_ffmpeg_names_the_remedy(animation, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(UnsupportedError, match=re.escape("pip install 'stylobate[video]'")):
        animation.save(tmp_path / "run.mp4")
    assert not list(tmp_path.iterdir())


def test_an_mp4_of_odd_size_is_refused(run, tmp_path):
    with pytest.raises(ParameterError, match=r"size must have even numbers for an MP4, got \(321, 280\)"):
        sb.animate(run, tmp_path / "run.mp4", size=(321, 280))


@pytest.fixture
def viewer(monkeypatch, tmp_path):
    folder = tmp_path / "viewer"
    folder.mkdir()
    (folder / "viewer.js").write_text('var stylobateViewer = "</script><!-- é";\r\n', encoding="utf-8", newline="")
    monkeypatch.setattr(formats, "files", lambda name: folder)
    return folder / "viewer.js"


@pytest.mark.usefixtures("viewer")
def test_a_page_holds_the_motion_and_loads_nothing(run, tmp_path):
    sb.animate(run, tmp_path / "run.html", **SMALL)
    text = (tmp_path / "run.html").read_text(encoding="utf-8")
    held = re.search(r'<script type="application/json" id="motion">(.*?)</script>', text, re.DOTALL)[1]
    assert json.loads(held) == drawn_motion(run)
    assert "http:" not in text
    assert "https:" not in text
    assert "src=" not in text


@pytest.mark.usefixtures("viewer")
def test_a_page_may_run_its_own_scripts_and_no_others(run):
    text = sb.animate(run, **SMALL).html()
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', text)[1]
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    assert len(scripts) == 2

    def hashes(texts):
        return " ".join(f"'sha256-{base64.b64encode(hashlib.sha256(t.encode()).digest()).decode()}'" for t in texts)

    assert rules["default-src"] == "'none'"
    assert rules["script-src"] == hashes(scripts)
    assert rules["style-src"] == hashes(re.findall(r"<style>(.*?)</style>", text, re.DOTALL))


@pytest.mark.usefixtures("viewer")
def test_a_title_cannot_break_out_of_its_page(run):
    title = '</script><script>alert("1")</script>'
    text = sb.animate(run, **SMALL, title=title).html()
    assert "<script>alert" not in text
    held = re.search(r'id="motion">(.*?)</script>', text, re.DOTALL)[1]
    assert json.loads(held)["title"] == title


def test_a_page_without_its_viewer_names_the_remedy(run, viewer, tmp_path):
    viewer.unlink()
    with pytest.raises(UnsupportedError, match="'npm ci && npm run build' in src/stylobate/lab/web"):
        sb.animate(run, tmp_path / "run.html", **SMALL)


def test_a_loaded_run_can_be_animated(run, animation, tmp_path):
    again = sb.animate(sb.load(run.save(tmp_path / "run.nc")), **SMALL)
    np.testing.assert_allclose(again.motion.tilt, animation.motion.tilt, atol=1e-5)


def test_a_title_stands_in_the_pictures(run, animation):
    titled = next(sb.animate(run, **SMALL, title="A column").pictures())
    assert titled.tobytes() != next(animation.pictures()).tobytes()


def test_too_many_pictures_are_refused_with_a_speed_that_works(run):
    with pytest.raises(ParameterError, match="more than 1500 frames") as refused:
        sb.animate(run, speed=1e-3, **SMALL)
    remedy = float(re.search(r"Pass speed=([\d.e-]+)\.$", str(refused.value))[1])
    assert 300 <= len(sb.animate(run, speed=remedy, **SMALL)) <= 1500


@pytest.mark.parametrize("duration", [3.0, 65.0, 130.0])
def test_without_a_speed_a_run_of_any_length_can_be_animated(duration):
    column = sb.Column.solid(radius=0.1, height=0.6, density=2700.0)
    long = sb.simulate(sb.Slender(column, damping=0.0), tilt=(0.05, 0.0), tilt_rate=(0.0, 0.1), duration=duration)
    few = sb.animate(long, **SMALL | {"frames_per_second": 25.0})
    assert few.history.time[-1] == pytest.approx(duration)
    assert len(few) <= 1500
    assert few.look.pace == {3.0: 1.0, 65.0: 2.0, 130.0: 5.0}[duration]


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"size": (100, 280)}, r"size\[0\] must be a whole number of at least 320, got 100"),
        ({"size": (640.5, 480)}, r"size\[0\] must be a whole number"),
        ({"size": 640}, r"size must have 2 numbers, got 640"),
        ({"size": (9999, 480)}, "size must be at most 3840 × 2160 pixels, got 9999 × 480"),
        ({"frames_per_second": 0}, "frames_per_second must be positive"),
        ({"frames_per_second": 60}, "frames_per_second must be at most 50, got 60"),
        ({"speed": -1.0}, "speed must be positive, got -1.0"),
        ({"elevation": 95.0}, "elevation must be at most 90 degrees"),
        ({"elevation": 0.0}, "elevation must be positive"),
        ({"azimuth": float("nan")}, "azimuth must be finite"),
        ({"path": "run.avi"}, r"path must end with \.gif, \.mp4 or \.html, got 'run\.avi'"),
        ({"path": "run"}, "path must end with"),
    ],
)
def test_options_out_of_range_are_named_in_one_line(run, options, line):
    with pytest.raises(ParameterError, match=line) as refused:
        sb.animate(run, **options)
    assert "\n" not in str(refused.value)


def test_what_is_no_run_is_refused():
    with pytest.raises(ParameterError, match="run must be a run"):
        sb.animate([1, 2])


@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_a_file_that_cannot_be_written_is_told(animation, tmp_path, suffix):
    with pytest.raises(FileError, match=r"^cannot write .*missing") as refused:
        animation.save(tmp_path / "missing" / f"run{suffix}")
    assert "\n" not in str(refused.value)


def test_a_failure_in_the_middle_leaves_no_file(animation, tmp_path, monkeypatch):
    def broken(painter, index):
        raise RuntimeError

    monkeypatch.setattr(Drawing, "picture", broken)
    for suffix in (".gif", ".mp4"):
        with pytest.raises(RuntimeError):
            animation.save(tmp_path / f"run{suffix}")
    assert not list(tmp_path.iterdir())


def test_an_animation_tells_what_it_is(animation):
    assert repr(animation).startswith("Animation(13 pictures, 320 × 280: still moving")
