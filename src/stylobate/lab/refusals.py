"""Refusal of a request: an HTTP status and one line for each reason."""

from collections.abc import Sequence


class RefusedError(Exception):
    """A refused request.

    Attributes
    ----------
    status
        HTTP status of the answer.
    problems
        One line for each reason, with the remedy.
    """

    def __init__(self, status: int, problems: Sequence[str]) -> None:
        self.status = status
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))
