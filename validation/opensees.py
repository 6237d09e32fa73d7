"""A block of OpenSees' element `RockingBC`, made ever stiffer, beside `PlanarRocking`.

`RockingBC` is a deformable planar member that rocks on its base (E. Avgenakis and I. N. Psycharis, Earthquake
Engineering and Structural Dynamics 49 (2020) 1072). Block and loads are those of the example that OpenSees has of it:
α = 0.2, 1 m wide, released at α/2, or pushed by one sine of 2 α g and 6 p. Its stiffness is stated by the strain
e0 = ρ g H/E of the base under the weight, which is zero for a rigid block.
"""

import contextlib
import math
import os
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad

import stylobate as sb

from .engines import version
from .finding import Finding, Kind

WIDTH, DENSITY, GRAVITY = 1.0, 2500.0, 9.81
RELEASED = 0.5
"""Initial tilt of the free block over α."""
PUSH, FREQUENCY = 2.0, 6.0
"""Amplitude of the pulse over α g, and its angular frequency over p."""
# Control points of the interface, stress over that which yields (elastic here), and bounds of the element's iterations.
_POINTS, _LOADED, _LIMIT, _TRIES = 15, 1e-9, 1e-15, 50
_STATIC, _DYNAMIC, _ITERATIONS = 1e-10, 1e-10, 100
_DAMPING, _LEAST_STEP = 0.05, 1e-8
_CLEAR = 1e-3  # a tilt that is not one of the elastic base [rad]
# A step that fails is halved; after so many good ones steps grow again.
_GOOD, _GROWTH = 10, 1.5


@dataclass(frozen=True)
class Block:
    """A block 1 m wide and 1 m thick, with this tipping angle."""

    angle: float

    @property
    def height(self) -> float:
        """Height [m]."""
        return WIDTH / math.tan(self.angle)

    def model(self) -> sb.PlanarRocking:
        """Return the model of the rigid block, with Housner's restitution."""
        return sb.PlanarRocking.block(width=WIDTH, height=self.height, density=DENSITY, gravity=GRAVITY)

    @property
    def pulse(self) -> dict[str, float]:
        """Acceleration [m/s²] and angular frequency [rad/s] of the pulse of the example."""
        p = self.model().column.frequency_parameter
        return {"acceleration": PUSH * self.angle * GRAVITY, "angular_frequency": FREQUENCY * p}


def findings() -> Iterator[Finding]:
    """Yield the times of the first passage and the restitution, if OpenSees is installed."""
    if not version("openseespy"):
        print("opensees: left out, not installed: openseespy")
        return
    yield from free()
    yield from pushed()
    yield restitution()


def _source() -> str:
    return f"OpenSees {version('openseespy')}, RockingBC"


def free() -> Iterator[Finding]:
    """Yield the quarter periods of the block of the example and of a slenderer one."""
    for angle in (0.2, 0.1):
        block, small = Block(angle), small_rotations(Block(angle))
        strain, step = 5e-8 * (angle / 0.2) ** 2, 1e-4 * 0.2 / angle
        theirs = passage(*rocking(block, strain, step))
        exact = sb.simulate(block.model(), tilt=(RELEASED * angle, 0.0), duration=5.0, rtol=1e-12).events[0].time
        remark = f"a rigid block of small rotations: {small:.5f}, difference {abs(theirs / small - 1.0):.1e}"
        if angle == 0.2:
            for text, runs in (
                ("e0 = {:g}: {}", [(e0, step) for e0 in (5e-6, 5e-7)]),
                ("steps of {1:g} ms: {0}", [(strain, one) for one in (1e-2, 1e-3)]),
            ):
                for e0, one in runs:
                    off = f"{abs(passage(*rocking(block, e0, one)) / small - 1.0):.1e}"
                    remark += "; with " + (text.format(e0, off) if "e0" in text else text.format(off, 1e3 * one))
        yield Finding(
            _source(),
            f"block, α = {angle:g}, released at α/2, e0 = {strain:.1e}: time until it passes the vertical [s]",
            theirs,
            exact,
            Kind.CODE,
            remark=remark,
        )


