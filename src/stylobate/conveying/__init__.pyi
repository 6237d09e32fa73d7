from .feeder import sheet, sheet_rows
from .motion_onset import start_boundary
from .posture import Posture, upright
from .slip_limits import slipping_boundary
from .transport import Transport, drift

__all__ = [
    "Posture",
    "Transport",
    "drift",
    "sheet",
    "sheet_rows",
    "slipping_boundary",
    "start_boundary",
    "upright",
]
