"""What users ask: response curves, starts on known motions, the source paper checked."""

from stylobate.studies.response_curves import response_curves
from stylobate.studies.starts import Start, steady_start

__all__ = ["Start", "response_curves", "steady_start"]
