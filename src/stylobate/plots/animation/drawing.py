"""Frames of an animation: a column on its shaking base, drawn by Matplotlib one instant at a time."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self, TypeVar

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.text import Text
from matplotlib.transforms import IdentityTransform
from PIL import Image

from stylobate.errors import Outcome
from stylobate.plots import body
from stylobate.plots.animation.motion import DrawnMotion, contact_path
from stylobate.plots.body import MARKED, ColumnArtists, FlutedColumn, light_for, ring
from stylobate.plots.geometry import Floats, View, frames, hull, quaternions
from stylobate.plots.style import BLUE, VERMILION

# Half the minimum width of the slab: in base radii, and in heights of the column.
_LEAST, _OF_HEIGHT = 2.3, 0.16
# Margin of the slab about the path [base radii], its thickness in half widths, number of lines across it.
_MARGIN, _THICKNESS, _LINES = 1.7, 0.09, 8
# Number of poses that set the extent of the frames.
_SEEN = 240


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A slab on the ground, and the plane on it in which positions of a motion are given.

    Attributes
    ----------
    turned
        Rotation matrix from the frame of the inclined plane to the frame of gravity, shape (3, 3).
    low, high
        Corners of the slab in its plane, shape (2,) [m].
    thickness, ground
        Thickness of the slab, and height of the ground [m].
    grid
        Distance between lines on the slab and marks on the ground [m].
    """

    turned: Floats
    low: Floats
    high: Floats
    thickness: float
    ground: float
    grid: float

    @classmethod
    def of(cls, motion: DrawnMotion) -> Self:
        """Return the scene that contains all of a motion."""
        shape = motion.shape
        least, most = motion.footprint.min(axis=0), motion.footprint.max(axis=0)
        middle, reach = 0.5 * (least + most), 0.5 * float(np.max(most - least))
        half = max(reach + _MARGIN * shape.radius, _LEAST * shape.radius, _OF_HEIGHT * shape.height)
        lean = motion.incline * np.array([math.cos(motion.incline_direction), math.sin(motion.incline_direction)])
        turned = frames(quaternions(lean, 0.0))
        thickness = _THICKNESS * half
        corners = _corners(middle - half, middle + half, -thickness) @ turned.T
        lowest = corners[:, 2].min() + (motion.base @ turned.T)[:, 2].min()
        return cls(
            turned=turned,
            low=middle - half,
            high=middle + half,
            thickness=thickness,
            ground=float(lowest),
            grid=round_length(2.0 * half / _LINES),
        )

    def slab(self, height: float) -> Floats:
        """Return the corners of the slab at a `height` above its upper face, anticlockwise, in its own frame."""
        return _corners(self.low, self.high, height)

    def lines(self) -> Floats:
        """Return the ends of the lines on the slab, in its own frame, shape (n, 2, 3)."""
        found = []
        for along in (0, 1):
            first, last = math.ceil(self.low[along] / self.grid), math.floor(self.high[along] / self.grid)
            for number in range(first, last + 1):
                ends = np.zeros((2, 3))
                ends[:, along] = number * self.grid
                ends[:, 1 - along] = self.low[1 - along], self.high[1 - along]
                found.append(ends)
        return np.stack(found)

    @property
    def normal(self) -> Floats:
        """Unit vector upwards from the plane, in the frame of gravity."""
        return self.turned[:, 2]

    def everything(self, motion: DrawnMotion) -> Floats:
        """Return points whose hull contains slab and column at all times, shape (n, 3)."""
        shape, chosen = motion.shape, _spread(motion.time.size)
        poses, base = frames(motion.rotation[chosen]), motion.base[chosen]
        around = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        rings = [
            np.stack([radius * np.cos(around), radius * np.sin(around), np.full(around.size, height)], axis=-1)
            for height, radius in shape.corners
        ]
        columns = np.concatenate(rings) @ np.swapaxes(poses, -1, -2) + (base + motion.centre[chosen])[:, None]
        slabs = np.concatenate([self.slab(0.0), self.slab(-self.thickness)]) + base[:, None]
        return np.concatenate([columns.reshape(-1, 3), slabs.reshape(-1, 3)]) @ self.turned.T


