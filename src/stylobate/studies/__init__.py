"""What users ask: response curves, starts on known motions, the source paper checked."""

from stylobate.studies.averaged_motion import averaged_motion
from stylobate.studies.paper import check_paper
from stylobate.studies.response_curves import response_curves
from stylobate.studies.starts import Start, steady_start

__all__ = ["Start", "averaged_motion", "check_paper", "response_curves", "steady_start"]
