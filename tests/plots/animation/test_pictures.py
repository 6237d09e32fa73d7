"""What is seen in the pictures is where the motion says it is."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import ImageDraw

import stylobate as sb
from stylobate.plots.animation import DrawnMotion, palette
from stylobate.plots.animation.body import MARK, Body
from stylobate.plots.animation.canvas import FINE, rgb
from stylobate.plots.animation.lens import Lens
from stylobate.plots.animation.painter import Look, Painter
from stylobate.plots.animation.scene import Scene, round_length
from stylobate.plots.animation.shading import clipped, light_for, lit, shadow
from stylobate.plots.animation.trace import Trace
from stylobate.plots.axonometry import View
from stylobate.plots.pose import frames
from stylobate.plots.shape import Shape

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
def painter(motion):
    return Painter.of(motion, motion, LOOK)


def test_a_lens_shows_everything_and_fills_its_room():
    points = np.random.default_rng(0).normal(size=(50, 3))
    pixels = Lens.fitting(LOOK.view, points, (10.0, 20.0), (400.0, 300.0)).pixels(points)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    assert np.all(low >= np.array([10.0, 20.0]) - 1e-9)
    assert np.all(high <= np.array([400.0, 300.0]) + 1e-9)
    assert np.isclose(high - low, [390.0, 280.0]).any()


def test_a_displaced_base_is_seen_displaced_by_as_much_everywhere():
    points, step = np.random.default_rng(1).normal(size=(9, 3)), np.array([0.3, -0.2, 0.1])
    lens = Lens(view=LOOK.view, scale=70.0, origin=np.array([5.0, 6.0]))
    moved = lens.pixels(points + step) - lens.pixels(points)
    np.testing.assert_allclose(moved, np.tile(lens.shift(step), (9, 1)), atol=1e-12)


def test_heights_are_seen_upwards_and_lengths_across_in_scale():
    lens = Lens(view=View(-0.5 * math.pi, 0.0), scale=100.0, origin=np.zeros(2))
    np.testing.assert_allclose(lens.pixels([[0.5, 9.0, 2.0]]), [[50.0, -200.0]], atol=1e-12)


@pytest.mark.parametrize("index", [0, 8, 19])
def test_the_contact_point_is_painted_where_it_is(painter, motion, index):
    at = np.append(motion.contact_point[index], 0.0) + motion.base[index]
    x, y = painter.lens.pixels(at) / FINE
    picture = np.asarray(painter.picture(index)).astype(int)
    near = picture[round(y) - 6 : round(y) + 7, round(x) - 6 : round(x) + 7]
    strong = np.abs(near - palette.CONTACT_POINT).sum(axis=-1) < 30
    # A dot of radius 4.5 pixels, or a ring of the same.
    assert strong.sum() >= 12
    assert np.argwhere(strong).mean(axis=0) == pytest.approx([6.0, 6.0], abs=1.5)


def test_all_of_the_column_is_in_every_picture(painter, motion):
    width, height = LOOK.size
    around = painter.body.rims
    for rotation, centre, base in zip(frames(motion.rotation), motion.centre, motion.base, strict=True):
        pixels = painter.lens.pixels(around @ rotation.T + centre + base) / FINE
        assert pixels.min() > 0.0
        assert np.all(pixels.max(axis=0) < [width, height])


def test_the_mark_turns_with_the_column(motion):
    upright = replace(motion, tilt=0.0 * motion.tilt)
    first, turned = (
        np.asarray(Painter.of(one, one, LOOK).picture(0)).astype(int)
        for one in (upright, replace(upright, twist=motion.twist + 0.5 * math.pi))
    )

    def centre_of_mark(picture):
        found = np.argwhere((picture[..., 0] > 1.6 * picture[..., 2]) & (picture[..., 0] > 60))
        found = found[found[:, 0] < LOOK.size[1] - 92]
        return found.mean(axis=0)

    # From the side that faces the viewer to the right, anticlockwise from above.
    assert centre_of_mark(turned)[1] > centre_of_mark(first)[1] + 20


def test_the_same_instant_is_always_the_same_picture(painter):
    assert painter.picture(3).tobytes() == painter.picture(3).tobytes()
    assert painter.picture(3).tobytes() != painter.picture(4).tobytes()


def test_facets_close_the_shaft_and_the_mark_faces_the_viewer():
    body = Body.fluted(Shape(radius=0.5, top_radius=0.4, height=2.0, mass_height=1.0, slenderness=0.5), 100.0)
    np.testing.assert_allclose(np.hypot(*body.bottom[:, :2].T), 0.5)
    np.testing.assert_allclose(np.hypot(*body.top[:, :2].T), 0.4)
    np.testing.assert_allclose(np.linalg.norm(body.normals, axis=-1), 1.0)
    # Over a flute its hollows cancel: the mean normal is that of its middle.
    mean = body.normals[body.marked].mean(axis=0)
    assert math.atan2(mean[1], mean[0]) == pytest.approx(MARK)
    ends = np.append(body.marked, body.marked[0])
    corners = np.concatenate([body.bottom, body.bottom[:1]])[: ends.size][np.append(body.marked, False)]
    assert np.arctan2(*corners[:, 1::-1].T).min() < MARK < np.arctan2(*corners[:, 1::-1].T).max()


def test_a_slim_shaft_has_fewer_flutes_than_pixels():
    shape = Shape(radius=0.5, top_radius=0.5, height=20.0, mass_height=10.0, slenderness=0.05)
    assert [int(Body.fluted(shape, width).marked.sum()) for width in (10.0, 40.0, 90.0)] == [6, 6, 6]
    assert [len(Body.fluted(shape, width).bottom) // 6 for width in (10.0, 40.0, 90.0)] == [8, 12, 20]


def test_shadows_lie_on_their_plane_along_the_light():
    light, normal = light_for(0.3), np.array([0.1, 0.2, math.sqrt(0.95)])
    points = np.random.default_rng(2).normal(size=(7, 3))
    cast = shadow(points, light, normal, -2.0)
    np.testing.assert_allclose(cast @ normal, -2.0)
    np.testing.assert_allclose(np.cross(points - cast, light), 0.0, atol=1e-12)


def test_light_brightens_what_faces_it_and_never_beyond_white():
    light = light_for(0.0)
    grey = np.full((3, 3), 250.0)
    faces = lit(grey, np.stack([light, -light, np.array([0.0, 0.0, 1.0])]), light)[:, 0]
    assert faces[0] > faces[2] > faces[1] > 0.0
    assert faces.max() <= 255.0


def test_a_shadow_is_cut_at_the_edge_of_the_slab():
    low, high = np.array([-1.0, -1.0]), np.array([1.0, 1.0])
    square = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 0.5], [0.0, 0.5]])
    found = clipped(square, low, high)
    x, y = found.T
    area = 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
    assert area == pytest.approx(0.5)
    assert len(clipped(square + 5.0, low, high)) == 0
    np.testing.assert_array_equal(clipped(0.1 * square, low, high), 0.1 * square)


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
    lens = Lens(view=View(-0.5 * math.pi, 0.5 * math.pi), scale=1.0, origin=np.zeros(2))
    still = replace(motion, footprint=0.0 * motion.footprint, contact_point=motion.contact_point - motion.footprint)
    points = np.concatenate(Trace.of(still, np.eye(3), lens).points)
    np.testing.assert_allclose(np.hypot(*points.T), DISC.radius, rtol=1e-9)
    assert np.hypot(*np.diff(points, axis=0).T).max() < 0.11 * DISC.radius


def test_no_path_is_drawn_where_nothing_of_the_rim_touches(motion):
    resting = motion.resting.copy()
    resting[5:12] = True
    times = Trace.of(replace(motion, resting=resting), np.eye(3), Painter.of(motion, motion, LOOK).lens).times
    assert len(times) == 2
    assert times[0][-1] == motion.time[4]
    assert times[1][0] == motion.time[12]


@pytest.mark.parametrize("power", [-6, 0, 4])
def test_lengths_are_rounded_down_to_1_2_and_5(power):
    for given, known in ((1.0, 1.0), (1.9, 1.0), (2.1, 2.0), (4.99, 2.0), (5.5, 5.0), (9.9, 5.0)):
        assert round_length(given * 10.0**power) == pytest.approx(known * 10.0**power)


@pytest.mark.parametrize("elevation", [0.5, 20.0, 90.0])
def test_any_view_from_above_can_be_painted(motion, elevation):
    look = replace(LOOK, view=View(2.0, math.radians(elevation)))
    assert Painter.of(motion, motion, look).picture(0).size == LOOK.size


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
    told = {name: value for name, value in page.items() if name not in ON_THE_PAGE_ALONE}
    own = {name: getattr(palette, re.sub("([A-Z])", r"_\1", name).upper()) for name in told}
    assert own == {
        name: float(value) if "." in value else rgb(named.get(value, value.strip('"'))) for name, value in told.items()
    }


def test_the_footprint_of_a_column_that_stands_has_the_colour_of_what_touches(motion):
    upright = replace(motion, tilt=0.0 * motion.tilt)

    def blue(resting):
        one = replace(upright, resting=np.full_like(motion.resting, resting))
        painted = np.asarray(Painter.of(one, one, LOOK).picture(0)).astype(int)[: LOOK.size[1] - 92]
        return int((painted[..., 2] - painted[..., 0] > 60).sum())

    assert blue(True) > 20
    assert blue(False) == 0


@pytest.mark.parametrize("title", [None, "a title", "a title " * 30])
@pytest.mark.parametrize("width", [320, 640])
def test_no_text_runs_into_another_or_out_of_the_picture(motion, title, width, monkeypatch):
    boxes = []
    written = ImageDraw.ImageDraw.text

    def noted(draw, at, text, **options):
        boxes.append((text, draw.textbbox(at, text, font=options["font"], anchor=options.get("anchor"))))
        written(draw, at, text, **options)

    fallen = replace(motion, outcome=sb.Outcome.OVERTURNED)
    painter = Painter.of(fallen, fallen, replace(LOOK, size=(width, 300), title=title))
    monkeypatch.setattr(ImageDraw.ImageDraw, "text", noted)
    painter.picture(motion.time.size - 1)
    assert any(text == "cannot come back" for text, _ in boxes)
    for at, (_, (left, top, right, bottom)) in enumerate(boxes):
        assert left >= 0
        assert right <= width
        for _, other in boxes[:at]:
            assert right <= other[0] or other[2] <= left or bottom <= other[1] or other[3] <= top
