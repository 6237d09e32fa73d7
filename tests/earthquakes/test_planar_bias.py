"""The planar column and the one in space agree where they are one, and the bias is that of their ratio."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import planar_bias
from stylobate.earthquakes.planar_comparison import InOneDirection, in_one_direction

SCALES = np.array([0.5, 0.6, 0.65, 0.7, 0.9, 2.0])


def slender(c):
    return sb.Slender(sb.Column.solid(radius=c * 5.0, height=10.0, density=2700.0), damping=0.05)


def pulse(c, omega=4.0, **more):
    return sb.Pulse.one_sine(acceleration=2.0 * c * 9.80665, angular_frequency=omega, **more)


def against_itself(c, records, **more):
    model = slender(c)
    planar = sb.PlanarRocking(model.column, damping=0.05, restitution=1.0)
    return planar_bias(model, records, scales=SCALES, planar=planar, **more)


@pytest.mark.slow
@pytest.mark.parametrize("direction", [0.0, 0.9])
def test_along_a_line_a_slender_column_is_planar_to_the_order_of_its_slenderness_squared(direction):
    off = []
    for c in (0.1, 0.05):
        found = against_itself(c, pulse(c, direction=direction), directions=[direction])
        assert int(found["compared"].sum()) >= 2
        off.append(float(abs(found["log_ratio"]).max()))
        np.testing.assert_array_equal(np.isinf(found["tilt_ratio"]), np.isinf(found["worst_planar_tilt_ratio"]))
    assert off[0] < 0.1
    assert 3.0 < off[0] / off[1] < 5.5


@pytest.mark.slow
def test_along_a_line_a_wobbling_column_is_the_planar_one():
    column = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
    model = sb.Wobbling(column, damping=0.03, restitution=0.9)
    planar = sb.PlanarRocking(column, damping=0.03, restitution=0.9)
    found = planar_bias(model, pulse(0.2, 8.0, direction=0.4), scales=SCALES, directions=[0.4], planar=planar)
    assert int(found["compared"].sum()) >= 2
    np.testing.assert_allclose(found["log_ratio"].values[np.isfinite(found["log_ratio"])], 0.0, atol=1e-6)


def test_the_worst_direction_counts_and_a_plane_across_the_pulse_sees_nothing():
    records = {
        "along": pulse(0.05),
        "across": pulse(0.05, direction=math.pi / 2),
        "between": pulse(0.05, direction=0.6),
    }
    found = against_itself(0.05, records)
    quiet = found["planar_tilt_ratio"].sel(record="along").isel(direction=1)
    assert float(quiet.max()) < 1e-9
    np.testing.assert_array_equal(
        found["worst_planar_tilt_ratio"], found["planar_tilt_ratio"].max("direction", skipna=False)
    )
    weaker = in_one_direction(records["between"], 0.0)
    assert weaker.peak_horizontal() >= abs(weaker.acceleration(0.4)[0])
    # A component is weaker than the whole: the plane is on the unsafe side.
    between = found.sel(record="between")
    assert float(between["log_ratio"].max()) > 0.05
    assert not float(between["least_overturning"]) > float(between["worst_least_planar_overturning"])


def test_bias_scatter_and_error_are_those_of_the_logarithms():
    records = {f"{angle}": pulse(0.05, direction=angle) for angle in (0.0, 0.3, 0.5, 0.7)}
    found = against_itself(0.05, records)
    logs = found["log_ratio"].to_numpy()
    at = int(np.argmax(found["compared"].to_numpy()))
    own = logs[:, at][np.isfinite(logs[:, at])]
    assert own.size >= 3
    for name, expected in (
        ("bias", own.mean()),
        ("scatter", own.std(ddof=1)),
        ("standard_error", own.std(ddof=1) / np.sqrt(own.size)),
        ("compared", own.size),
    ):
        assert float(found[name][at]) == pytest.approx(expected)
    means = np.array([row[np.isfinite(row)].mean() for row in logs])
    assert float(found["overall_bias"]) == pytest.approx(means.mean())
    assert float(found["overall_standard_error"]) == pytest.approx(means.std(ddof=1) / 2.0)
    capacity = np.log(found["least_overturning"] / found["worst_least_planar_overturning"]).to_numpy()
    known = capacity[np.isfinite(capacity)]
    assert float(found["capacity_bias"]) == pytest.approx(known.mean())
    assert int(found["only_space"].sum() + found["only_planar"].sum()) == int(
        (np.isinf(found["tilt_ratio"]) != np.isinf(found["worst_planar_tilt_ratio"])).sum()
    )


@pytest.mark.parametrize("options", [{}, {"least_ratio": 0.3}])
def test_tilts_are_compared_where_both_columns_rock_by_more_than_the_stated_fraction(options):
    found = against_itself(0.05, pulse(0.05, direction=0.3), **options)
    least = options.get("least_ratio", 1e-3)
    both = np.stack([found["tilt_ratio"].to_numpy(), found["worst_planar_tilt_ratio"].to_numpy()])
    rocking = np.all((both > least) & np.isfinite(both), axis=0)
    assert 0 < np.count_nonzero(rocking) < np.count_nonzero(np.isfinite(both).all(axis=0))
    np.testing.assert_array_equal(np.isfinite(found["log_ratio"]), rocking)
    np.testing.assert_allclose(found["log_ratio"].to_numpy()[rocking], np.log(np.divide(*both[:, rocking])))


def test_one_record_tells_no_bias():
    found = against_itself(0.05, pulse(0.05, direction=0.3))
    assert int(found["overall_compared"]) == 1
    for name in ("bias", "overall_bias", "capacity_bias", "overall_standard_error"):
        assert np.isnan(found[name]).all()
    assert np.isfinite(found["log_ratio"]).any()


def test_a_record_in_one_direction_is_a_record():
    record = sb.Record(samples=np.random.default_rng(0).normal(size=(40, 3)), step=0.02, name="noise")
    turned = in_one_direction(record, 0.7)
    expected = record.samples[:, 0] * math.cos(0.7) + record.samples[:, 1] * math.sin(0.7)
    np.testing.assert_allclose(turned.samples[:, 0], expected)
    assert turned.axes == ("x", "z")
    moved = in_one_direction(record.rotated(0.2) + sb.Pulse.one_sine(acceleration=1.0, angular_frequency=9.0), 0.7)
    times = np.linspace(0.0, 0.8, 7)
    x, y, z = (record.rotated(0.2) + sb.Pulse.one_sine(acceleration=1.0, angular_frequency=9.0)).acceleration(times).T
    np.testing.assert_allclose(moved.acceleration(times)[:, 0], x * math.cos(0.7) + y * math.sin(0.7), atol=1e-12)
    np.testing.assert_allclose(moved.acceleration(times)[:, 1:], np.stack([0.0 * z, z], axis=-1), atol=1e-12)
    assert len(moved.directions()) == 1
    line = InOneDirection(motion=pulse(0.1, direction=0.2), direction=0.7)
    size = np.hypot(*pulse(0.1).directions()[0]) * math.cos(0.5)
    np.testing.assert_allclose(line.directions(), [(size * math.cos(0.7), size * math.sin(0.7))])


def test_a_planar_model_is_not_compared_with_itself():
    with pytest.raises(sb.errors.UnsupportedError, match="model must be three-dimensional"):
        planar_bias(sb.PlanarRocking(slender(0.1).column), pulse(0.1), scales=[1.0])
    with pytest.raises(sb.errors.ParameterError, match="directions must hold at least one angle"):
        planar_bias(slender(0.1), pulse(0.1), scales=[1.0], directions=[])
