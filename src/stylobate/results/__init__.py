"""Results: what a computation returns, saved and loaded with everything needed to repeat it."""

from stylobate.results.response import Event, Response
from stylobate.results.storage import load

__all__ = ["Event", "Response", "load"]
