"""A model written in another frame gives the same physics, through the file."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.machines.model_file import parse_model
from strutwork.reports.model_check import check_model
from strutwork.reports.model_solution import solve_model
from strutwork.units import LENGTH, quantity
from tests.model_files import Content, put, sample, toml

Array = NDArray[Any]

#: The sample with every direction said that would otherwise follow the global axes.
SAID = [
    put("beams.0.orientation", [0, 0, 1]),
    put("beams.1.orientation", [0, 1, 1]),
    put("beams.0.elements", 3),
    put("beams.0.offset_to", [0, 0, 0.01]),
    put("joints.0.second_axis", [1, 0, 0]),
    put("joints.1.axis", [0, 0, 1]),
    put("joints.1.second_axis", [1, 0, 0]),
    put("springs.0.stiffness", dict.fromkeys("xyz", 1e6)),
    put("supports.1.fixed", "all"),
    put("masses.0.inertia", [[1e-4, 0, 0], [0, 2e-4, 0], [0, 0, 3e-4]]),
    put("line_loads.0.force_to", [10, 20, -50]),
]

coordinate = st.floats(-2.0, 2.0)
turns = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)


def moved(turn: Array, shift: Array) -> Content:
    """The sample turned, then shifted."""

    def turned(vector: Any) -> list[float]:
        return [float(v) for v in turn @ np.asarray(vector, dtype=float)]

    content = sample(*SAID)
    for name, place in content["nodes"].items():
        at = turn @ np.array([quantity(v, LENGTH, name) for v in place]) + shift
        content["nodes"][name] = [float(v) for v in at]
    content["gravity"] = turned(content["gravity"])
    for beam in content["beams"]:
        beam["orientation"] = turned(beam["orientation"])
    content["beams"][0]["offset_to"] = turned([0, 0, 0.01])
    for joint in content["joints"]:
        joint["axis"], joint["second_axis"] = turned(joint["axis"]), turned(joint["second_axis"])
    inertia = np.asarray(content["masses"][0]["inertia"])
    content["masses"][0]["inertia"] = (turn @ inertia @ turn.T).tolist()
    content["loads"][0]["force"] = turned([100, 0, 0])
    content["line_loads"][0]["force"] = turned([0, 0, -100])
    content["line_loads"][0]["force_to"] = turned([10, 20, -50])
    sunk = dict(zip("xyz", turned([0, 0, -1e-3]), strict=True))
    content["settlements"][0]["displacement"] = sunk
    return content


def close(found: Any, expected: Any) -> None:
    expected = np.asarray(expected)
    # stiffnesses of 1e3 to 1e9 meet in one system; the rest is round-off
    assert np.asarray(found) == pytest.approx(expected, abs=1e-9 * max(abs(expected).max(), 1e-12))


REFERENCE = parse_model(toml(moved(np.eye(3), np.zeros(3))))
SOLVED = solve_model(REFERENCE)
CHECKED = check_model(REFERENCE)


@settings(max_examples=25)
@given(turns, st.tuples(coordinate, coordinate, coordinate))
def test_rotation_and_translation_change_nothing(
    quaternion: tuple[float, ...], shift: tuple[float, ...]
) -> None:
    turn = Rotation.from_quat(quaternion).as_matrix()
    model = parse_model(toml(moved(turn, np.array(shift))))
    six = np.kron(np.eye(2), turn)

    checked = check_model(model).to_dict()
    before = CHECKED.to_dict()
    for key in ("degrees_of_freedom", "mobility", "mobility_locked", "redundant_constraints"):
        assert checked[key] == before[key]
    close(checked["mass"]["total"], before["mass"]["total"])
    close(checked["mass"]["center"], turn @ np.array(before["mass"]["center"]) + shift)

    solution = solve_model(model)
    found, expected = solution.to_dict(), SOLVED.to_dict()
    close(found["tcp"]["compliance"], six @ np.array(expected["tcp"]["compliance"]) @ six.T)
    assert list(found["cases"]) == list(expected["cases"])
    for name, case in expected["cases"].items():
        other = found["cases"][name]
        for kind in ("displacements", "reactions", "spring_forces"):
            names = list(case[kind])
            close(
                [other[kind][n] for n in names],
                np.array([case[kind][n] for n in names]) @ six.T,
            )
        close(list(other["joint_forces"].values()), list(case["joint_forces"].values()))
        ends = [[list(b.values()) for b in c["beam_forces"].values()] for c in (other, case)]
        close(ends[0], ends[1])
        close(other["strain_energy"], case["strain_energy"])
