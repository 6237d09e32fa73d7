from .animation import Animation, animate
from .motion import DrawnMotion, drawn_motion

__all__ = ["Animation", "DrawnMotion", "animate", "drawn_motion"]