def pushed() -> Iterator[Finding]:
    """Yield peak tilt and duration of the first swing under the pulse."""
    block = Block(0.2)
    runs = {strain: rocking(block, strain, 1e-3, pushed=True) for strain in (5e-6, 5e-7, 5e-8)}
    run = sb.simulate(block.model(), sb.Pulse.one_sine(**block.pulse), duration=1.0, samples=20001, rtol=1e-12)
    passed = next(event.time for event in run.events if event.kind == "impact")
    tilts = np.abs(run.data["tilt"].to_numpy()[:, 0][run.data["time"].to_numpy() <= passed])
    for text, of_run, ours in (
        ("time until it passes the vertical [s]", passage, passed),
        ("peak tilt before [rad]", peak, float(tilts.max())),
    ):
        values = {strain: of_run(*one) for strain, one in runs.items()}
        *softer, stiffest = values
        yield Finding(
            _source(),
            f"block, α = 0.2, one sine of 2 α g and 6 p, e0 = {stiffest:g}: {text}",
            values[stiffest],
            ours,
            Kind.CODE,
            remark="; ".join(f"difference with e0 = {one:g}: {abs(values[one] / ours - 1.0):.1e}" for one in softer),
        )


def restitution() -> Finding:
    """Return the restitution that the second swing of the free block implies, beside Housner's."""
    block = Block(0.2)
    found = {
        (strain, damping): _restitution(block, strain, damping)
        for strain, damping in ((5e-7, _DAMPING), (5e-6, _DAMPING), (5e-6, 0.01), (5e-6, 0.2))
    }
    (first, theirs), *others = found.items()
    return Finding(
        _source(),
        f"block, α = 0.2, released at α/2, e0 = {first[0]:g}, damping ratio {first[1]:g}: restitution; here Housner's",
        theirs,
        block.model().impact_restitution,
        Kind.CODE,
        remark="; ".join(
            f"{e:.4f} with e0 = {strain:g} and damping ratio {damping:g}" for (strain, damping), e in others
        ),
    )


def _restitution(block: Block, strain: float, damping: float) -> float:
    times, tilts = rocking(block, strain, 1e-4, damping=damping, until=1.7)
    second = float(np.abs(tilts[times > passage(times, tilts)]).max())
    h, r = 0.5 * block.height, 0.5 * WIDTH
    first = RELEASED * block.angle
    return math.sqrt((r - 0.5 * h * second) * second / ((r - 0.5 * h * first) * first))


def small_rotations(block: Block) -> float:
    """Return the quarter period [s] of a rigid block whose centre moves by (h θ, r θ − h θ²/2).

    These are the displacements of the element as it stiffens.
    """
    h, r, start = 0.5 * block.height, 0.5 * WIDTH, RELEASED * block.angle

    def rate(part: float) -> float:  # dt/ds at the tilt (1 − s²) of the start
        tilt = start * (1.0 - part * part)
        inertia = (h * h + r * r) / 3.0 + h * h + (r - h * tilt) ** 2
        # V(start) − V(θ) = g (start − θ)(r − h (start + θ)/2), start − θ = start s²
        return 2.0 * start * math.sqrt(inertia / (2.0 * GRAVITY * start * (r - 0.5 * h * (start + tilt))))

    return float(quad(rate, 0.0, 1.0, epsabs=0.0, epsrel=1e-12)[0])


def passage(times: np.ndarray, tilts: np.ndarray) -> float:
    """Return the time at which the tilt first changes its sign, after it has grown [s]."""
    after = int(np.argmax(np.abs(tilts) > _CLEAR))
    at = after + int(np.argmax(tilts[after:] * tilts[after] < 0.0))
    before = at - 1
    return float(times[before] + (times[at] - times[before]) * tilts[before] / (tilts[before] - tilts[at]))


def peak(times: np.ndarray, tilts: np.ndarray) -> float:
    """Return the peak tilt before the first passage [rad]."""
    return float(np.abs(tilts[times < passage(times, tilts)]).max())


