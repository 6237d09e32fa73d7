"""What is seen in the pictures is where the motion says it is."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.text import Text

import stylobate as sb
from stylobate.plots import body
from stylobate.plots.animation.drawing import Drawing, Look, Scene, round_length
from stylobate.plots.animation.motion import DrawnMotion, contact_path
from stylobate.plots.body import MARKED, FlutedColumn, lit
from stylobate.plots.geometry import Shape, View, direction, frames

LOOK = Look(size=(480, 360), view=View(math.radians(-68.0), math.radians(20.0)))
DISC = sb.Column.solid(radius=0.1, height=0.05, density=2700.0)


@pytest.fixture(scope="module")
def motion():
    circle = sb.Harmonic.circular(acceleration=1.5, angular_frequency=6.0)
    model = sb.Rolling(DISC, damping=0.002)
    return DrawnMotion.of(
        sb.simulate(model, circle, tilt=(0.4, 0.0), tilt_rate=(0.0, 1.5), duration=1.0), frames_per_second=25.0
    )


@pytest.fixture(scope="module")
def drawing(motion):
    return Drawing(motion, motion, LOOK)


def picture_of(motion, index=0, look=LOOK):
    return np.asarray(Drawing(motion, motion, look).picture(index)).astype(int)


def bytes_of(colour):
    return np.round(255.0 * np.array(to_rgb(colour)))


@pytest.mark.parametrize("index", [0, 8, 19])
def test_the_contact_point_is_drawn_where_it_is(drawing, motion, index):
    x, y = drawing.pixels(np.append(motion.contact_point[index], 0.0) + motion.base[index])
    picture = np.asarray(drawing.picture(index)).astype(int)
    near = picture[round(y) - 6 : round(y) + 7, round(x) - 6 : round(x) + 7]
    strong = np.abs(near - bytes_of(body.CONTACT_POINT)).sum(axis=-1) < 60
    # A dot of 6 points, or a ring of the same.
    assert strong.sum() >= 12
    assert np.argwhere(strong).mean(axis=0) == pytest.approx([6.0, 6.0], abs=1.5)


def test_all_of_the_column_is_in_every_picture(drawing, motion):
    rims = np.concatenate([drawing.column.bottom, drawing.column.top])
    for rotation, centre, base in zip(frames(motion.rotation), motion.centre, motion.base, strict=True):
        pixels = drawing.pixels(rims @ rotation.T + centre + base)
        assert pixels.min() > 0.0
        assert np.all(pixels.max(axis=0) < LOOK.size)


def test_a_metre_is_as_long_upwards_as_across(motion):
    drawing = Drawing(motion, motion, replace(LOOK, view=View(-0.5 * math.pi, 0.0)))
    origin, across, up = drawing.pixels(np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.1]]))
    assert (across - origin)[0] == pytest.approx((origin - up)[1], rel=1e-12)
    assert (across - origin)[1] == pytest.approx(0.0, abs=1e-9)


def test_a_displaced_base_is_drawn_displaced_by_as_much(motion):
    moved = replace(motion, base=motion.base + np.array([0.0, 0.0, 0.02])[None] * np.arange(len(motion.base))[:, None])
    drawing = Drawing(moved, moved, LOOK)
    places = []
    for index in (0, 20):
        drawing.picture(index)
        places.append(drawing._top.get_xy()[0])
    step = moved.base[20] - moved.base[0]
    np.testing.assert_allclose(places[1] - places[0], LOOK.view.project(step), atol=1e-12)


def test_the_mark_turns_with_the_column(motion):
    upright = replace(motion, tilt=0.0 * motion.tilt)
    first, turned = (picture_of(one) for one in (upright, replace(upright, twist=motion.twist + 0.5 * math.pi)))

    def centre_of_mark(picture):
        found = np.argwhere((picture[..., 0] > 1.6 * picture[..., 2]) & (picture[..., 0] > 60))
        found = found[found[:, 0] < LOOK.size[1] - 92]
        return found.mean(axis=0)

    # From the side that faces the viewer to the right, anticlockwise from above.
    assert centre_of_mark(turned)[1] > centre_of_mark(first)[1] + 20


def test_the_same_instant_is_always_the_same_picture(drawing):
    assert drawing.picture(3).tobytes() == drawing.picture(3).tobytes()
    assert drawing.picture(3).tobytes() != drawing.picture(4).tobytes()


def test_facets_close_the_shaft_and_the_mark_faces_the_viewer():
    column = FlutedColumn.of(Shape(radius=0.5, top_radius=0.4, height=2.0, mass_height=1.0, slenderness=0.5))
    np.testing.assert_allclose(np.hypot(*column.bottom[:, :2].T), 0.5)
    np.testing.assert_allclose(np.hypot(*column.top[:, :2].T), 0.4)
    np.testing.assert_allclose(np.linalg.norm(column.normals, axis=-1), 1.0)
    # Over a flute its hollows cancel: the mean normal is that of its middle.
    marked = np.isclose(column.colours, to_rgb(body.MARK)).all(axis=1)
    mean = column.normals[0, marked].mean(axis=0)
    assert math.atan2(mean[1], mean[0]) == pytest.approx(MARKED)
    ends = np.arctan2(*column.bottom[column.wedge][:, 1::-1].T)
    assert ends.min() < MARKED < ends.max()


def test_light_brightens_what_faces_it_and_never_beyond_white():
    light = direction(0.0, 0.8)
    faces = lit(np.full((3, 3), 0.98), np.stack([light, -light, np.array([0.0, 0.0, 1.0])]), light)[:, 0]
    assert faces[0] > faces[2] > faces[1] > 0.0
    assert faces.max() <= 1.0


def test_the_slab_holds_all_footprints_and_the_ground_never_cuts_it(motion):
    wandering = replace(motion, footprint=motion.footprint + np.linspace(0.0, 2.0, len(motion.footprint))[:, None])
    tilted = replace(wandering, incline=0.4, incline_direction=2.0)
    for one in (motion, wandering, tilted):
        scene = Scene.of(one)
        assert np.all(one.footprint - DISC.radius > scene.low)
        assert np.all(one.footprint + DISC.radius < scene.high)
        lowest = (scene.slab(-scene.thickness) + one.base[:, None]) @ scene.turned.T
        assert lowest[..., 2].min() >= scene.ground - 1e-12


def test_an_inclined_plane_falls_towards_its_direction(motion):
    scene = Scene.of(replace(motion, incline=0.3, incline_direction=0.8))
    down = scene.turned @ np.array([math.cos(0.8), math.sin(0.8), 0.0])
    assert down[2] == pytest.approx(-math.sin(0.3))


def test_the_path_runs_along_the_rim_between_instants(motion):
    still = replace(motion, footprint=0.0 * motion.footprint, contact_point=motion.contact_point - motion.footprint)
    _, points = contact_path(still)
    points = points[np.isfinite(points[:, 0])]
    np.testing.assert_allclose(np.hypot(*points.T), DISC.radius, rtol=1e-9)
    assert np.hypot(*np.diff(points, axis=0).T).max() < 0.11 * DISC.radius


def test_no_path_is_drawn_where_nothing_of_the_rim_touches(motion):
    resting = motion.resting.copy()
    resting[5:12] = True
    times, points = contact_path(replace(motion, resting=resting))
    gaps = np.flatnonzero(np.isnan(points[:, 0]))
    assert len(gaps) == 2
    assert times[gaps[0]] == motion.time[4]
    assert times[gaps[0] + 1] == motion.time[12]


def test_a_column_that_stands_throughout_leaves_no_path(motion):
    times, points = contact_path(replace(motion, resting=np.ones_like(motion.resting)))
    assert times.shape == (0,)
    assert points.shape == (0, 2)


@pytest.mark.parametrize("power", [-6, 0, 4])
def test_lengths_are_rounded_down_to_1_2_and_5(power):
    for given, known in ((1.0, 1.0), (1.9, 1.0), (2.1, 2.0), (4.99, 2.0), (5.5, 5.0), (9.9, 5.0)):
        assert round_length(given * 10.0**power) == pytest.approx(known * 10.0**power)


@pytest.mark.parametrize("elevation", [0.5, 20.0, 90.0])
def test_any_view_from_above_can_be_drawn(motion, elevation):
    look = replace(LOOK, view=View(2.0, math.radians(elevation)))
    assert Drawing(motion, motion, look).picture(0).size == LOOK.size


# What the page shows and pictures do not: the rim's visits, the path of the tip, and how its lights mix.
ON_THE_PAGE_ALONE = {"rim", "tip", "tipOld", "sun", "sky", "earth"}


def test_one_thing_has_one_colour_in_pictures_and_on_the_page():
    sources = Path(sb.__file__).parent / "lab/web/src"
    if not sources.exists():
        pytest.skip("the page's sources are not here")
    (source,) = sources.rglob("palette.ts")
    text = source.read_text(encoding="utf-8")
    named = dict(re.findall(r'^const (\w+) = "(#\w+)";', text, re.MULTILINE))
    light = text.partition("const LIGHT: Palette = {")[2].partition("};")[0]
    page = dict(re.findall(r"^  (\w+): (.+),$", light, re.MULTILINE))
    assert page.keys() >= ON_THE_PAGE_ALONE | {"mark", "contact"}
    shared = {name: value for name, value in page.items() if name not in ON_THE_PAGE_ALONE}
    own = {name: getattr(body, re.sub("([A-Z])", r"_\1", name).upper()) for name in shared}
    assert own == {
        name: float(value) if "." in value else named.get(value, value.strip('"')) for name, value in shared.items()
    }


def test_the_footprint_of_a_column_that_stands_has_the_colour_of_what_touches(motion):
    upright = replace(motion, tilt=0.0 * motion.tilt)

    def blue(resting):
        one = replace(upright, resting=np.full_like(motion.resting, resting))
        painted = picture_of(one)[: LOOK.size[1] - 92]
        return int((painted[..., 2] - painted[..., 0] > 60).sum())

    assert blue(True) > 20
    assert blue(False) == 0


@pytest.mark.parametrize("title", [None, "a title", "a title " * 30])
@pytest.mark.parametrize("width", [320, 640])
def test_no_text_runs_into_another_or_out_of_the_picture(motion, title, width):
    fallen = replace(motion, outcome=sb.Outcome.OVERTURNED)
    drawing = Drawing(fallen, fallen, replace(LOOK, size=(width, 300), title=title))
    drawing.picture(motion.time.size - 1)
    texts = [one for one in drawing._figure.findobj(Text) if one.get_text() and one.get_visible()]
    shown = [(one.get_text(), one.get_window_extent()) for one in texts if one.axes is None or one in one.axes.texts]
    assert any(text == "overturned" for text, _ in shown)
    for at, (_, box) in enumerate(shown):
        assert box.x0 >= 0.0
        assert box.x1 <= width
        assert not any(box.overlaps(other) for _, other in shown[:at])
