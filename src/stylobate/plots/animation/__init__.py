"""Pictures that move: the motion of a column as numbers, as GIF, as MP4, and as a page of its own."""

from stylobate.plots.animation.animation import Animation, animate
from stylobate.plots.animation.motion import DrawnMotion, drawn_motion

__all__ = ["Animation", "DrawnMotion", "animate", "drawn_motion"]
