"""`stylobate paper` writes a page, figures, data and findings, and prints every claim."""

import json

import pytest

from stylobate.cli.main import run
from stylobate.results.findings import ClaimStatus, Finding, PaperCheck, PaperSection


@pytest.mark.slow
def test_paper_makes_its_report(tmp_path, capsys):
    folder = tmp_path / "paper"
    assert run(["paper", "--folder", str(folder), "--workers", "2"]) == 0
    printed = capsys.readouterr().out
    findings = json.loads((folder / "findings.json").read_text())
    assert len(findings) > 20
    assert "does not hold" in printed
    pictures = list(folder.glob("*.png"))
    html = (folder / "report.html").read_text()
    assert html.count("data:image/png;base64,") == len(pictures) > 10
    assert "http" not in html
    assert all(ClaimStatus(finding["verdict"]) for finding in findings)


def test_an_unconfirmed_claim_ends_with_status_1(monkeypatch, tmp_path, capsys):
    doubt = Finding("(1)", "a claim", "a number", ClaimStatus.NOT_CONFIRMED)
    monkeypatch.setattr("stylobate.paper.check_paper", lambda **_: PaperCheck({"s": PaperSection((doubt,))}))
    monkeypatch.setattr("stylobate.paper.paper_report", lambda *_: tmp_path / "report.html")
    assert run(["paper", "--folder", str(tmp_path)]) == 1
    assert "not confirmed here" in capsys.readouterr().out
