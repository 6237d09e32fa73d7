"""Weighted sums, polynomials, and reciprocals, for vectorised loops and for single lanes."""


def weighted(weights: tuple[float, ...], values: tuple[float, ...]) -> float:
    """Return a linear combination without the terms of weight zero."""
    return sum(weight * value for weight, value in zip(weights, values, strict=False) if weight != 0.0)


def reciprocals(values: tuple[float, ...]) -> tuple[float, ...]:
    """Return the reciprocals of the values, with one division for each two."""
    out: tuple[float, ...] = ()
    for j in tuple(range((len(values) + 1) // 2)):
        if 2 * j + 1 < len(values):
            one, other = values[2 * j], values[2 * j + 1]
            per_both = 1.0 / (one * other)
            out = (*out, per_both * other, per_both * one)
        else:
            out = (*out, 1.0 / values[2 * j])
    return out


def polynomial(coefficients: tuple[float, ...], u: float) -> float:
    """Return the value of a polynomial at `u`, by Horner's rule."""
    return value_and_slope(coefficients, u)[0]


def value_and_slope(coefficients: tuple[float, ...], u: float) -> tuple[float, float]:
    """Return value and derivative of a polynomial at `u`, by Horner's rule."""
    value, slope = coefficients[-1], 0.0
    for k in tuple(range(len(coefficients) - 1)):
        slope = value if k == 0 else slope * u + value
        value = value * u + coefficients[len(coefficients) - 2 - k]
    return value, slope
