"""What was given and assumed: generated from the model, for files and machines in Python."""

from __future__ import annotations

from pathlib import Path

import pytest

from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.reports.alike import DIFFERS, grouped, label
from strutwork.reports.chapters import inputs
from strutwork.reports.content import Chapter, Points, Table, Text
from strutwork.reports.subject import Subject

EXAMPLES = Path(__file__).parents[2] / "examples"


def chapter(target: str) -> tuple[Model, Chapter]:
    model = load(EXAMPLES / target if target.endswith(".toml") else target)
    file = EXAMPLES / target if target.endswith(".toml") else None
    return model, inputs.write(Subject(model, target, target, file=file))


def tables(found: Chapter) -> dict[str, Table]:
    return {block.data: block for block in found.blocks if isinstance(block, Table)}


def words(found: Chapter) -> str:
    points = [p for block in found.blocks if isinstance(block, Points) for p in block.items]
    texts = [block.text for block in found.blocks if isinstance(block, Text)]
    return " ".join([*texts, *points])


@pytest.mark.parametrize(
    "target",
    [
        "machines/6-ups.toml",
        "machines/gantry.toml",
        "06_table_on_two_rails.toml",
        "09_flexure_stage.toml",
        "10_screws_and_belt.toml",
        "mit-ss1",
        "proposed-3pprs",
        "biglide",
    ],
)
def test_every_part_of_the_model_is_in_the_files(target: str, tmp_path: Path) -> None:
    model, found = chapter(target)
    written = {}
    for file in found.files:
        file.write(tmp_path / file.name)
        lines = (tmp_path / file.name).read_text(encoding="utf-8").splitlines()
        written[file.name] = [line.split(",")[0].strip('"') for line in lines[1:]]
    structure = model.structure
    held = set(model.supports.values())
    for name, parts in (
        ("inputs-beams.csv", [b.name for b in structure.beams]),
        ("inputs-springs.csv", [s.name for s in structure.springs]),
        ("inputs-tolerances.csv", [t.name for t in model.tolerances]),
        ("inputs-nodes.csv", list(structure.linkage.nodes)),
        ("inputs-flexures.csv", list(model.flexures)),
    ):
        assert written.get(name, []) == parts, name
    joints = written.get("inputs-joints.csv", [])
    assert len(joints) == len(structure.linkage.joints)
    assert [j.name for j in structure.linkage.joints if j.name not in held] == [
        n for n in joints if not n.startswith("support of ")
    ]
    assert len(written.get("inputs-masses.csv", [])) == len(structure.masses)
    # each table leads to its file
    assert set(tables(found)) <= set(written)


def test_a_hexapod_is_given_in_few_rows() -> None:
    _, found = chapter("machines/6-ups.toml")
    shown = tables(found)
    joints = shown["inputs-joints.csv"].cells
    assert [row[0].text for row in joints] == [
        "cardan1 to cardan6 (6)",
        "drive1 to drive6 (6)",
        "ball1 to ball6 (6)",
        "support of base1 to support of base6 (6)",
    ]
    drive = [cell.text for cell in joints[1]]
    assert "z 200" in drive
    assert "z 750 to 1100" in drive
    section = [cell.text for cell in shown["inputs-sections.csv"].cells[0]]
    assert section[:3] == ["cylinder", "tube", "outer diameter 90, inner diameter 66"]
    assert "Every mode is damped by the viscous ratio 0.02." in words(found)
    assert "6-ups.toml has " in words(found)


def test_a_solid_says_to_which_frequency_it_holds() -> None:
    model, found = chapter("08_column_on_mounts.toml")
    (solid,) = model.solids
    row = tables(found)["inputs-solids.csv"].cells[0]
    assert row[1].text == "granite"
    assert float(row[-1].text) == pytest.approx(solid.accurate_to, rel=1e-2)
    # its material has a row of its own, though no beam is made of it
    assert "granite" in [r[0].text for r in tables(found)["inputs-materials.csv"].cells]


def test_what_the_model_leaves_out_is_assumed() -> None:
    _, found = chapter("03_tripod.toml")
    said = words(found)
    assert "No weight acts: gravity is not given." in said
    assert "drive1:z, drive2:z, drive3:z can move without limit" in said
    _, bridge = chapter("mit-ss1")
    assert "hold their driven direction rigidly" in words(bridge)


def test_another_input_has_another_hash() -> None:
    _, one = chapter("proposed-3pprs")
    _, again = chapter("proposed-3pprs")
    _, other = chapter("eclipse-3pprs")
    hashes = [
        next(b.text for b in c.blocks if isinstance(b, Text) and "SHA-256" in b.text)
        for c in (one, again, other)
    ]
    assert hashes[0] == hashes[1] != hashes[2]


def test_rows_alike_stand_as_one() -> None:
    rows = {f"rod {k}": ["steel", str(k)] for k in range(1, 5)} | {"rod 5": ["brass", "5"]}
    found = grouped(rows, loose=(1,))
    assert [(g.label, g.cells) for g in found] == [
        ("rod 1 to rod 4 (4)", ("steel", DIFFERS)),
        ("rod 5", ("brass", "5")),
    ]
    assert label(["a", "b"]) == "a, b"
