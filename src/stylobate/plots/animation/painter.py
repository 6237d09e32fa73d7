"""Draws a column on its shaking base, an instant at a time."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from PIL import Image, ImageDraw

from stylobate.plots.animation import captions, palette
from stylobate.plots.animation.body import COARSE, Body
from stylobate.plots.animation.canvas import FINE, circle, disc, line, polygon
from stylobate.plots.animation.ground import backdrop, slab_lines
from stylobate.plots.animation.lens import Lens
from stylobate.plots.animation.motion import DrawnMotion
from stylobate.plots.animation.plan import SIDE, Plan
from stylobate.plots.animation.scene import Scene
from stylobate.plots.animation.shading import clipped, light_for, lit, shadow
from stylobate.plots.animation.strip import Strip
from stylobate.plots.animation.trace import Trace
from stylobate.plots.axonometry import View, hull
from stylobate.plots.pose import Floats, frames

# Room about the scene [pixels as shown]: at the sides, above for a line of text, below for the history of the tilt.
_EDGE, _ABOVE, _BELOW = 22, 46, 92
# Of the history of the tilt: from the sides, from the lower edge, and its height.
_INDENT, _FLOOR, _BAND = 58, 16, 34
# A base seen narrower than this is shown from above as well, where the picture is wide enough for both.
_NARROW, _WIDE = 110.0, 420
# Of one that wanders farther than this [base radii] the path is seen as it is.
_WANDERS = 3.0
_DOT = 4.5 * FINE
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """How a motion is looked at.

    Parameters
    ----------
    size
        Width and height of the picture [pixels].
    view
        Where one looks from.
    title
        A line above the picture.
    pace
        Seconds of the motion in a second of the picture.
    """

    size: tuple[int, int]
    view: View
    title: str | None = None
    pace: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Painter:
    """All that the pictures of one motion share."""

    motion: DrawnMotion
    look: Look
    scene: Scene
    lens: Lens
    body: Body
    light: Floats
    trace: Trace
    strip: Strip
    plan: Plan | None
    behind: Image.Image

    @classmethod
    def of(cls, motion: DrawnMotion, history: DrawnMotion, look: Look) -> Self:
        """Return what draws the instants of `motion`; paths and curves are those of `history`, sampled finer."""
        scene, (width, height) = Scene.of(motion), look.size
        everything = scene.everything(motion)
        right = width - _EDGE
        lens = _fitted(look, everything, right)
        plan = None
        wanders = float(np.ptp(motion.footprint, axis=0).max()) > _WANDERS * motion.shape.radius
        if 2.0 * motion.shape.radius * lens.scale / FINE < _NARROW and width >= _WIDE and not wanders:
            plan = Plan.of(history, look.view.azimuth, (right, _ABOVE))
            lens = _fitted(look, everything, right - SIDE)
        low, high = (_INDENT, height - _FLOOR - _BAND), (width - _INDENT, height - _FLOOR)
        strip = Strip.of(history, (FINE * low[0], FINE * low[1]), (FINE * high[0], FINE * high[1]))
        behind = backdrop(look.size, scene, lens, _ABOVE, _BELOW)
        for part in (strip, plan):
            if part is not None:
                part.draw_behind(ImageDraw.Draw(behind))
        return cls(
            motion=motion,
            look=look,
            scene=scene,
            lens=lens,
            body=Body.fluted(motion.shape, 2.0 * motion.shape.radius * lens.scale / FINE),
            light=light_for(look.view.azimuth),
            trace=Trace.of(history, scene.turned, lens),
            strip=strip,
            plan=plan,
            behind=behind,
        )

    def picture(self, index: int) -> Image.Image:
        """Return the picture of one instant, in RGB."""
        fine = self.behind.copy()
        draw = ImageDraw.Draw(fine, "RGBA")
        motion, turned = self.motion, self.scene.turned
        base = turned @ motion.base[index]
        frame = turned @ frames(motion.rotation[index])
        centre = base + turned @ motion.centre[index]
        self._draw_slab(draw, base, self.body.rims @ frame.T + centre)
        self._draw_on_slab(draw, index, base)
        self._draw_column(draw, frame, centre)
        self._draw_contact(draw, index, base, frame)
        self.strip.draw(draw, float(motion.time[index]))
        if self.plan is not None:
            self.plan.draw(draw, motion, index)
        shown = fine.reduce(FINE)
        self._write(ImageDraw.Draw(shown), index)
        return shown

    def _draw_slab(self, draw: ImageDraw.ImageDraw, base: Floats, rims: Floats) -> None:
        """Draw the slab with its lines, the shadows on the ground, and the column's shadow on it."""
        scene, lens = self.scene, self.lens
        upper, lower = (scene.slab(height) @ scene.turned.T + base for height in (0.0, -scene.thickness))
        for solid in (np.concatenate([upper, lower]), rims):
            cast = shadow(solid, self.light, _UP, scene.ground)
            polygon(draw, hull(lens.pixels(cast)), palette.GROUND_SHADE)
        for first in range(4):
            second = (first + 1) % 4
            outward = np.cross(upper[second] - upper[first], scene.normal)
            if outward @ lens.eye > 0.0:
                side = np.stack([upper[first], upper[second], lower[second], lower[first]])
                polygon(draw, lens.pixels(side), palette.SLAB_LIT if outward @ self.light > 0.0 else palette.SLAB_SIDE)
        top = lens.pixels(upper)
        polygon(draw, top, palette.SLAB)
        for ends in lens.pixels(slab_lines(scene) @ scene.turned.T + base):
            line(draw, ends, palette.SLAB_LINE, FINE)
        line(draw, np.concatenate([top, top[:1]]), palette.SLAB_SIDE, FINE)
        cast = (shadow(rims - base, self.light, scene.normal, 0.0) @ scene.turned)[:, :2]
        polygon(draw, self._seen(clipped(hull(cast), scene.low, scene.high), base), palette.SHADE)

    def _draw_on_slab(self, draw: ImageDraw.ImageDraw, index: int, base: Floats) -> None:
        """Draw the footprint circle and the path of the contact point."""
        footprint = circle(self.motion.footprint[index], self.motion.shape.radius)
        colour = palette.CONTACT if self.motion.resting[index] else palette.FOOTPRINT
        line(draw, self._seen(footprint, base), colour, FINE)
        self.trace.draw(draw, float(self.motion.time[index]), self.lens.shift(base))

    def _draw_column(self, draw: ImageDraw.ImageDraw, frame: Floats, centre: Floats) -> None:
        body, lens = self.body, self.lens
        bottom, top = (lens.pixels(rim @ frame.T + centre) for rim in (body.bottom, body.top))
        next_bottom, next_top = np.roll(bottom, -1, axis=0), np.roll(top, -1, axis=0)
        facets = np.concatenate([bottom, next_bottom, next_top, top], axis=1)
        # Facets that are seen run anticlockwise in space, and pixels are counted downwards.
        seen = _cross(next_bottom - bottom, top - bottom) < 0.0
        stone = np.where(body.marked[:, None], palette.MARK, palette.STONE).astype(float)
        colours = lit(stone, body.normals @ frame.T, self.light).astype(int)
        for facet, colour in zip(facets[seen].tolist(), colours[seen].tolist(), strict=True):
            draw.polygon(facet, fill=tuple(colour))
        for rim, outward in ((bottom, -frame[:, 2]), (top, frame[:, 2])):
            if outward @ lens.eye > 0.0:
                self._draw_face(draw, rim, outward)

    def _draw_face(self, draw: ImageDraw.ImageDraw, rim: Floats, outward: Floats) -> None:
        """Draw the top or the base, with a wedge from its centre to the marked flute."""
        faces = lit(np.array([palette.STONE, palette.MARK], dtype=float), np.stack([outward, outward]), self.light)
        stone, mark = (tuple(face) for face in faces.astype(int).tolist())
        polygon(draw, rim, stone)
        flute = rim[: int(self.body.marked.sum()) + 1]
        polygon(draw, np.concatenate([rim.mean(axis=0)[None], flute]), mark)
        edge = rim[::COARSE]
        line(draw, np.concatenate([edge, edge[:1]]), palette.SLAB_SIDE, FINE)

    def _draw_contact(self, draw: ImageDraw.ImageDraw, index: int, base: Floats, frame: Floats) -> None:
        """Draw the contact point, if there is one: as a ring where the column stands before it."""
        if not self.motion.on_rim[index]:
            return
        rim = self.motion.contact_point[index] - self.motion.footprint[index]
        lean = self.scene.turned @ np.append(rim, 0.0)
        axis = frame[:, 2]
        # Normal of the shaft there. One looks through the body where both faces that meet in the point face away.
        outward = lean - (lean @ axis) * axis
        hidden = axis @ self.lens.eye > 0.0 > outward @ self.lens.eye
        at = self._seen(self.motion.contact_point[index][None], base)[0]
        if hidden:
            disc(draw, at, _DOT, None, palette.CONTACT_POINT)
        else:
            disc(draw, at, _DOT, palette.CONTACT_POINT, palette.BACKGROUND)

    def _seen(self, points: Floats, base: Floats) -> Floats:
        """Return the pixels of points on the slab, given in its plane, shape (n, 2), or in its frame, shape (n, 3)."""
        flat = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
        return self.lens.pixels(flat @ self.scene.turned.T + base)

    def _write(self, draw: ImageDraw.ImageDraw, index: int) -> None:
        look, (width, height) = self.look, self.look.size
        ends = (_EDGE, width - _EDGE)
        captions.write_lines(draw, self.motion, index, ends, pace=look.pace, title=look.title)
        captions.write_scales(draw, self.lens, self.scene.grid, ends, height - _BELOW + 20)
        for part in (self.strip, self.plan):
            if part is not None:
                part.write(draw)


def _fitted(look: Look, everything: Floats, right: float) -> Lens:
    """Return the lens that shows everything to the left of `right` [pixels as shown]."""
    low, high = (_EDGE, _ABOVE), (right, look.size[1] - _BELOW)
    return Lens.fitting(look.view, everything, (FINE * low[0], FINE * low[1]), (FINE * high[0], FINE * high[1]))


def _cross(first: Floats, second: Floats) -> Floats:
    return np.asarray(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