def rocking(
    block: Block,
    strain: float,
    step: float,
    *,
    damping: float = _DAMPING,
    pushed: bool = False,
    until: float | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return times [s] and tilts [rad] of the block until a time, by default until it has passed the vertical."""
    import openseespy.opensees as ops

    with _silence():
        _built(ops, block, strain)
        frequency = math.sqrt(ops.eigen("-fullGenLapack", 1)[0])
        if not pushed:
            _tilted(ops, RELEASED * block.angle)
        ops.setTime(0.0)
        ops.wipeAnalysis()
        ops.rayleigh(0.0, 2.0 * damping / frequency, 0.0, 0.0)
        if pushed:
            period = 2.0 * math.pi / block.pulse["angular_frequency"]
            ops.timeSeries("Trig", 3, 0.0, period, period, "-factor", block.pulse["acceleration"])
            ops.pattern("UniformExcitation", 3, 1, "-accel", 3)
        _settings(ops, "Newmark", 0.5, 0.25)
        ops.test("RelativeNormUnbalance", _DYNAMIC, _ITERATIONS)
        ops.analysis("Transient")
        times, tilts = [0.0], [-ops.nodeDisp(2, 3)]
        present, good = step, 0
        while times[-1] < until if until else not _has_passed(tilts):
            if ops.analyze(1, present) != 0:
                if present == _LEAST_STEP:
                    raise RuntimeError(f"OpenSees: no step leads on from {times[-1]} s (e0 = {strain:g})")
                present, good = max(_LEAST_STEP, 0.5 * present), 0
                continue
            good += 1
            present = min(step, _GROWTH * present) if good >= _GOOD else present
            times.append(ops.getTime())
            tilts.append(-ops.nodeDisp(2, 3))
        ops.wipe()
    return np.array(times), np.array(tilts)


def _has_passed(tilts: list[float]) -> bool:
    return min(tilts) < -_CLEAR and max(tilts) > _CLEAR


def _built(ops: object, block: Block, strain: float) -> None:
    """Build the block under its weight: the mass is in node 2, the base is node 1."""
    height = block.height
    mass = DENSITY * WIDTH * height
    pressure = DENSITY * GRAVITY * height
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(1, 0.0, 0.0)
    ops.node(2, 0.0, 0.5 * height)
    member = (_POINTS, pressure / strain, 0.0, -pressure / _LOADED, WIDTH, 1.0, 0.0)
    ops.element("RockingBC", 1, 2, 1, *member, "-convlim", _LIMIT, "-maxtries", _TRIES)
    ops.fix(1, 1, 1, 1)
    ops.mass(2, mass, mass, mass * (WIDTH**2 + height**2) / 12.0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, -mass * GRAVITY, 0.0)
    _static(ops, "LoadControl", 0.1)
    _require(ops.analyze(10))
    ops.loadConst("-time", 0.0)


def _tilted(ops: object, tilt: float) -> None:
    """Tilt the block by a horizontal force and take the force away."""
    ops.pattern("Plain", 2, 1)
    ops.load(2, 1.0, 0.0, 0.0)
    for _ in range(200):
        _static(ops, "DisplacementControl", 2, 3, -tilt / 200.0)
        _require(ops.analyze(1))
    ops.remove("loadPattern", 2)


def _static(ops: object, *integrator: object) -> None:
    _settings(ops, *integrator)
    ops.test("EnergyIncr", _STATIC, _ITERATIONS)
    ops.analysis("Static")


def _settings(ops: object, *integrator: object) -> None:
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.algorithm("Newton")
    ops.integrator(*integrator)


def _require(status: int) -> None:
    if status != 0:
        raise RuntimeError("OpenSees: the static analysis fails")


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Send what compiled code prints nowhere."""
    kept = [(stream, os.dup(stream)) for stream in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream, _ in kept:
            os.dup2(nowhere, stream)
        yield
    finally:
        for stream, copy in kept:
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nowhere)
