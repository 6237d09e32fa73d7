from .analyses import check_paper
from .report import paper_report

__all__ = [
    "check_paper",
    "paper_report",
]
