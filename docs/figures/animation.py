"""Draws the animations of the pages into docs/_static/animation, and that of the front page, docs/_static/home.gif.

Run it with `python docs/figures/animation.py`, or with names such as `home coin`; it takes some minutes on one core.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib import font_manager
from PIL import Image, ImageDraw, ImageFont

import stylobate as sb
from stylobate.plots import body as palette
from stylobate.plots.animation.drawing import Drawing
from stylobate.plots.animation.formats import gif_of
from stylobate.plots.animation.motion import DrawnMotion
from stylobate.plots.style import VERMILION

STATIC = Path(__file__).parents[1] / "_static"
FOLDER = STATIC / "animation"
SHOWN = {"size": (520, 400), "frames_per_second": 15}


def temple() -> sb.plots.Animation:
    """A temple column shaken by the record of El Centro, made half as strong again."""
    column = sb.Column.frustum(radius=0.45, top_radius=0.36, height=4.6, density=2600.0)
    quake = 1.5 * sb.sample_record("el centro 1940")
    run = sb.simulate(sb.Wobbling(column, damping=0.03), quake)
    return sb.animate(run, speed=2.0, **SHOWN)


def rolling() -> sb.plots.Animation:
    """A slim column on a base that moves in a circle: steady rolling, and a slow turn the other way about its axis."""
    column = sb.Column.solid(radius=0.1, height=1.6, density=2700.0)
    circle = sb.Harmonic.circular(acceleration=0.9, angular_frequency=5.5)
    model = sb.Rolling(column, damping=0.1, spin_damping=0.1)
    start = sb.studies.steady_start(model, circle)
    run = sb.simulate(model, circle, **start, duration=11.01 * circle.period)
    return sb.animate(run, speed=1.5, **SHOWN)


def coin() -> sb.plots.Animation:
    """A disc let go on its rim wobbles faster the lower it comes."""
    disc = sb.Column.solid(radius=0.04, height=0.008, density=8000.0)
    run = sb.simulate(
        sb.Rolling(disc, rolling_resistance=0.02),
        tilt=(0.6, 0.0),
        tilt_rate=(0.0, 8.0),
        duration=2.7,
    )
    return sb.animate(run, speed=0.3, **SHOWN)


def part() -> sb.plots.Animation:
    """A part that was set down askew walks along a conveyor."""
    body = sb.Column.solid(radius=0.02, height=0.03, density=7800.0)
    oblique = sb.Harmonic.oblique(acceleration=14.0, angular_frequency=60.0, angle=0.52)
    model = sb.Sliding(body, friction_coefficient=0.3, normal_restitution=0.3)
    run = sb.simulate(model, oblique, tilt=(-0.5, 0.2), spin=8.0, duration=1.6)
    return sb.animate(run, speed=0.2, **SHOWN)


class Falling(sb.Wobbling):
    """The same equations without the criterion of no return: a run ends where the column lies."""

    __slots__ = ()
    no_return_tilt = None


# The front page: scales of the record, frames per second, seconds of the motion in one of the animation, its end [s].
SCALES, RATE, SPEED, END = (0.8, 2.0), 12.0, 2.5, 20.0
# Size of a picture, its part that is shown, its letters [pixels]: a telephone shows the sheet at half its size.
SIDE, SHOWN_PART, LETTERS = (400, 500), (20, 50, 380, 408), (32, 26)
# Rest before the record in the one without drift [s].
REST = 20.0


def without_drift(motion: DrawnMotion, scale: float) -> DrawnMotion:
    """Return a motion whose base is displaced by the record without its drift, which no column feels."""
    ground = sb.sample_record("el centro 1940 corrected").scaled(scale)
    start, moved = (
        ground.displacement(REST + time) for time in (np.zeros(1), motion.time)
    )
    return replace(motion, base=np.asarray(moved - start))


def home() -> bytes:
    """One column under two strengths of El Centro: under the weaker it stands, under the stronger it overturns."""
    stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
    model = Falling(stone, damping=stone.housner_damping())
    quake = sb.sample_record("el centro 1940")
    drawings, scale = [], None
    for strength in reversed(SCALES):
        run = sb.simulate(model, quake.scaled(strength))
        one = sb.animate(run, size=SIDE, frames_per_second=RATE, speed=SPEED)
        motion, history = (
            without_drift(each, strength) for each in (one.motion, one.history)
        )
        drawing = Drawing(motion, history, replace(one.look, scale=scale))
        scale = drawing.pixels_per_metre
        drawings.insert(0, drawing)
    fonts = [
        ImageFont.truetype(font_manager.findfont("DejaVu Sans"), size)
        for size in LETTERS
    ]
    left, top, right, bottom = SHOWN_PART
    width, height = right - left, bottom - top
    times = np.arange(0.0, END, SPEED / RATE)

    def picture(index: int) -> Image.Image:
        sheet = Image.new("RGB", (2 * width, height + 150), palette.BACKGROUND)
        write = ImageDraw.Draw(sheet)
        clock = f"{times[index]:.0f} s"
        write.text((width, 24), clock, palette.INK, fonts[0], anchor="mt")
        for place, (strength, one) in enumerate(zip(SCALES, drawings, strict=True)):
            motion, middle = one.motion, (place + 0.5) * width
            at = min(
                int(np.searchsorted(motion.time, times[index])), len(motion.time) - 1
            )
            sheet.paste(one.picture(at).crop(SHOWN_PART), (place * width, 60))
            tilt = float(np.hypot(*motion.tilt[at])) / stone.tipping_angle
            fallen = tilt > 1.0 and motion.outcome is sb.Outcome.OVERTURNED
            state = f"{tilt:.2f} of the tipping angle"
            if fallen or index == len(times) - 1:
                state = "overturns" if fallen else "stands"
            colour = VERMILION if fallen else palette.INK
            write.text(
                (middle, height + 70),
                f"El Centro × {strength:g}",
                palette.INK,
                fonts[0],
                anchor="mt",
            )
            write.text((middle, height + 112), state, colour, fonts[1], anchor="mt")
        return sheet

    return gif_of(picture, len(times), RATE)


DRAWINGS: tuple[Callable[[], sb.plots.Animation], ...] = (temple, rolling, coin, part)

if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    chosen = sys.argv[1:] or [
        home.__name__,
        *(drawing.__name__ for drawing in DRAWINGS),
    ]
    if home.__name__ in chosen:
        print("home", (STATIC / "home.gif").write_bytes(home()) / 1e6, "MB")
    for drawing in DRAWINGS:
        if drawing.__name__ not in chosen:
            continue
        drawn = drawing()
        path = drawn.save(FOLDER / f"{drawing.__name__}.gif")
        tilt = np.hypot(*drawn.motion.tilt.T).max() / drawn.motion.shape.slenderness
        print(f"{drawn!r}, up to {tilt:.2f} c, {path.stat().st_size / 1e6:.2f} MB")
