from .animation import Animation, animate
from .column_path import plot_column_path
from .figure import plot
from .kinds import figure_of

__all__ = [
    "Animation",
    "animate",
    "figure_of",
    "plot",
    "plot_column_path",
]
