"""Figure of a selection of records."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import literal
from stylobate.plots.result_figure import WIDTH
from stylobate.plots.style import BLACK, GREY, PALETTE, new_figure, styled

_HEIGHT, _ROW, _MOST_ROWS = 3.6, 0.2, 40


@figure_of("record selection")
@styled
def plot_selection(found: xr.Dataset) -> Figure:
    """Draw the scaled spectra with their mean and the target, and the misfit and factor of each record."""
    rows = min(found.sizes["record"], _MOST_ROWS)
    figure = new_figure(max(_HEIGHT, 0.9 + _ROW * rows), width=1.3 * WIDTH)
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    periods = found["period"].to_numpy()
    chosen = found.isel(record=np.flatnonzero(found["chosen"]))
    for place, spectrum in enumerate(chosen["spectral_acceleration"].to_numpy() / STANDARD_GRAVITY):
        label = {"label": "chosen records, scaled"} if place == 0 else {}
        left.loglog(periods, spectrum, color=GREY, linewidth=0.7, **label)
    left.loglog(periods, found["mean"] / STANDARD_GRAVITY, color=PALETTE[0], linewidth=2.0, label="their mean")
    left.loglog(periods, found["target"] / STANDARD_GRAVITY, "--", color=BLACK, linewidth=2.0, label="target")
    for axis in (left.xaxis, left.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    left.set_xlabel("period [s]")
    left.set_ylabel(f"spectral acceleration, {found.attrs['component']} [g]")
    left.set_title(
        f"mean over target {found.attrs['least_ratio']:.2f} to {found.attrs['largest_ratio']:.2f}, "
        f"{100.0 * found.attrs['damping']:g} % damping"
    )
    left.legend(loc="best")
    shown = found.isel(record=slice(rows))
    places = np.arange(rows)
    colours = [PALETTE[0] if one else GREY for one in shown["chosen"].to_numpy()]
    right.barh(places, shown["misfit"], color=colours, height=0.7, zorder=3.0)
    names = [
        literal(f"{name}  × {scale:.3g}{' (bound)' if bound else ''}")
        for name, scale, bound in zip(
            shown["record"].to_numpy().tolist(), shown["scale"].to_numpy(), shown["at_bound"].to_numpy(), strict=True
        )
    ]
    right.set_yticks(places, names)
    right.invert_yaxis()
    right.set_xlabel("misfit, root mean square of ln")
    more = found.sizes["record"] - rows
    right.set_title("chosen records in colour" + (f"; {more} more are not drawn" if more else ""))
    return figure
