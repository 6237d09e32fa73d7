"""Physics engines and a multibody program on a cylinder that rolls on its rim, beside `Rolling`.

Each engine is a function of case and step: it sets the case up and returns the run, a function that returns the
direction of the axis at each sample. `python -m validation.engines` draws the figure of the measured numbers again.
"""

import importlib.metadata
import json
import logging
import math
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from stylobate.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, new_figure, styled

from .finding import FOLDER, Finding, Kind
from .rolling_rim import SAMPLE, Axes, Case, G, cases, followed, settling

Run = Callable[[], Axes]

STEPS = (1e-2, 2.5e-3, 1e-3, 2.5e-4, 1e-4)
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
FRICTION = 2.0  # no case needs more than 0.4; PyBullet multiplies those of two bodies


def mujoco(case: Case, step: float, *, advised: bool) -> Run:
    """Set up MuJoCo."""
    import mujoco as mj

    contact = f'friction="{FRICTION} 0 {case.resistance * case.column.radius}"'
    if case.resistance:  # friction in all six directions; its third coefficient is the lever arm of rolling [m]
        contact += ' condim="6"'
    options = f'timestep="{step}" gravity="0 0 {-G}"'
    if advised:  # the stiffest contact for the step; friction as firm as the normal force or firmer
        contact += f' solref="{2 * step} 1" solimp="0.9999 0.9999 0.001"'
        options += ' integrator="implicitfast" cone="elliptic" impratio="100" tolerance="1e-14"'
    centre, rotation, velocity, spinning = case.placed()
    inertias, column = case.inertias, case.column
    model = mj.MjModel.from_xml_string(
        f'<mujoco><option {options}/><worldbody><geom type="plane" size="0 0 1" {contact}/>'
        f'<body pos="{written(centre)}" quat="{math.cos(case.tilt / 2)} 0 {math.sin(case.tilt / 2)} 0"><freejoint/>'
        f'<inertial pos="0 0 0" mass="{column.mass}" diaginertia="{written(inertias)}"/>'
        f'<geom type="cylinder" size="{column.radius} {column.mass_height}" {contact}/></body></worldbody></mujoco>'
    )
    data = mj.MjData(model)
    data.qvel[:] = *velocity, *(rotation.T @ spinning)

    def advance(at: float, count: int) -> None:
        if not case.driven:
            mj.mj_step(model, data, nstep=count)
            return
        for i in range(count):
            model.opt.gravity[:] = case.gravity(at + (i + 0.5) * step)
            mj.mj_step(model, data)

    return lambda: followed(case, step, advance, lambda: data.xmat[1].reshape(3, 3)[:, 2])


def written(numbers: Any) -> str:
    """Return numbers with blanks between them."""
    return " ".join(repr(float(number)) for number in numbers)


def pybullet(case: Case, step: float, *, advised: bool) -> Run:
    """Set up PyBullet."""
    import pybullet as pb

    client = pb.connect(pb.DIRECT)
    solver, body_options = {}, {}
    if advised:  # solved to rounding; no damping; a rim without the rounding of the collision margin
        solver = {
            "numSolverIterations": 200,
            "solverResidualThreshold": 0.0,
            "contactSlop": 0.0,
            "enableConeFriction": 1,
        }
        body_options = {"linearDamping": 0.0, "angularDamping": 0.0, "collisionMargin": 1e-6}
    centre, _, velocity, spinning = case.placed()
    radius, height = case.column.radius, 2.0 * case.column.mass_height
    pb.setPhysicsEngineParameter(fixedTimeStep=step, physicsClientId=client, **solver)
    pb.setGravity(*case.gravity(0.0), physicsClientId=client)
    shapes = [
        pb.createCollisionShape(pb.GEOM_PLANE, physicsClientId=client),
        pb.createCollisionShape(pb.GEOM_CYLINDER, radius=radius, height=height, physicsClientId=client),
    ]
    plane = pb.createMultiBody(0.0, shapes[0], physicsClientId=client)
    body = pb.createMultiBody(
        case.column.mass, shapes[1], basePosition=centre, physicsClientId=client,
        baseOrientation=[0.0, math.sin(case.tilt / 2), 0.0, math.cos(case.tilt / 2)],
    )  # fmt: skip
    pb.changeDynamics(plane, -1, lateralFriction=FRICTION, physicsClientId=client)
    pb.changeDynamics(
        body, -1, lateralFriction=FRICTION, restitution=0.0, localInertiaDiagonal=case.inertias,
        activationState=pb.ACTIVATION_STATE_DISABLE_SLEEPING, physicsClientId=client, **body_options,
    )  # fmt: skip
    pb.resetBaseVelocity(body, velocity, spinning, physicsClientId=client)

    def advance(at: float, count: int) -> None:
        for i in range(count):
            if case.driven:
                pb.setGravity(*case.gravity(at + (i + 0.5) * step), physicsClientId=client)
            pb.stepSimulation(client)

    def axis() -> Axes:
        return np.array(pb.getMatrixFromQuaternion(pb.getBasePositionAndOrientation(body, client)[1])[2::3])

    def run() -> Axes:
        axes = followed(case, step, advance, axis)
        pb.disconnect(client)
        return axes

    return run


