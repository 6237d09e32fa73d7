"""Sums with weights that are known, polynomials, and reciprocals; in lanes and for one."""


def weighted(weights: tuple[float, ...], values: tuple[float, ...]) -> float:
    """Return a linear combination; what has no weight is left out."""
    return sum(weight * value for weight, value in zip(weights, values, strict=False) if weight != 0.0)


def reciprocals(values: tuple[float, ...]) -> tuple[float, ...]:
    """Return 1/value of each, by one division for two of them."""
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
    """Return a polynomial by Horner's rule."""
    return value_and_slope(coefficients, u)[0]


def value_and_slope(coefficients: tuple[float, ...], u: float) -> tuple[float, float]:
    """Return a polynomial and its derivative, by the same rule."""
    value, slope = coefficients[-1], 0.0
    for k in tuple(range(len(coefficients) - 1)):
        slope = value if k == 0 else slope * u + value
        value = value * u + coefficients[len(coefficients) - 2 - k]
    return value, slope
