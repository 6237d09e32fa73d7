"""Contact results of runs whose model changes between kinds of contact."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.variables import CONTACT_KINDS, TIMES_OF_CONTACTS
from stylobate.engine.kernel.columns import SLACK, STATE, Change, Log
from stylobate.engine.kernel.driver.events import Status
from stylobate.errors import Outcome

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Contacts:
    """Contact record of each run; times are in the units of the models."""

    state: Floats
    noted: Floats
    kind: npt.NDArray[np.int8]
    times: Mapping[str, Floats]

    @classmethod
    def of(cls, batch: Batch) -> "Contacts":
        """Return the contact record of a batch; the present kind of contact lasts to the end."""
        order = len(batch.plan.model.state_names)
        state, noted = batch.table[:, STATE : STATE + order].T, batch.table[:, STATE + order :]
        kind, present = state[-1].astype(np.int8), batch.log(Log.TIME) - noted[:, Change.SINCE]
        times = {
            name: noted[:, column] + np.where(kind == number, present, 0.0)
            for number, (name, column) in enumerate(zip(CONTACT_KINDS, TIMES_OF_CONTACTS, strict=True))
        }
        return cls(state, noted, kind, times)

    def late(self, name: str) -> npt.NDArray[np.bool_]:
        """Return the runs in which this contact occurred in the last periods."""
        rim = self.times["rolling"] + self.times["slipping"]
        taken = {"sliding": self.times["sliding"], "rim": rim, "flying": self.times["flying"]}[name]
        before = self.noted[:, Change[f"WINDOW_{name.upper()}"]]
        return np.asarray(taken - before > SLACK * (1.0 + taken))


def contact_arrays(batch: Batch, span: Floats) -> dict[str, npt.NDArray[Any]]:
    """Return final position, contact kind, mean velocities, contact times and event counts of each run.

    `span` is the length of the last periods, NaN if they were not computed.
    """
    names, scale, length = batch.plan.model.state_names, batch.models.time_scale, batch.models.length
    contacts = Contacts.of(batch)
    places = [names.index(name) for name in ("footprint_x", "footprint_y", "twist")]
    begun = contacts.noted[:, [Change.WINDOW_X, Change.WINDOW_Y, Change.WINDOW_TWIST]].T
    span = np.where(np.isnan(span), np.nan, batch.log(Log.TIME) - contacts.noted[:, Change.WINDOW_AT])
    with np.errstate(divide="ignore", invalid="ignore"):
        vx, vy, turning = (contacts.state[places] - begun) / (span * scale)
    return {
        "end_footprint": (contacts.state[places[:2]] * length).T,
        "end_twist": contacts.state[places[2]],
        "end_contact": contacts.kind,
        "mean_velocity": np.stack([vx, vy], axis=-1) * length[:, np.newaxis],
        "mean_twist_rate": turning,
        "impacts": contacts.noted[:, Change.IMPACTS],
        "slips": contacts.noted[:, Change.SLIPS],
        **{f"time_{name}": times * scale for name, times in contacts.times.items()},
    }


def upright_outcomes(batch: Batch, span: Floats, codes: npt.NDArray[np.int8]) -> npt.NDArray[np.int8]:
    """Replace the outcomes of columns that stay upright in the last periods, or at the end if there are none."""
    contacts = Contacts.of(batch)
    seen, decided = ~np.isnan(span), batch.log(Log.STATUS) == Status.STOPPED
    names = [kind.name for kind in batch.plan.model.contact_kinds or ()]
    upright = ~np.any(contacts.state[:2], axis=0)
    rim = np.where(seen, contacts.late("rim"), ~upright)
    flies = np.where(seen, contacts.late("flying"), contacts.kind == names.index("FLYING"))
    slides = np.where(seen, contacts.late("sliding"), contacts.kind == names.index("SLIDING"))
    hops = decided & ~rim & flies
    codes = np.where(hops, Outcome.LIFTED_OFF, codes)
    return np.where(decided & ~rim & ~flies & slides, Outcome.SLID, codes).astype(np.int8)
