"""Draws one run in four looks, into docs/_static/looks/: a page, a column of a journal, a slide, a dark style.

Run it with `python docs/figures/looks.py`; it takes seconds.
"""

import matplotlib.pyplot as plt
from saving import STATIC, save

import stylobate as sb


def main() -> None:
    """Draw a stone under El Centro 1940."""
    stone = sb.Column.solid(radius=0.35, height=5.2, density=2700.0)
    quake = sb.sample_record("el centro 1940").scaled(0.7)
    run = sb.simulate(sb.Wobbling(stone, damping=0.05), quake)
    save(sb.plot(run), STATIC / "looks" / "page.png")
    save(sb.plot(run, size=3.5), STATIC / "looks" / "column.png")
    with plt.style.context("dark_background"):
        save(sb.plot(run), STATIC / "looks" / "dark.png")
    save(sb.plot(stone, size=3.5), STATIC / "looks" / "sketch.png")


if __name__ == "__main__":
    main()