def drake(case: Case, step: float) -> Run:
    """Set up Drake: discrete, solver SAP, contact at points, too stiff for the step, which then sets the stiffness."""
    import pydrake.all as pd

    logging.getLogger("drake").setLevel(logging.ERROR)
    centre, rotation, velocity, spinning = case.placed()
    mass = case.column.mass
    builder = pd.DiagramBuilder()
    plant, _ = pd.AddMultibodyPlantSceneGraph(builder, step)
    plant.set_contact_model(pd.ContactModel.kPoint)
    plant.set_discrete_contact_approximation(pd.DiscreteContactApproximation.kSap)
    inertia = pd.UnitInertia(*(one / mass for one in case.inertias))
    body = plant.AddRigidBody("cylinder", pd.SpatialInertia(mass, np.zeros(3), inertia))
    contact = pd.ProximityProperties()
    friction = pd.CoulombFriction(FRICTION, FRICTION)
    pd.AddContactMaterial(point_stiffness=1e12, friction=friction, properties=contact)
    contact.AddProperty("material", "relaxation_time", 0.0)
    at_centre, ground = pd.RigidTransform(), plant.world_body()
    cylinder = pd.Cylinder(case.column.radius, 2.0 * case.column.mass_height)
    plant.RegisterCollisionGeometry(body, at_centre, cylinder, "cylinder", contact)
    plant.RegisterCollisionGeometry(ground, at_centre, pd.HalfSpace(), "ground", contact)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -G])
    plant.Finalize()

    class Push(pd.LeafSystem):  # type: ignore[misc]
        """The force of inertia in the frame of the base."""

        def __init__(self) -> None:
            super().__init__()
            self.DeclareAbstractOutputPort("push", lambda: pd.AbstractValue.Make([force]), self.calculate)

        def calculate(self, context: Any, output: Any) -> None:
            push = mass * np.add(case.gravity(context.get_time() + 0.5 * step), (0.0, 0.0, G))
            force.F_Bq_W = pd.SpatialForce(np.zeros(3), push)
            output.set_value([force])

    force = pd.ExternallyAppliedSpatialForce()
    force.body_index, force.p_BoBq_B, force.F_Bq_W = body.index(), np.zeros(3), pd.SpatialForce.Zero()
    if case.driven:
        builder.Connect(builder.AddSystem(Push()).get_output_port(), plant.get_applied_spatial_force_input_port())
    simulator = pd.Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetFreeBodyPose(context, body, pd.RigidTransform(pd.RotationMatrix(rotation), centre))
    plant.SetFreeBodySpatialVelocity(context, body, pd.SpatialVelocity(spinning, velocity))
    simulator.Initialize()

    def axis() -> Axes:
        return plant.EvalBodyPoseInWorld(context, body).rotation().matrix()[:, 2]

    return lambda: followed(case, step, lambda at, count: simulator.AdvanceTo(at + count * step) and None, axis)


