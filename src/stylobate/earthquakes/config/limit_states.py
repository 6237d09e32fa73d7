"""Descriptions of limit states of displacement, in files and on the command line."""

from collections.abc import Mapping, Sequence
from typing import Any

from stylobate.config.description import Config, Metres, built
from stylobate.earthquakes.fragility.displacement_limits import LimitState, checked_limit_states
from stylobate.errors import ParameterError


class LimitStateConfig(Config):
    """A limit of the displacement of a column.

    Parameters
    ----------
    response
        Displacement that is limited: "slip", the largest distance of the base from its start; "residual", that at the
        end; "neighbours", the largest displacement of the body at a height; "edge", the largest distance of the base
        from its start, towards the edge of its plinth.
    limit
        Distance that counts as reached [m].
    height
        Height of the neighbours above the base [m]; for "neighbours" only, by default that of the column.
    """

    response: str
    limit: Metres
    height: Metres | None = None

    def build(self) -> LimitState:
        """Build the limit state; raise ParameterError for an invalid one."""
        return LimitState(response=self.response, limit=self.limit, height=self.height)


def built_limit_states(
    where: str, described: Sequence[LimitStateConfig], problems: list[str]
) -> tuple[LimitState, ...]:
    """Build limit states; add a line to `problems` for each mistake."""
    found = [built(f"{where}[{place}]", one.build, problems) for place, one in enumerate(described)]
    known = [one for one in found if one is not None]
    try:
        return checked_limit_states(known, where)
    except ParameterError as error:
        problems.append(str(error))
        return ()


def limit_state_of_text(text: str) -> Mapping[str, Any]:
    """Return the values of a limit state from "RESPONSE=LIMIT" or "RESPONSE=LIMIT@HEIGHT".

    Raises
    ------
    ParameterError
        If the text is of another form.

    Examples
    --------
    >>> limit_state_of_text("slip=0.05"), limit_state_of_text("neighbours=80 mm@2.5")
    ({'response': 'slip', 'limit': 0.05}, {'response': 'neighbours', 'limit': '80 mm', 'height': 2.5})
    """
    response, _, rest = text.partition("=")
    limit, at, height = rest.partition("@")
    if not response.strip() or not limit.strip() or (at and not height.strip()):
        raise ParameterError(
            f"--limit-state: must be a response and its limit (got {text!r}). Write slip=0.05 or neighbours=0.08@2.5."
        )
    heights = {"height": _number(height)} if at else {}
    return {"response": response.strip(), "limit": _number(limit), **heights}


def _number(text: str) -> float | str:
    """Return a number, or a text that has a unit."""
    try:
        return float(text)
    except ValueError:
        return text.strip()
