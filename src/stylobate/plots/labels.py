"""Names on axes: what a quantity is called, with its unit."""

import re

import xarray as xr

_EXPONENTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def axis_label(quantity: xr.DataArray) -> str:
    """Return the long name of `quantity` with its unit, such as "angular frequency [rad/s]"."""
    name = str(quantity.attrs.get("long_name") or str(quantity.name).replace("_", " "))
    unit = str(quantity.attrs.get("units", ""))
    return name if unit in ("", "1") else f"{name} [{_written(unit)}]"


def _written(unit: str) -> str:
    """Return "m s-2" as m/s²."""
    above: list[str] = []
    below: list[str] = []
    for symbol, power in re.findall(r"([^\s\d-]+)(-?\d*)", unit):
        raised = power.lstrip("-").translate(_EXPONENTS) if power not in ("", "-1") else ""
        (below if power.startswith("-") else above).append(symbol + raised)
    return "/".join([" ".join(above) or "1", *below])