def exudyn(case: Case, step: float) -> Run:
    """Set up Exudyn: no contact, but its joint of a disc that rolls on a plane; its local x is the axis."""
    import exudyn as ex
    from exudyn import itemInterface as items  # noqa: N813
    from exudyn.rigidBodyUtilities import AngularVelocity2EulerParameters_t, RotationMatrix2EulerParameters

    centre, rotation, _, spinning = case.placed()
    transverse, _, axial = case.inertias
    mass, height = case.column.mass, case.column.mass_height
    disc = centre - height * rotation[:, 2]
    angles = RotationMatrix2EulerParameters(rotation[:, [2, 0, 1]])
    rates = AngularVelocity2EulerParameters_t(spinning, angles)
    container = ex.SystemContainer()
    system = container.AddSystem()
    node = system.AddNode(
        items.NodeRigidBodyEP(
            referenceCoordinates=[*disc, *angles], initialVelocities=[*np.cross(spinning, disc), *rates]
        )
    )
    about_disc = transverse + mass * height**2
    body = system.AddObject(
        items.ObjectRigidBody(
            nodeNumber=node,
            mass=mass,
            centerOfMass=[height, 0.0, 0.0],
            inertia=[axial, about_disc, about_disc, 0, 0, 0],
        )
    )
    ground = system.AddObject(items.ObjectGround())
    markers = [system.AddMarker(items.MarkerBodyRigid(bodyNumber=one)) for one in (ground, body)]
    system.AddObject(items.ObjectJointRollingDisc(markerNumbers=markers, discRadius=case.column.radius))
    weight = items.LoadMassProportional(
        markerNumber=system.AddMarker(items.MarkerBodyMass(bodyNumber=body)), loadVector=case.gravity(0.0)
    )
    if case.driven:
        weight.loadVectorUserFunction = lambda _system, at, _vector: case.gravity(at)
    system.AddLoad(weight)
    axes = items.SensorBody(
        bodyNumber=body, storeInternal=True, outputVariableType=ex.OutputVariableType.RotationMatrix
    )
    sensor = system.AddSensor(axes)
    system.Assemble()
    settings = ex.SimulationSettings()
    settings.timeIntegration.numberOfSteps = case.samples * round(SAMPLE / step)
    settings.timeIntegration.endTime = case.duration
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = SAMPLE
    settings.show.statistics = False

    def run() -> Axes:
        system.SolveDynamic(settings, solverType=ex.DynamicSolverType.TrapezoidalIndex2)  # no numerical damping
        return np.array(system.GetSensorStoredData(sensor))[:, [1, 4, 7]]

    return run


ENGINES: dict[str, tuple[str, Callable[[Case, float], Run]]] = {
    "MuJoCo": ("mujoco", partial(mujoco, advised=True)),
    "MuJoCo, default contact": ("mujoco", partial(mujoco, advised=False)),
    "PyBullet": ("pybullet", partial(pybullet, advised=True)),
    "PyBullet, default settings": ("pybullet", partial(pybullet, advised=False)),
    "Drake": ("drake", drake),
    "Exudyn": ("exudyn", exudyn),
}
"""Distribution and function of each engine."""


def installed() -> dict[str, Callable[[Case, float], Run]]:
    """Return the engines that are installed; print the names of the others."""
    found = {name: engine for name, (package, engine) in ENGINES.items() if version(package)}
    missing = sorted({package for package, _ in ENGINES.values() if not version(package)})
    if missing:
        print(f"left out, not installed: {', '.join(missing)}")
    return found


def version(package: str) -> str:
    """Return the version of a distribution, empty if it is not installed."""
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return ""


def measure(case: Case, prepare: Callable[[], Run]) -> dict[str, float]:
    """Run a case twice; return number, relative error, final tilt [rad] and processor time per simulated second."""
    seconds = math.inf
    for _ in range(2):
        run = prepare()
        begun = time.process_time()
        axes = run()
        seconds = min(seconds, time.process_time() - begun)
    value = case.measured(axes)
    return {
        "value": value,  # NaN if a can never rises again
        "error": abs(value / case.exact - 1.0),
        "end_tilt": float(np.arccos(axes[-1, 2])),
        "cost": seconds / case.duration,
    }


def findings() -> Iterator[Finding]:
    """Measure all engines that are installed; return their findings; write numbers and figure if none is missing."""
    engines = installed()
    points: list[dict[str, Any]] = []
    for name, case in cases().items():
        points += [
            {"case": name, "engine": "stylobate", "rtol": rtol, **measure(case, partial(case.stylobate, rtol))}
            for rtol in TOLERANCES
        ]
        points += [
            {"case": name, "engine": engine, "step": step, **measure(case, partial(set_up, case, step))}
            for engine, set_up in engines.items()
            for step in STEPS
        ]
    if len(engines) == len(ENGINES):
        lines = ",\n".join(json.dumps(point) for point in points)
        (FOLDER / "engines.json").write_text(f"[\n{lines}\n]\n", encoding="utf-8")
        draw(points)
    yield from compared(points)
    yield from settled(engines)


