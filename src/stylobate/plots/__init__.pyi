from .animation.animation import Animation, animate
from .animation.motion import drawn_motion
from .column_figures import plot_column_path
from .figure import plot
from .interactive import plot_interactive
from .kinds import figure_of

__all__ = [
    "Animation",
    "animate",
    "drawn_motion",
    "figure_of",
    "plot",
    "plot_column_path",
    "plot_interactive",
]
