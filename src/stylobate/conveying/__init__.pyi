from .feeder import sheet, sheet_rows
from .figures.slipping_boundary import plot_slipping_boundary
from .motion_onset import start_boundary
from .posture import Posture, upright
from .slip_limits import RollingRegime, slipping_boundary
from .transport import Transport, drift

__all__ = [
    "Posture",
    "RollingRegime",
    "Transport",
    "drift",
    "plot_slipping_boundary",
    "sheet",
    "sheet_rows",
    "slipping_boundary",
    "start_boundary",
    "upright",
]