def compared(points: list[dict[str, Any]]) -> Iterator[Finding]:
    """Yield a finding for each case and engine, at the smallest step."""
    known = cases()
    exact = {point["case"]: point for point in points if point["engine"] == "stylobate"}  # the last, most accurate
    usual = {(point["case"], point["engine"]): point["error"] for point in points if point.get("step") == 1e-3}
    for point in points:
        if point.get("step") == min(STEPS):
            name, case = point["engine"], known[point["case"]]
            product, _, choice = name.partition(", ")
            ends = [math.degrees(one["end_tilt"]) for one in (point, exact[point["case"]])]
            yield Finding(
                source=f"{product} {version(ENGINES[name][0])}{choice and f', {choice}'}",
                compared=f"{case.title}: {case.compared}",
                theirs=point["value"],
                ours=case.exact,
                kind=Kind.CODE,
                remark=f"at the end tilted by {ends[0]:.2f}° of {ends[1]:.2f}°; "
                f"difference with steps of 1 ms {usual[point['case'], name]:.1e}",
            )


RESISTING = ("MuJoCo", "MuJoCo, default contact")
"""Engines whose rolling friction is a moment of one size in any direction, as that of `Rolling`."""


def settled(engines: dict[str, Callable[[Case, float], Run]]) -> Iterator[Finding]:
    """Yield a finding for each engine with the same law of rolling resistance, at the smallest step."""
    case = settling()
    for name in (name for name in RESISTING if name in engines):
        *_, usual, _, theirs = (case.measured(engines[name](case, step)()) for step in STEPS)
        product, _, choice = name.partition(", ")
        yield Finding(
            source=f"{product} {version(ENGINES[name][0])}{choice and f', {choice}'}",
            compared=f"{case.title}: {case.compared}",
            theirs=theirs,
            ours=case.exact,
            kind=Kind.CODE,
            remark=f"at the start {math.degrees(case.tilt):.2f}°; "
            f"difference with steps of 1 ms {abs(usual / case.exact - 1.0):.1e}",
        )


LOOKS = {
    "stylobate": (BLACK, "o", "-"),
    "Exudyn": (GREEN, "D", "-"),
    "Drake": (ORANGE, "^", "-"),
    "MuJoCo": (BLUE, "s", "-"),
    "MuJoCo, default contact": (BLUE, "s", ":"),
    "PyBullet": (VERMILION, "v", "-"),
    "PyBullet, default settings": (VERMILION, "v", ":"),
}
"""Colour, marker and line of each engine; open markers for default settings."""


@styled
def figure(points: list[dict[str, Any]]) -> Any:
    """Draw error against processor time, a panel for each case, a line for each engine."""
    drawn = new_figure(6.2)
    panels = drawn.subplots(2, 2, sharex=True, sharey=True)
    for axes, (name, case) in zip(panels.flat, cases().items(), strict=True):
        for engine, (color, marker, line) in LOOKS.items():
            own = [point for point in points if (point["case"], point["engine"]) == (name, engine)]
            axes.plot(
                [point["cost"] for point in own], [point["error"] for point in own], label=engine, linestyle=line,
                color=color, marker=marker, markersize=5, markerfacecolor="white" if line == ":" else color,
            )  # fmt: skip
        axes.axhline(Kind.CODE.value, color=GREY, linewidth=0.8)
        axes.set_title(f"{case.title}: {case.compared.partition(' [')[0]}")
        axes.set_xscale("log")
        axes.set_yscale("log")
    for axes in panels[1]:
        axes.set_xlabel("processor time per simulated second [s/s]")
    for axes in panels[:, 0]:
        axes.set_ylabel("relative error [1]")
    drawn.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return drawn


def draw(points: list[dict[str, Any]]) -> None:
    """Draw the figure of these numbers into the documentation."""
    figure(points).savefig(FOLDER / "engines.png", dpi=200)


if __name__ == "__main__":
    draw(json.loads((FOLDER / "engines.json").read_text("utf-8")))
