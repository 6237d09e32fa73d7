"""Loss of Arias intensity when the components of an event are trimmed to one length."""

import warnings
from collections.abc import Sequence

from stylobate.base_motions.records.knots import energy
from stylobate.base_motions.records.record import Record
from stylobate.errors import UnlikelyInputWarning

# Lost fraction of the Arias intensity that triggers a warning; the tail of a record is usually below.
_REMARKABLE = 0.01


def lost_intensity(record: Record, kept: int) -> float:
    """Return the fraction of the Arias intensity after the first `kept` samples, over all components."""
    grown = energy(record.samples, record.step).sum(axis=1)
    return float(1.0 - grown[kept - 1] / grown[-1]) if grown[-1] > 0.0 else 0.0


def warn_of_lost_shaking(event: str, names: Sequence[str], records: Sequence[Record], kept: int) -> None:
    """Issue an UnlikelyInputWarning for each component that loses more than 1 % of its Arias intensity.

    Parameters
    ----------
    event
        Name of the event.
    names
        Names of the files, one per record.
    records
        The components, with one time step.
    kept
        Number of kept samples.
    """
    for name, record in zip(names, records, strict=True):
        if (lost := lost_intensity(record, kept)) > _REMARKABLE:
            message = (
                f"{event}: {name} is trimmed from {record.step * (len(record.samples) - 1):g} s to "
                f"{record.step * (kept - 1):g} s and loses {100.0 * lost:.3g} % of its Arias intensity. Set lengths to "
                "pad, or check that the files are of one event"
            )
            warnings.warn(message, UnlikelyInputWarning, stacklevel=2)