def round_length(length: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is no longer than `length`.

    >>> round_length(0.34), round_length(7.0)
    (0.2, 5.0)
    """
    power = 10.0 ** math.floor(math.log10(length))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= length)


def _spread(count: int) -> npt.NDArray[np.intp]:
    return np.unique(np.linspace(0, count - 1, min(count, _SEEN)).round().astype(int))


def _corners(low: Floats, high: Floats, height: float) -> Floats:
    return np.array(
        [[low[0], low[1], height], [high[0], low[1], height], [high[0], high[1], height], [low[0], high[1], height]]
    )


_DPI = 100
# Room about the scene [pixels]: at the sides, above for two lines of text, below for the history of the tilt.
_EDGE, _ABOVE, _BELOW = 22, 46, 92
# The history of the tilt: distance from the sides and from the lower edge, and height [pixels].
_INDENT, _FLOOR, _BAND = 58, 16, 34
# A base narrower than this is shown from above as well, in a square of this side, if the picture is as wide as this.
_NARROW, _SIDE, _WIDE = 110.0, 132, 420
# If the footprint wanders farther than this, there is no such square [base radii].
_WANDERS = 3.0
# The latest part of the path is drawn bold: this fraction of the motion.
_LATEST = 0.08
# Minimum distance between marks on the ground [pixels]; the marks fade over this fraction of the scene's height.
_MARKS_APART, _FADE = 34.0, 0.45
# The tilt of unstable balance is drawn if the tilt comes to this fraction of it.
_NEAR = 0.4
_LARGE, _SMALL = 9.0, 8.0
_FALLS = (Outcome.OVERTURNED,)
_ROUNDING = 1e-9
_AROUND = np.linspace(0.0, 2.0 * np.pi, 73)

_A = TypeVar("_A", bound=Artist)


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """Size, view and title of the pictures of a motion.

    Parameters
    ----------
    size
        Width and height of the picture [pixels].
    view
        Direction of view.
    title
        A line above the picture.
    pace
        Seconds of the motion in a second of the animation.
    scale
        Pixels per metre, for pictures that stand side by side; by default the motion fills the picture.
    """

    size: tuple[int, int]
    view: View
    title: str | None = None
    pace: float = 1.0
    scale: float | None = None


class Drawing:
    """The figure of a motion: static parts are drawn once, moving parts again for each instant.

    Parameters
    ----------
    motion
        The motion sampled at the frames.
    history
        The same motion with finer samples, for paths and curves.
    look
        Size, view, title.
    """

    def __init__(self, motion: DrawnMotion, history: DrawnMotion, look: Look) -> None:
        self.motion, self.look = motion, look
        self.scene = Scene.of(motion)
        self._times, self._path = contact_path(history)
        self._light, self._eye = light_for(look.view), look.view.eye
        inches = (look.size[0] / _DPI, look.size[1] / _DPI)
        self._figure = Figure(figsize=inches, dpi=_DPI, facecolor=body.BACKGROUND)
        canvas: Any = FigureCanvasAgg  # its methods have no types
        self._canvas = canvas(self._figure)
        self._moving: list[Artist] = []
        self.space, self.plan = self._add_views()
        self._add_ground()
        self._add_artists()
        self._add_tilt_history(history)
        self._add_texts()
        self._canvas.draw()
        self._behind = self._canvas.copy_from_bbox(self._figure.bbox)

    def picture(self, index: int) -> Image.Image:
        """Return the picture of one instant, in RGB."""
        base = self.scene.turned @ self.motion.base[index]
        frame = self.scene.turned @ frames(self.motion.rotation[index])
        centre = base + self.scene.turned @ self.motion.centre[index]
        self._place_slab(base, frame, centre)
        self._drawn_column.place(frame, centre)
        self._place_contact(index, base, frame)
        self._place_time(index)
        self._canvas.restore_region(self._behind)
        for artist in self._moving:
            self._figure.draw_artist(artist)
        return Image.frombuffer("RGBA", self.look.size, self._canvas.buffer_rgba()).convert("RGB")

    @property
    def column(self) -> FlutedColumn:
        """Facets of the column in its own frame."""
        return self._drawn_column.body

    def pixels(self, points: Floats) -> Floats:
        """Return the pixels, shape (…, 2) from the upper left corner, of points of shape (…, 3)."""
        across = self.space.transData.transform(self.look.view.project(points).reshape(-1, 2))
        return np.asarray(np.array([0.0, self.look.size[1]]) + across * [1.0, -1.0]).reshape(*points.shape[:-1], 2)

    # Axes and static parts.

    def _axes(self, left: float, bottom: float, right: float, top: float) -> Axes:
        """Add axes without frame between two corners [pixels from the lower left]."""
        width, height = self.look.size
        axes = self._figure.add_axes((left / width, bottom / height, (right - left) / width, (top - bottom) / height))
        axes.set_axis_off()
        axes.set_autoscale_on(False)
        return axes

    def _add_views(self) -> tuple[Axes, Axes | None]:
        """Add the axes of the scene and, for a base too narrow to show its contact point, a view from above."""
        motion, (width, height) = self.motion, self.look.size
        points = self.look.view.project(self.scene.everything(motion))
        low, high = points.min(axis=0), points.max(axis=0)
        right, top = width - _EDGE, height - _ABOVE
        scale = min((right - _EDGE) / (high - low)[0], (top - _BELOW) / (high - low)[1])
        wanders = float(np.ptp(motion.footprint, axis=0).max()) > _WANDERS * motion.shape.radius
        narrow = 2.0 * motion.shape.radius * scale < _NARROW and width >= _WIDE and not wanders
        room = np.array([(right - _SIDE if narrow else right) - _EDGE, top - _BELOW])
        space = self._axes(_EDGE, _BELOW, _EDGE + room[0], top)
        half, middle = 0.5 * room * float(np.max((high - low) / room)), 0.5 * (low + high)
        if self.look.scale is not None:
            half = 0.5 * room / self.look.scale
            middle[1] = low[1] + half[1]
        space.set(xlim=(middle[0] - half[0], middle[0] + half[0]), ylim=(middle[1] - half[1], middle[1] + half[1]))
        return space, self._axes(right - _SIDE, top - _SIDE, right, top) if narrow else None

    def _add_ground(self) -> None:
        """Draw marks on the ground, over which the slab moves, and the square of the view from above."""
        (left, right), (low, high) = self.space.get_xlim(), self.space.get_ylim()
        step = 2.0 * round_length(_MARKS_APART / self.pixels_per_metre)
        reach = math.hypot(right - left, (high - low) / math.sin(max(self.look.view.elevation, math.radians(10.0))))
        one = step * np.arange(-math.ceil(reach / step), math.ceil(reach / step) + 1)
        marks = np.stack(np.broadcast_arrays(one[:, None], one, self.scene.ground), axis=-1).reshape(-1, 3)
        x, y = self.look.view.project(marks).T
        middle = float(self.look.view.project(np.array([0.0, 0.0, self.scene.ground]))[1])
        strength = np.clip(1.0 - (y - middle) / (_FADE * (high - low)), 0.0, 1.0)
        self.space.scatter(x, y, s=16.0, c=body.GROUND_LINE, marker="+", linewidths=0.9, alpha=strength, zorder=0)
        if self.plan is not None:
            self.plan.axis("on")
            self.plan.set(facecolor=body.SLAB, xticks=[], yticks=[])
            self.plan.set_title("from above", y=-0.14, loc="center", size=_SMALL, color=body.PALE)
            reach = 1.25 * self.motion.shape.radius
            ends = self._from_above(np.stack([self.motion.footprint.min(axis=0), self.motion.footprint.max(axis=0)]))
            middle, half = ends.mean(axis=0), 0.5 * float(np.abs(np.diff(ends, axis=0)).max()) + reach
            self.plan.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))

    @property
    def pixels_per_metre(self) -> float:
        """Scale of the scene."""
        (left, right) = self.space.get_xlim()
        return float(self.space.bbox.width / (right - left))

    def _add_tilt_history(self, history: DrawnMotion) -> None:
        """Draw all of |tilt|/c against time below the scene in a pale colour; the moving curve covers it."""
        self._history = history.time, np.hypot(*history.tilt.T) / history.shape.slenderness
        time, size = self._history
        highest = float(size.max())
        strip = self._axes(_INDENT, _FLOOR, self.look.size[0] - _INDENT, _FLOOR + _BAND)
        near = highest >= _NEAR
        strip.set(xlim=(0.0, time[-1]), ylim=(0.0, max(highest, 1.0) if near else highest or 1.0))
        strip.axhline(0.0, color=body.GROUND_LINE, linewidth=1.0)
        strip.plot(time, size, color=body.GROUND_LINE, linewidth=1.0)
        if near:
            strip.axhline(1.0, color=body.PALE, linewidth=0.8, linestyle="--")
        level, label = (1.0, "c") if near else (highest, f"{highest:.2g} c")
        text: dict[str, Any] = {"size": _SMALL, "color": body.PALE, "va": "center"}
        strip.text(1.01, level, label, transform=strip.get_yaxis_transform(), **text)
        if not near or highest < 2.0:  # noqa: PLR2004  else the names of the two lines would touch
            strip.text(1.01, 0.0, "0", transform=strip.get_yaxis_transform(), **text)
        strip.text(-0.01, 0.5, "tilt", transform=strip.transAxes, ha="right", **text)
        self._progress = self._animated(strip.plot([], [], color=BLUE, linewidth=2.0)[0])
        self._now = self._animated(strip.plot([], [], "o", color=BLUE, markersize=5, clip_on=False)[0])

    def _add_texts(self) -> None:
        """Write the title, the scale and the grid; each frame writes time, tilt and outcome again."""
        width, height = self.look.size
        self._state = self._animated(self._text(_EDGE, height - 20, "", body.INK, size=_LARGE))
        self._verdict = self._animated(self._text(width - _EDGE, height - 20, "", body.INK, ha="right", size=_LARGE))
        self._verdict.set_fontweight("bold")
        if self.look.title:
            self._fit(self._text(_EDGE, height - 38, self.look.title, body.PALE), width - 2 * _EDGE)
        scale = self.pixels_per_metre
        length = round_length(0.2 * (width - 2 * _EDGE) / scale)
        left, right, floor = width - _EDGE - length * scale, width - _EDGE, _BELOW - 20
        bar = Line2D([left, right], [floor, floor], transform=None, color=body.INK, linewidth=1.5, marker="|")
        self._figure.add_artist(bar)
        self._text(0.5 * (left + right), floor + 5, _metres(length), body.INK, ha="center", va="bottom")
        self._text(_EDGE, floor - 4, f"grid {_metres(self.scene.grid)}", body.PALE)

    def _text(self, x: float, y: float, text: str, colour: str, **options: Any) -> Text:
        """Write a text at a position [pixels from the lower left]."""
        place: dict[str, Any] = {
            "va": "baseline",
            "size": _SMALL,
            "color": colour,
            "transform": IdentityTransform(),
        } | options
        return self._figure.text(x, y, text, **place)

    def _fit(self, text: Text, room: float) -> None:
        """Shorten a text to the width `room` [pixels]."""
        whole = text.get_text()
        for kept in range(len(whole), 0, -1):
            if text.get_window_extent(self._canvas.get_renderer()).width <= room:
                return
            text.set_text(f"{whole[: kept - 1].rstrip()}…")

    # Moving parts.

    def _animated(self, artist: _A) -> _A:
        artist.set_animated(True)
        self._moving.append(artist)
        return artist

    def _add_artists(self) -> None:
        """Add the artists of slab, column and contact in the order in which they cover each other."""
        add, space = self._animated, self.space

        def patch(colour: Any, **options: Any) -> Polygon:
            polygon = Polygon(np.zeros((3, 2)), facecolor=colour, **{"linewidth": 0.0} | options)
            space.add_patch(polygon)
            return add(polygon)

        def line(axes: Axes, colour: str, width: float) -> Line2D:
            return add(axes.plot([], [], color=colour, linewidth=width, solid_capstyle="round")[0])

        self._sides = add(space.add_collection(PolyCollection([], linewidths=0.0), autolim=False))
        self._top = patch(body.SLAB, edgecolor=body.SLAB_SIDE, linewidth=0.8)
        self._lines = add(
            space.add_collection(LineCollection([], colors=body.SLAB_LINE, linewidths=0.7), autolim=False)
        )
        self._shade = patch(body.SHADOW, alpha=body.SHADOW_STRENGTH)
        self._shade.set_clip_path(self._top)
        self._views = []
        for axes, project in self._projections():
            footprint = line(axes, body.FOOTPRINT, 1.0)
            self._views.append(
                (axes, project, footprint, line(axes, body.CONTACT_OLD, 1.0), line(axes, body.CONTACT, 2.0))
            )
        self._drawn_column = ColumnArtists(space, self.motion.shape, self.look.view)
        for one in self._drawn_column.artists:
            add(one)
        dot: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 6.0}
        self._dots = [add(axes.plot([], [], **dot)[0]) for axes, *_ in self._views]
        if self.plan is not None:
            self._mark = line(self.plan, body.MARK, 2.5)

    def _projections(self) -> list[tuple[Axes, Callable[[Floats, Floats], Floats]]]:
        """Return, for each view, the projection of points in the displaced plane of the base."""
        return [(self.space, self._on_slab), *([] if self.plan is None else [(self.plan, self._from_above)])]

    def _on_slab(self, points: Floats, base: Floats) -> Floats:
        """Project points of the plane, shape (n, 2), with the base displaced."""
        return self.look.view.project(np.pad(points, ((0, 0), (0, 1))) @ self.scene.turned.T + base)

    def _from_above(self, points: Floats, base: Floats | None = None) -> Floats:
        """Project points of the plane, shape (n, 2), seen from above in the frame of the base."""
        del base
        return View(self.look.view.azimuth, 0.5 * math.pi).project(np.pad(points, ((0, 0), (0, 1))))

    def _place_slab(self, base: Floats, frame: Floats, centre: Floats) -> None:
        scene, project = self.scene, self.look.view.project
        upper, lower = (scene.slab(height) @ scene.turned.T + base for height in (0.0, -scene.thickness))
        sides, colours = [], []
        for first, second in ((0, 1), (1, 2), (2, 3), (3, 0)):
            outward = np.cross(upper[second] - upper[first], scene.normal)
            if outward @ self._eye > 0.0:
                sides.append(project(np.stack([upper[first], upper[second], lower[second], lower[first]])))
                colours.append(body.SLAB_LIT if outward @ self._light > 0.0 else body.SLAB_SIDE)
        self._sides.set(verts=sides, facecolor=colours)
        self._top.set_xy(project(upper))
        self._lines.set(segments=list(project(scene.lines() @ scene.turned.T + base)))
        rims = np.concatenate(self.column.rings) @ frame.T + centre
        height = (rims - base) @ scene.normal
        cast = rims - (height / (self._light @ scene.normal))[:, None] * self._light
        self._shade.set_xy(hull(project(cast)))

    def _place_contact(self, index: int, base: Floats, frame: Floats) -> None:
        """Place the footprint, the path and the contact point; the point is a ring if the column hides it."""
        motion, time = self.motion, float(self.motion.time[index])
        around = ring(_AROUND, motion.shape.radius, 0.0)[:, :2] + motion.footprint[index]
        last = int(np.searchsorted(self._times, time, side="right"))
        recent = int(np.searchsorted(self._times, time - _LATEST * float(motion.time[-1]), side="right"))
        for (_, project, footprint, old, new), dot in zip(self._views, self._dots, strict=True):
            footprint.set_data(*project(around, base).T)
            footprint.set_color(body.CONTACT if motion.resting[index] else body.FOOTPRINT)
            old.set_data(*project(self._path[:last], base).T)
            new.set_data(*project(self._path[recent:last], base).T)
            dot.set_data(*project(motion.contact_point[index][None], base).T)
            dot.set_visible(bool(motion.on_rim[index]))
            dot.set(markerfacecolor=body.CONTACT_POINT, markeredgecolor=body.BACKGROUND)
        lean = self.scene.turned @ np.append(motion.contact_point[index] - motion.footprint[index], 0.0)
        outward = lean - (lean @ frame[:, 2]) * frame[:, 2]
        if frame[:, 2] @ self._eye > 0.0 > outward @ self._eye:  # shaft and base face away from the viewer
            self._dots[0].set(markerfacecolor="none", markeredgecolor=body.CONTACT_POINT)
        if self.plan is not None:
            turn = motion.twist[index] + MARKED
            radius = motion.shape.radius * np.array([[math.cos(turn), math.sin(turn)]])
            self._mark.set_data(*self._from_above(motion.footprint[index] + np.array([[0.55], [1.0]]) * radius).T)

    def _place_time(self, index: int) -> None:
        """Mark the instant in the history of the tilt, and write time, tilt and, at the end, the outcome."""
        motion, (time, size) = self.motion, self._history
        now, tilt = float(motion.time[index]), math.hypot(*motion.tilt[index])
        last = int(np.searchsorted(time, now, side="right"))
        height = float(np.interp(now, time, size))
        self._progress.set_data(np.append(time[:last], now), np.append(size[:last], height))
        self._now.set_data([now], [height])
        # Three digits of the time at the end, but at least whole seconds.
        digits = max(0, 2 - math.floor(math.log10(motion.time[-1])))
        over = tilt / motion.shape.slenderness
        self._state.set_text(f"{now:.{digits}f} s    tilt {over:.2f} c    {math.degrees(tilt):.1f}°")
        at_end = index == motion.time.size - 1
        pace = "" if math.isclose(self.look.pace, 1.0) else f"speed × {self.look.pace:.3g}"
        self._verdict.set_text(motion.outcome.label if at_end else pace)
        self._verdict.set_color(VERMILION if at_end and motion.outcome in _FALLS else body.INK)
        self._verdict.set_fontweight("bold" if at_end else "normal")
        self._place_verdict()

    def _place_verdict(self) -> None:
        """Put the outcome beside time and tilt if there is room for it, else at the lower edge."""
        renderer = self._canvas.get_renderer()
        needed = sum(one.get_window_extent(renderer).width for one in (self._state, self._verdict))
        beside = needed + _EDGE <= self.look.size[0] - 2 * _EDGE
        self._verdict.set_y(self.look.size[1] - 20 if beside else _BELOW + 2)


def _metres(length: float) -> str:
    """Return a length in mm, cm, m or km with few digits.

    >>> _metres(0.02), _metres(0.5), _metres(0.002)
    ('2 cm', '0.5 m', '2 mm')
    """
    units = ((0.1, 1.0, "m"), (0.01, 100.0, "cm"), (0.0, 1000.0, "mm"))
    factor, unit = next((factor, unit) for least, factor, unit in units if length * (1.0 + _ROUNDING) >= least)
    return f"{factor * length:g} {unit}"
