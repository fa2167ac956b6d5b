"""Block by block the graph of a linkage gives what one dense decomposition of all rows gives."""

import sys

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, constraint_rows, mobility

TYPES = ("fixed", "revolute", "prismatic", "spherical", "bushing", "universal", "planar")


def random_linkage(seed: int, bodies: int = 8, joints: int = 12) -> tuple[Linkage, Placement]:
    """Bodies joined at random by random joints, some of them not to ground at all."""
    rng = np.random.default_rng(seed)
    nodes: dict[int, list[str]] = {b: [] for b in range(-1, bodies)}
    made: list[Joint] = []
    places: list[np.ndarray] = []
    for j in range(joints):
        a, b = rng.choice(np.arange(-1, bodies), 2, replace=False)
        for side, body in (("p", a), ("q", b)):
            nodes[int(body)].append(f"{side}{j}")
        # points and axes that often agree: special geometry comes up
        places += [rng.integers(-1, 2, 3).astype(float)] * 2
        kind = str(rng.choice(TYPES))
        springs = dict.fromkeys(("x", "y", "z"), 1e6) if kind == "bushing" else {}
        made.append(Joint(f"j{j}", kind, (f"p{j}", f"q{j}"), stiffness=springs))
    names = tuple(n for j in range(joints) for n in (f"p{j}", f"q{j}"))
    groups = tuple(
        Body(GROUND if b < 0 else f"b{b}", tuple(own)) for b, own in nodes.items() if own
    )
    frames = np.stack(
        [Rotation.from_rotvec(np.pi / 2 * rng.integers(0, 2, 3)).as_matrix() for _ in range(joints)]
    )
    return Linkage(names, groups, tuple(made)), Placement(np.array(places), frames, np.zeros(0))


@pytest.mark.parametrize("seed", range(25))
def test_blocks_agree_with_one_decomposition(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    linkage, placement = random_linkage(seed)
    dense = mobility(linkage, placement)
    # the package's function of the same name hides the module
    monkeypatch.setattr(sys.modules["strutwork.kinematics.mobility"], "LARGE", 0)
    blocks = mobility(linkage, placement)
    assert blocks.mobility == dense.mobility
    assert blocks.redundant == dense.redundant
    assert len(blocks.motions) == len(dense.motions)
    assert len(blocks.self_stress) == len(dense.self_stress)
    rows = constraint_rows(linkage, placement)
    matrix = rows.on_bodies()
    # every motion moves no row, and every state of self-stress leaves each body in balance
    for motion in blocks.motions:
        np.testing.assert_allclose(matrix @ motion.twists.ravel(), 0.0, atol=1e-9)
    label = {pair: i for i, pair in enumerate(_keys(rows.labels))}
    found = np.zeros((len(blocks.self_stress), len(rows)))
    for k, state in enumerate(blocks.self_stress):
        for key, value in state.forces.items():
            found[k, label[key]] = value
    np.testing.assert_allclose(found @ matrix, 0.0, atol=1e-7)
    assert np.linalg.matrix_rank(found, 1e-7) == len(found)


def _keys(labels: tuple[str, ...]) -> list[tuple[str, str]]:
    return [(text[: text.rindex(":")], text[text.rindex(":") + 1 :]) for text in labels]
