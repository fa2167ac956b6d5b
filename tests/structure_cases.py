"""A small library of structures: everything in it goes through every solver.

Each entry of `LIBRARY` makes an `Example` afresh.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from strutwork.kinematics import JOINT_TYPES
from strutwork.kinematics.coupling import Coupling
from strutwork.msa import LineLoad, LoadCase, PointMass, Spring, rod
from tests.structures import BAR, TUBE, Model, cantilever, every_direction, wrench

Array = NDArray[Any]

UP = np.array([0.0, 0.0, 1.0])
GRAVITY = LoadCase("gravity", gravity=(0.0, 1.0, -9.80665))
LOAD = (120.0, -80.0, -300.0, 4.0, -7.0, 5.0)


@dataclass(frozen=True)
class Example:
    """A structure with load cases.

    `held` says whether its tool resists all six wrenches, `loops` whether rigid bodies and
    joints alone close a loop, `length` compares moments with forces, m.
    """

    model: Model
    cases: tuple[LoadCase, ...]
    held: bool = True
    loops: bool = False
    length: float = 0.3


def plain_cantilever() -> Example:
    model = cantilever(elements=3)
    line = LoadCase("line", line_loads=(LineLoad("beam", (5, 100, -300), (20, -50, -700)),))
    return Example(model, (wrench("tip", "tip", *LOAD), line, GRAVITY))


def offset_bracket() -> Example:
    model = Model("tip")
    model.nodes(root=(0, 0, 0), knee=(0.3, 0.1, 0.2), tip=(0.3, 0.5, 0.3))
    arm, heel = (0.02, -0.01, 0.03), (-0.01, 0.02, 0.0)
    model.beam("arm", "root", "knee", BAR, offsets=(arm, heel), elements=2, orientation=(1, 1, 5))
    model.beam("fore", "knee", "tip", TUBE, offsets=((0.0, 0.0, -0.02), arm), shear=False)
    model.support("root")
    line = LoadCase("line", line_loads=(LineLoad("arm", (0, 10, -50), (0, 10, -90)),))
    return Example(model, (wrench("tip", "tip", *LOAD), line, GRAVITY))


def portal_frame() -> Example:
    model = Model("crown")
    model.nodes(a=(0, 0, 0), b=(0, 0, 1.1), crown=(0.7, 0.1, 1.4), c=(1.5, 0, 1.2), d=(1.5, 0, 0))
    model.beam("left", "a", "b", BAR, elements=2)
    model.beam("rafter1", "b", "crown", BAR)
    model.beam("rafter2", "crown", "c", BAR, elements=3)
    model.beam("right", "d", "c", TUBE)
    model.support("a")
    model.support("d", "x", "y", "z", "rx", "rz")
    snow = (0.0, 0.0, -400.0)
    line = LoadCase(
        "snow", line_loads=(LineLoad("rafter1", snow, snow), LineLoad("left", snow, (90, 0, 0)))
    )
    settle = LoadCase("settle", gaps={("support d", "z"): -2e-3, ("support a", "ry"): 1e-3})
    return Example(model, (wrench("crown", "crown", *LOAD), line, settle, GRAVITY), length=1.0)


def tripod_of_pinned_rods() -> Example:
    """Rods that spin freely, and a hub that no moment may load."""
    model = Model("hub")
    model.nodes(hub=(0.05, -0.02, 0.8))
    for i, angle in enumerate(np.radians([10.0, 120.0, 250.0])):
        foot, head = f"foot{i}", f"head{i}"
        model.ground(**{f"base{i}": (0.5 * np.cos(angle), 0.5 * np.sin(angle), 0)})
        model.joint(f"lower{i}", "spherical", (f"base{i}", foot))
        model.joint(f"upper{i}", "spherical", ("hub", head))
        model.beam(f"rod{i}", foot, head)
    misfit = LoadCase("long", gaps={("upper1", "z"): 1e-4})
    return Example(model, (wrench("force", "hub", 50.0, 20.0, -300.0), misfit), held=False)


def four_bar(flexible: bool) -> Example:
    """A planar four-bar in space: three constraints too many when its bars are rigid."""
    model = Model("tool")
    corners = np.array([[0, 0, 0], [0.1, 0, 0.3], [0.6, 0, 0.45], [0.5, 0, 0.0]])
    y = (0.0, 1.0, 0.0)
    model.ground(a0=corners[0], b3=corners[3])
    model.joint("R1", "revolute", ("a0", "b0"), y, driven=("rz",), stiffness={"rz": 8e3})
    for i in range(1, 4):
        model.nodes(**{f"a{i}": corners[i]})
        model.joint(f"R{i + 1}", "revolute", (f"a{i}", f"b{i}"), y)
    model.nodes(tool=(0.4, 0.05, 0.6))
    for i in range(3):
        if flexible:
            model.beam(f"bar{i}", f"b{i}", f"a{i + 1}", BAR)
        else:
            model.rigid(f"bar{i}", f"b{i}", f"a{i + 1}", *(["tool"] if i == 1 else []))
    if flexible:
        model.beam("post", "b1", "tool", BAR)
    cases = [wrench("push", "tool", *LOAD)]
    if flexible:
        cases += [GRAVITY, LoadCase("misfit", gaps={("R4", "rx"): 1e-3, ("R2", "z"): 1e-5})]
    else:
        # a shift of the whole plane of the loop and back is a misfit that can be met
        cases += [LoadCase("misfit", gaps={("R1", "z"): 1e-4, ("R4", "z"): -1e-4})]
    return Example(model, tuple(cases), loops=not flexible)


def bricard(flexible: bool) -> Example:
    """IFToMM benchmark A04: five rods of 1 m on the edges of a cube, six revolutes."""
    model = Model("a3")
    points = [(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)]
    axes = [(0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0)]
    model.ground(a0=points[0], b5=points[5])
    for i in range(1, 6):
        model.nodes(**{f"a{i}": points[i]})
    for i in range(6):
        drive: dict[str, Any] = {"driven": ("rz",), "stiffness": {"rz": 5e4}} if i == 0 else {}
        model.joint(f"R{i + 1}", "revolute", (f"a{i}", f"b{i}"), axes[i], **drive)
    for i in range(5):
        if flexible:
            model.beam(f"rod{i + 1}", f"b{i}", f"a{i + 1}", rod(0.05))
        else:
            model.rigid(f"rod{i + 1}", f"b{i}", f"a{i + 1}")
    return Example(model, (wrench("push", "a3", *LOAD),), loops=not flexible, length=1.0)


def stewart(
    lower: str = "universal", flexible: bool = True, poses: int = 7, drive: float = 3e7
) -> Example:
    """A hexapod at random poses; spherical joints at both ends let the struts spin."""
    rng = np.random.default_rng(6)
    model = Model("tool")
    turn = Rotation.from_rotvec(rng.uniform(-0.3, 0.3, (poses, 3)))
    shift = np.array([0.0, 0.0, 0.6]) + rng.uniform(-0.1, 0.1, (poses, 3))
    model.nodes(tool=shift)
    base = np.radians([-10, 10, 110, 130, 230, 250])
    plate = np.radians([-50, 50, 70, 170, 190, 290])
    for i in range(6):
        foot = 0.4 * np.array([np.cos(base[i]), np.sin(base[i]), 0.0])
        head = shift + turn.apply(0.2 * np.array([np.cos(plate[i]), np.sin(plate[i]), 0.1]))
        along = head - foot
        across = np.cross(along, (0.3, 1.0, 0.2))
        model.ground(**{f"base{i}": foot})
        model.nodes(**{f"plate{i}": head, f"slide{i}": (foot + head) / 2})
        model.joint(f"U{i}", lower, (f"base{i}", f"foot{i}"), across, np.cross(across, along))
        model.joint(
            f"P{i}",
            "prismatic",
            (f"slide{i}", f"rod{i}"),
            along,
            driven=("z",),
            stiffness={"z": drive},
        )
        model.joint(f"S{i}", "spherical", (f"head{i}", f"plate{i}"))
        tie: Callable[..., None] = partial(model.beam, elements=2) if flexible else model.rigid
        tie(f"cylinder{i}", f"foot{i}", f"slide{i}")
        tie(f"piston{i}", f"rod{i}", f"head{i}")
    model.rigid("platform", "tool", *(f"plate{i}" for i in range(6)))
    error = LoadCase("leg error", gaps={("P2", "z"): 3e-5})
    return Example(model, (wrench("push", "tool", *LOAD), error), loops=not flexible)


def three_legged_frame(poses: int = 5) -> Example:
    """Twenty beam elements, 84 free degrees of freedom, another geometry at every pose."""
    rng = np.random.default_rng(20)
    model = Model("tool")
    shift = rng.uniform(-0.08, 0.08, (poses, 3))
    model.nodes(tool=shift + 0.5 * UP, hub=shift + 0.8 * UP)
    for i, angle in enumerate(np.radians([90.0, 210.0, 330.0])):
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        foot, top = 0.6 * out, 0.2 * out + 0.8 * UP + shift
        model.nodes(**{f"foot{i}": foot, f"knee{i}": (foot + top) / 2 + 0.05 * out, f"top{i}": top})
        model.beam(f"shank{i}", f"foot{i}", f"knee{i}", elements=2)
        model.beam(f"thigh{i}", f"knee{i}", f"top{i}", elements=2)
        model.beam(f"spoke{i}", f"top{i}", "hub", BAR, orientation=(0.1, 0.2, 1.0))
        model.support(f"foot{i}")
    for i in range(3):
        model.beam(f"rim{i}", f"top{i}", f"top{(i + 1) % 3}", BAR)
    model.beam("spindle", "hub", "tool", rod(0.04))
    model.beam("brace", "knee0", "knee1")
    return Example(model, (wrench("cut", "tool", *LOAD), GRAVITY))


def serial_arm() -> Example:
    """An open chain of flexible links through joints of several kinds with drive stiffness."""
    rng = np.random.default_rng(3)
    model = Model("tool")
    model.ground(base=(0, 0, 0))
    points = rng.uniform(-0.3, 0.3, (4, 5, 3)) + np.arange(4)[:, None, None] * [0.3, 0.2, 0.4]
    kinds = [
        ("revolute", {"rz": 2e4, "x": 4e7}),
        ("prismatic", {"z": 5e6}),
        ("universal", {"rx": 3e3, "rz": 5e3}),
        ("cylindrical", {"z": 1e7, "rz": 4e3}),
    ]
    before = "base"
    for i, (kind, stiffness) in enumerate(kinds):
        axis = rng.normal(size=3)
        model.joint(f"J{i}", kind, (before, f"s{i}"), axis, stiffness=stiffness)
        before = f"e{i}" if i < 3 else "tool"
        model.nodes(**{before: points[i]})
        model.beam(f"link{i}", f"s{i}", before, BAR, orientation=f"J{i}", shear=bool(i % 2))
    model.masses.append(PointMass("tool", 3.0, offset=(0.0, 0.02, -0.1)))
    return Example(model, (wrench("push", "tool", *LOAD), GRAVITY))


def tripod_machine() -> Example:
    """Three legs on a rigid platform: locked drives, revolutes, elastic spherical joints."""
    rng = np.random.default_rng(9)
    model = Model("tool")
    shift = rng.uniform(-0.05, 0.05, (6, 3)) + 0.5 * UP
    model.nodes(tool=shift)
    soft = {"x": 8e7, "y": 8e7, "z": 2e8}
    for i, angle in enumerate(np.radians([0.0, 130.0, 235.0])):
        out, side = np.array([np.cos(angle), np.sin(angle), 0]), (-np.sin(angle), np.cos(angle), 0)
        foot, top = 0.5 * out, 0.15 * out + shift
        model.ground(**{f"base{i}": foot})
        model.nodes(**{f"plate{i}": top, f"mid{i}": (0.4 * foot + 0.6 * top)})
        model.joint(f"P{i}", "prismatic", (f"base{i}", f"slide{i}"), out, driven=("z",))
        model.joint(f"R{i}", "revolute", (f"mid{i}", f"swing{i}"), side)
        model.joint(f"S{i}", "spherical", (f"ball{i}", f"plate{i}"), top - foot, stiffness=soft)
        model.beam(f"lower{i}", f"slide{i}", f"mid{i}", BAR)
        model.beam(f"upper{i}", f"swing{i}", f"ball{i}", elements=2)
    model.rigid("platform", "tool", *(f"plate{i}" for i in range(3)))
    misfit = LoadCase("misfit", gaps={("S1", "x"): 2e-5, ("R0", "rx"): 1e-4, ("P2", "z"): 1e-4})
    return Example(model, (wrench("push", "tool", *LOAD), misfit, GRAVITY))


def plate_on_four(**legs: Any) -> Model:
    """A rigid square plate of side 1 m on four legs that resist z, held lightly in its plane."""
    model = Model("tool")
    corners = [(0.5, 0.5, 0.0), (-0.5, 0.5, 0.0), (-0.5, -0.5, 0.0), (0.5, -0.5, 0.0)]
    model.nodes(tool=(0, 0, 0))
    for i, corner in enumerate(corners):
        model.nodes(**{f"c{i}": corner})
        model.support(f"c{i}", **legs) if legs else model.support(f"c{i}", "z")
    model.rigid("plate", "tool", *(f"c{i}" for i in range(4)))
    model.springs.append(Spring("side", ("tool",), {"x": 1e6, "y": 1e6, "rz": 1e5}))
    return model


def elastic_table() -> Example:
    model = plate_on_four(stiffness={"z": 2e6})
    one = LoadCase("long leg", gaps={("support c0", "z"): 1e-3})
    return Example(model, (wrench("push", "tool", *LOAD), one), length=1.0)


def rigid_table() -> Example:
    """Four legs locked in z: one more than needed; the misfits of the case can be met."""
    model = plate_on_four()
    gaps = {(f"support c{i}", "z"): value for i, value in enumerate((3e-3, 1e-3, -2e-3, 0.0))}
    cases = (wrench("push", "tool", *LOAD), LoadCase("tilt", gaps=gaps))
    return Example(model, cases, loops=True, length=1.0)


def door_on_two_hinges() -> Example:
    """Two revolutes on one axis: five constraints too many on a rigid door."""
    model = Model("handle")
    model.ground(low=(0, 0, 0), high=(0, 0, 2))
    model.nodes(handle=(0.9, 0, 1))
    model.joint("lower", "revolute", ("low", "d0"))
    model.joint("upper", "revolute", ("high", "d1"), stiffness={"rz": 40.0})
    model.rigid("door", "d0", "d1", "handle")
    return Example(model, (wrench("push", "handle", *LOAD),), loops=True, length=1.0)


def block_on_bushings() -> Example:
    rng = np.random.default_rng(2)
    model = Model("tool")
    model.nodes(tool=(0.1, 0.2, 0.5), a=(0, 0, 0), b=(0.4, 0, 0.1), c=(0, 0.5, 0))
    for name in "abc":
        root = rng.normal(size=(6, 6)) * np.repeat([1e3, 50.0], 3)[:, None]
        matrix = tuple(tuple(row) for row in (root @ root.T).tolist())
        model.ground(**{f"{name}0": model.positions[name]})
        model.joint(f"B{name}", "bushing", (f"{name}0", name), rng.normal(size=3), matrix=matrix)
    model.rigid("block", "tool", "a", "b", "c")
    gap = LoadCase("gap", gaps={("Ba", "x"): 1e-4, ("Ba", "rx"): 1e-3})
    return Example(model, (wrench("push", "tool", *LOAD), gap))


def floating_frame() -> Example:
    """No support at all, and loads in balance."""
    model = Model("p")
    model.nodes(p=(0, 0, 0), q=(0.5, 0, 0), r=(0.5, 0.4, 0.1))
    model.beam("pq", "p", "q", BAR)
    model.beam("qr", "q", "r")
    model.beam("rp", "r", "p", elements=2)
    force, at = np.array([30.0, -50.0, 10.0]), np.array([0.5, 0.4, 0.1])
    back = (*(-force).tolist(), *(-np.cross(at, force)).tolist())
    case = LoadCase("pinch", (("r", (*force.tolist(), 0.0, 0.0, 0.0)), ("p", back)))
    return Example(model, (case,), held=False)


def beam_on_springs() -> Example:
    model = Model("n2")
    bed = {"x": 2e5, "y": 7e5, "z": 3e6, "rx": 50.0}
    for i in range(5):
        model.nodes(**{f"n{i}": (0.3 * i, 0, 0)})
        model.springs.append(Spring(f"bed{i}", (f"n{i}",), bed))
        if i:
            model.beam(f"span{i}", f"n{i - 1}", f"n{i}", BAR)
    model.nodes(anvil=(0.6, 0, 0.0), corner=(0.7, 0.1, 0))
    model.rigid("anvil", "anvil", "corner")
    model.springs.append(Spring("mount", ("n2", "anvil"), every_direction(4e5)))
    return Example(model, (wrench("mid", "n2", *LOAD), wrench("anvil", "corner", *LOAD)))


def two_rods(kind: str) -> Example:
    """Two cantilevers whose tips a joint of the kind joins."""
    model = Model("t1")
    model.nodes(r1=(0, 0, 0), t1=(0.5, 0.1, 0), r2=(0.4, 0.7, 0.2))
    options: dict[str, Any] = {"stiffness": {"y": 1e6, "rz": 400.0}} if kind == "bushing" else {}
    if kind == "helical":
        # steep, so that what the row does about the axis counts
        options = {"pitch": 0.25}
    model.joint("J", kind, ("t1", "t2"), (0.2, -0.3, 1.0), (1.0, 0.4, 0.0), **options)
    model.beam("first", "r1", "t1", BAR)
    model.beam("second", "r2", "t2", TUBE)
    model.support("r1")
    model.support("r2")
    case = wrench("push", "t1", *LOAD)
    locked = {*JOINT_TYPES[kind], *options.get("stiffness", {})}
    gaps: dict[tuple[str, str], float] = {("J", d): 1e-4 for d in sorted(locked)}
    return Example(model, (case, LoadCase("gap", gaps=gaps)))


def geared_arms() -> Example:
    """Two arms on hinges that gears and a rack tie to a slide, whose spring holds them all."""
    model = Model("t1")
    model.nodes(
        r1=(0, 0, 0), t1=(0.5, 0.1, 0), r2=(0, 0.4, 0.1), t2=(0.4, 0.5, 0.2), r3=(0.2, 0, 0.5)
    )
    model.nodes(t3=(0.2, 0, 0.5), end=(0.2, 0.1, 0.8))
    model.joint("first", "revolute", ("r1", "a1"), (0.2, -0.3, 1.0))
    model.joint("second", "revolute", ("r2", "a2"), (0.1, 0.2, 1.0))
    model.joint("slide", "prismatic", ("r3", "t3"), (0.0, 0.3, 1.0))
    model.beam("one", "a1", "t1", BAR)
    model.beam("two", "a2", "t2", TUBE)
    model.beam("three", "t3", "end", BAR)
    for node in ("r1", "r2", "r3"):
        model.support(node)
    model.springs.append(Spring("stop", ("end",), {"x": 3e4, "y": 3e4, "z": 3e4}))
    model.couplings = (
        Coupling("gears", ("first", "rz"), ("second", "rz"), -1.7),
        Coupling("rack", ("second", "rz"), ("slide", "z"), 0.11),
    )
    gaps = {("second", "rz"): 2e-3, ("slide", "z"): -1e-4, ("first", "x"): 1e-4}
    return Example(model, (wrench("push", "t1", *LOAD), LoadCase("gap", gaps=gaps)), loops=True)


LIBRARY: dict[str, Callable[[], Example]] = {
    "cantilever": plain_cantilever,
    "offset bracket": offset_bracket,
    "portal frame": portal_frame,
    "tripod of pinned rods": tripod_of_pinned_rods,
    "four-bar, flexible": partial(four_bar, True),
    "four-bar, rigid": partial(four_bar, False),
    "Bricard, flexible": partial(bricard, True),
    "Bricard, rigid": partial(bricard, False),
    "hexapod": stewart,
    "hexapod, spinning struts": partial(stewart, "spherical"),
    "hexapod, rigid struts": partial(stewart, "universal", False),
    "hexapod, rigid spinning struts": partial(stewart, "spherical", False),
    "three-legged frame": three_legged_frame,
    "serial arm": serial_arm,
    "tripod machine": tripod_machine,
    "elastic table": elastic_table,
    "rigid table": rigid_table,
    "door on two hinges": door_on_two_hinges,
    "block on bushings": block_on_bushings,
    "floating frame": floating_frame,
    "beam on springs": beam_on_springs,
    "geared arms": geared_arms,
    **{f"two rods, {kind}": partial(two_rods, kind) for kind in JOINT_TYPES if kind != "support"},
}


def by_length(six: ArrayLike, length: float) -> Array:
    """Six-vectors (..., 6, m) of displacement with rotations times `length`."""
    scale: Array = np.repeat([1.0, length], 3)[:, None]
    return np.asarray(np.asarray(six) * scale)
