from .animation import Animation, animate
from .column_figures import plot_column_path
from .figure import plot
from .interactive import plot_interactive
from .kinds import figure_of
from .result_figure import ResultFigure, drawing

__all__ = [
    "Animation",
    "ResultFigure",
    "animate",
    "drawing",
    "figure_of",
    "plot",
    "plot_column_path",
    "plot_interactive",
]
