"""`strutwork tolerance`: what it prints, writes and refuses."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from strutwork.machines.model_file import read_model
from strutwork.overconstraint import tolerance_responses, worst_case
from strutwork.studies import read_netcdf
from tests.cli.conftest import Program
from tests.model_files import Content, Edit, add, sample

ROOT = Path(__file__).parents[2]
RAILS = ROOT / "examples" / "06_table_on_two_rails.toml"
QUICK = ("--samples", "0", "--json")

Write = Callable[[Content], Path]


def by_name(found: dict[str, Any]) -> dict[str, Any]:
    return {quantity["name"]: quantity for quantity in found["quantities"]}


def tolerance(**keys: Any) -> Edit:
    return add("tolerances", {"name": "bore", "joint": "mount", **keys})


#: A square plate on four springs of k = 50 N/µm; leg i may be long or short by 0.1 mm.
K, DELTA = 50e6, 1e-4
CORNERS = ((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5))


def plate(**limit: Any) -> Content:
    nodes = {f"foot{i}": [x, y, 0] for i, (x, y) in enumerate(CORNERS)}
    nodes |= {f"seat{i}": [x, y, 0] for i, (x, y) in enumerate(CORNERS)}
    nodes["middle"] = [0, 0, 0]
    content: Content = {
        "nodes": nodes,
        "bodies": [
            {"name": "floor", "nodes": [f"foot{i}" for i in range(4)]},
            {"name": "plate", "nodes": [*(f"seat{i}" for i in range(4)), "middle"]},
        ],
        "supports": [{"node": "foot0", "fixed": "all"}],
        "joints": [
            {
                "name": f"leg{i}",
                "type": "bushing",
                "between": [f"foot{i}", f"seat{i}"],
                "stiffness": {"x": K, "y": K, "z": K},
            }
            for i in range(4)
        ],
        "tolerances": [
            {"name": f"length {i}", "kind": "length", "joint": f"leg{i}", "size": DELTA}
            for i in range(4)
        ],
        "tool": {"tcp": "middle"},
    }
    if limit:
        content["force_limits"] = [{"joints": [f"leg{i}" for i in range(4)], **limit}]
    return content


def test_a_plate_on_four_legs_meets_its_closed_form(strutwork: Program, write: Write) -> None:
    """One leg too long by δ presses with kδ/4; at worst all four work against one another."""
    found = strutwork("tolerance", write(plate(axial_force="4 kN")), "--json").result
    leg = by_name(found)["leg0 axial force"]
    assert leg["worst"] == pytest.approx(K * DELTA, rel=1e-9)
    assert leg["limit"] == 4000.0
    assert leg["utilisation"] == pytest.approx(1.25, rel=1e-9)
    assert leg["shares"] == pytest.approx({f"length {i}": 0.25 for i in range(4)}, abs=1e-9)
    signs = [leg["misfits"][f"leg{i}"]["z"] / DELTA for i in range(4)]
    assert [signs[0] * s for s in signs] == pytest.approx([1, -1, 1, -1], abs=1e-12)
    assert found["within_limits"] is False
    # the middle follows the mean of the legs: all long at once
    tool = by_name(found)["tool displacement in z"]
    assert tool["worst"] == pytest.approx(DELTA, rel=1e-9)
    assert found["tool_deviation"] is not None
    # 3 in the plane (4 legs in x and y, 3 freedoms: 5) and 1 of the heights
    assert found["self_stress_states"] == 6


def test_one_length_locks_in_what_solve_says_of_its_misfit(
    strutwork: Program, write: Write
) -> None:
    """The same misfit as a load case: forces of the saddle-point system, no tolerance in sight."""
    edits = [
        tolerance(kind="length", axis=[1, 0, 0], size="10 um"),
        add("misfits", {"case": "long", "joint": "mount", "gap": {"x": "10 um"}}),
    ]
    path = write(sample(*edits))
    solved = strutwork("solve", path, "--json").result["cases"]["long"]
    quantities = by_name(strutwork("tolerance", path, *QUICK).result)
    for joint in ("hinge", "mount"):
        x, y, z, rx, ry, rz = solved["joint_forces"][joint]
        expected = {
            "radial force": (x * x + y * y) ** 0.5,
            "axial force": abs(z),
            "bending moment": (rx * rx + ry * ry) ** 0.5,
            "torque": abs(rz),
        }
        for kind, value in expected.items():
            name = f"{joint} {kind}"
            if name in quantities:
                # forces beside some newtons of round-off of stiffnesses of 1e9
                assert quantities[name]["worst"] == pytest.approx(value, rel=1e-7, abs=1e-6)
    x, y, z, *_ = solved["displacements"]["TCP"]
    found = [quantities[f"tool displacement in {d}"]["worst"] for d in "xyz"]
    assert found == pytest.approx([abs(x), abs(y), abs(z)], rel=1e-7, abs=1e-14)


def test_a_support_may_be_out_of_place(strutwork: Program, write: Write) -> None:
    edits = [
        tolerance(kind="length", joint="support G", axis=[1, 0, 0], size="10 um"),
        add("settlements", {"case": "sunk", "node": "G", "displacement": {"x": "10 um"}}),
    ]
    path = write(sample(*edits))
    solved = strutwork("solve", path, "--json").result["cases"]["sunk"]
    quantities = by_name(strutwork("tolerance", path, *QUICK).result)
    x, y, *_ = solved["joint_forces"]["mount"]
    force = (x * x + y * y) ** 0.5
    assert force > 1.0
    assert quantities["mount radial force"]["worst"] == pytest.approx(force, rel=1e-7)


@pytest.mark.filterwarnings("ignore:nodes foot3:machines.model.ModelWarning")
def test_what_is_held_just_once_moves_without_force(strutwork: Program, write: Write) -> None:
    """Three legs, 3 + 2 + 1 directions: a misfit moves the plate and presses nowhere."""
    content = plate(axial_force="1 kN")
    content["joints"] = content["joints"][:3]
    for joint, held in zip(content["joints"], ("xyz", "yz", "z"), strict=True):
        joint["stiffness"] = dict.fromkeys(held, K)
    del content["tolerances"][3]
    content["force_limits"][0]["joints"] = ["leg0", "leg1", "leg2"]
    found = strutwork("tolerance", write(content), *QUICK).result
    assert found["self_stress_states"] == 0
    forces = [q["worst"] for q in found["quantities"] if q["joint"] is not None]
    assert forces == [0.0] * len(forces)
    # the middle between legs 0 and 2, whose lengths it follows
    tool = by_name(found)["tool displacement in z"]
    assert tool["worst"] == pytest.approx(DELTA, rel=1e-9)
    printed = strutwork("tolerance", write(content), "--samples", "100")
    assert "no misfit causes a force" in printed.out
    refused = strutwork("tolerance", write(content), *QUICK, "--allocate", "uniform")
    assert (refused.status, refused.out) == (1, "")
    assert "no tolerance that may change reaches a limited quantity" in refused.err


def test_a_file_without_a_tool(strutwork: Program, write: Write) -> None:
    content = plate()
    del content["tool"]
    found = strutwork("tolerance", write(content), *QUICK).result
    assert found["tool_deviation"] is None
    assert {q["unit"] for q in found["quantities"]} == {"N"}
    assert by_name(found)["leg3 axial force"]["worst"] == pytest.approx(K * DELTA, rel=1e-9)


def test_quantiles_lie_below_the_worst_case_and_follow_the_seed(
    strutwork: Program, write: Write
) -> None:
    path = write(plate(axial_force="4 kN"))
    runs = [
        strutwork("tolerance", path, "--samples", "20000", "--seed", seed, "--json").result
        for seed in ("1", "1", "2")
    ]
    first, again, other = (by_name(run)["leg0 axial force"] for run in runs)
    assert first == again
    assert first["quantiles"] != other["quantiles"]
    values = [first["quantiles"][s]["value"] for s in ("0.5", "0.9", "0.95", "0.99", "0.999")]
    assert values == sorted(values)
    assert values[-1] < first["worst"]
    for quantile in first["quantiles"].values():
        assert quantile["low"] <= quantile["value"] <= quantile["high"]
    # four uniforms on ±kδ/4: P(|F| < x) known from Irwin and Hall; half lie below 0.2844
    assert values[0] / first["worst"] == pytest.approx(IRWIN_HALL_MEDIAN, abs=0.01)
    assert runs[0]["distribution"]["samples"] == 20000
    assert 0 < runs[0]["distribution"]["utilisation"]["0.99"] < 1.25


def _irwin_hall_median() -> float:
    """Median of |u₁+u₂+u₃+u₄|/4, u uniform on [−1, 1]: bisection on the known distribution."""

    def below(x: float) -> float:
        # the sum of four uniforms on [0, 1] at 2 + 2x, Irwin and Hall
        s = 2 + 2 * x
        terms = (1, -4, 6, -4)
        return sum(c * max(s - i, 0.0) ** 4 for i, c in enumerate(terms)) / 24

    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if 2 * below(middle) - 1 < 0.5 else (low, middle)
    return low


IRWIN_HALL_MEDIAN = _irwin_hall_median()


def test_uniform_allocation_scales_to_the_limit(strutwork: Program, write: Write) -> None:
    path = write(plate(axial_force="4 kN"))
    found = strutwork("tolerance", path, *QUICK, "--allocate", "uniform").result
    sizes = found["allocation"]["sizes"]
    assert sizes == pytest.approx({f"length {i}": 0.8 * DELTA for i in range(4)}, rel=1e-6)


def test_limits_from_the_command_line(strutwork: Program, write: Write) -> None:
    path = write(plate())
    assert strutwork("tolerance", path, *QUICK).result["within_limits"] is None
    found = strutwork(
        "tolerance", path, *QUICK, "--limit", "axial_force=6kN", "--limit", "leg2:axial_force=1e4"
    ).result
    limits = [by_name(found)[f"leg{i} axial force"]["limit"] for i in range(4)]
    assert limits == [6000.0, 6000.0, 10000.0, 6000.0]
    assert found["within_limits"] is True


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("axial=3", ["axial=3", "radial_force"]),
        ("axial_force", ["axial_force", "KIND=VALUE"]),
        ("axial_force=0", ["not positive"]),
        ("axial_force=3 mm", ["a length", "a force"]),
        ("Q:axial_force=3", ["a joint Q", "leg0"]),
        ("torque=3", ["finds no torque"]),
    ],
)
def test_a_limit_that_is_none(
    text: str, expected: list[str], strutwork: Program, write: Write
) -> None:
    run = strutwork("tolerance", write(plate()), *QUICK, "--limit", text)
    assert (run.status, run.out) == (1, "")
    assert [part for part in expected if part not in run.err] == [], run.err


def test_the_example_is_that_of_the_library(strutwork: Program) -> None:
    found = strutwork("tolerance", RAILS, *QUICK).result
    model = read_model(RAILS)
    worst = worst_case(tolerance_responses(model.placed, model.tolerances))
    names = [q.name for q in worst.responses.quantities]
    assert {n: q["worst"] for n, q in by_name(found).items()} == pytest.approx(
        dict(zip(names, worst.value.tolist(), strict=True)), rel=1e-12
    )
    assert found["self_stress_states"] == 3
    # the screw is needed once: nothing loads it
    assert by_name(found)["screw axial force"]["worst"] == 0.0
    assert by_name(found)["screw axial force"]["contributor"] is None
    assert by_name(found)["block A2 radial force"]["contributor"] == "parallelism of rail B"
    assert found["distribution"] is None


@pytest.mark.parametrize("objective", ["uniform", "cost"])
def test_allocated_tolerances_keep_the_limits(
    objective: str, strutwork: Program, tmp_path: Path
) -> None:
    found = strutwork("tolerance", RAILS, *QUICK, "--allocate", objective).result
    sizes = found["allocation"]["sizes"]
    text = RAILS.read_text(encoding="utf-8")
    for name, old in (
        ("parallelism of rail B", '"20 um"'),
        ("position of rail B", '"30 um"'),
        ("flatness of the seats", '"10 um"'),
    ):
        text = text.replace(f"size = {old}", f"size = {sizes[name]!r}")
    path = tmp_path / "allocated.toml"
    path.write_text(text, encoding="utf-8")
    again = strutwork("tolerance", path, *QUICK).result
    used = [q["utilisation"] for q in again["quantities"] if q["utilisation"] is not None]
    assert max(used) == pytest.approx(1.0, abs=1e-6)


def test_tables_for_people(strutwork: Program) -> None:
    run = strutwork("tolerance", RAILS, "--samples", "5000", "--allocate", "cost")
    assert run.status == 0, run.err
    for words in (
        "3 tolerances, 3 states of self-stress",
        "Largest forces",
        "Columns 95 % and 99 %",
        "A limit can be exceeded",
        "Displacements by the locked-in misfits",
        "displacement, any direction",
        "Tolerances that meet the limits",
    ):
        assert words in run.out
    assert run.err == ""


def test_files_hold_the_same_numbers(strutwork: Program, tmp_path: Path) -> None:
    found = strutwork("tolerance", RAILS, *QUICK, "-o", tmp_path).result
    netcdf, table = (Path(path) for path in found["data"])
    dataset = read_netcdf(netcdf)
    worst = dict(
        zip(dataset["quantity"].to_numpy(), dataset["worst"].to_numpy()[0].tolist(), strict=True)
    )
    assert worst == pytest.approx({n: q["worst"] for n, q in by_name(found).items()}, rel=1e-12)
    with table.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["quantity"] for row in rows] == list(by_name(found))
    assert {r["quantity"]: float(r["worst"]) for r in rows} == pytest.approx(worst, rel=1e-12)
    assert {row["unit"] for row in rows} == {"N", "m", "rad"}


@pytest.mark.filterwarnings("always::strutwork.overconstraint.sources.ToleranceWarning")
def test_a_free_direction_is_a_warning_with_the_joint(strutwork: Program, write: Write) -> None:
    edit = tolerance(kind="parallelism", slope="1 mrad", datum="D", axis=[0, 0, 1])
    run = strutwork("tolerance", write(sample(edit)), *QUICK)
    assert run.err.startswith("Warning: tolerance bore: joint mount is free")
    assert all(q["worst"] == 0.0 for q in run.result["quantities"])


BAD: dict[str, tuple[Edit, list[str]]] = {
    "negative size": (tolerance(kind="position", size="-3 um"), ["tolerances.bore.size", "-3 um"]),
    "size of zero": (tolerance(kind="position", size=0), ["tolerances.bore.size", "above 0"]),
    "unknown datum": (
        tolerance(kind="position", size=1e-5, datum="Q"),
        ["tolerance bore", 'unknown datum "Q"', "A, B, C"],
    ),
    "datum on another body": (
        tolerance(kind="position", size=1e-5, datum="A"),
        ["tolerance bore", '"A"', "mount", "Choose a node of one of the joint's bodies"],
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_tolerances(name: str, strutwork: Program, write: Write) -> None:
    edit, expected = BAD[name]
    run = strutwork("tolerance", write(sample(edit)), *QUICK)
    assert (run.status, run.out) == (1, "")
    assert run.err.startswith("Error: ")
    assert [part for part in expected if part not in run.err] == [], run.err


def test_a_rigid_loop_is_named(strutwork: Program, write: Write) -> None:
    content = plate()
    for joint in content["joints"]:
        del joint["stiffness"]
        joint["type"] = "spherical"
    run = strutwork("tolerance", write(content), *QUICK)
    assert (run.status, run.out) == (1, "")
    assert "rigid loop" in run.err
    assert "leg0, leg1, leg2, leg3" in run.err


def test_no_tolerances_and_no_limits(strutwork: Program, write: Write) -> None:
    run = strutwork("tolerance", write(sample()), *QUICK)
    assert (run.status, run.out) == (1, "")
    assert "[[tolerances]]" in run.err
    run = strutwork("tolerance", write(plate()), *QUICK, "--allocate", "uniform")
    assert (run.status, run.out) == (1, "")
    assert "[[force_limits]]" in run.err


def test_limits_that_no_tolerance_can_meet(strutwork: Program, write: Write) -> None:
    content = plate(axial_force="1 kN")
    # bored 0.2 mm too deep on the whole: the middle of the zone alone presses with 2.5 kN
    content["tolerances"][0] = {
        "name": "length 0",
        "kind": "length",
        "joint": "leg0",
        "limits": ["190 um", "210 um"],
    }
    run = strutwork("tolerance", write(content), *QUICK, "--allocate", "uniform")
    assert (run.status, run.out) == (1, "")
    assert "leg" in run.err
    assert "1000" in run.err
    assert "2500" in run.err
