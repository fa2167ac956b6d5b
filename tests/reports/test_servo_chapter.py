"""The chapter on the drives' controllers: what it says, and of an unstable loop."""

from __future__ import annotations

from strutwork.machines.model_file import parse_model
from strutwork.reports.chapters import servo
from strutwork.reports.content import Figure, Table, Text
from strutwork.reports.subject import Subject
from tests.cli.test_servo import SCREW
from tests.drives import SLIDE, SPRING


def subject(more: str = SCREW, *, elastic: bool = True) -> Subject:
    lines = f"stiffness = {{ z = {SPRING} }}" if elastic else ""
    return Subject(parse_model(SLIDE.format(elastic=lines, more=more)), "slide", "slide")


def test_tables_figure_and_files_of_a_stable_loop() -> None:
    asked = subject()
    assert servo.missing(asked) == ""
    chapter = servo.write(asked)
    tables = [block for block in chapter.blocks if isinstance(block, Table)]
    assert [table.data for table in tables] == [
        *("drives-servo-response.csv", "drives-servo-margins.csv", "drives-servo-poles.csv")
    ]
    assert {file.name for file in chapter.files} == {table.data for table in tables}
    (figure,) = (block for block in chapter.blocks if isinstance(block, Figure))
    assert len(figure.spec["data"]) == 4
    assert "drives controlled" in chapter.answer
    assert "with the drives locked 0.400 N/µm" in chapter.answer


def test_an_unstable_loop_has_no_stiffness() -> None:
    chapter = servo.write(subject(SCREW.replace('integral_time = "20 ms"', 'delay = "20 ms"')))
    assert "unstable" in chapter.answer
    assert any(isinstance(b, Text) and "Lower the gains" in b.text for b in chapter.blocks)
    table = next(block for block in chapter.blocks if isinstance(block, Table))
    assert "unstable" in table.rows[0]


def test_a_rigid_machine_and_what_is_missing() -> None:
    table = next(b for b in servo.write(subject(elastic=False)).blocks if isinstance(b, Table))
    assert "rigid" in table.rows[0]
    head = SCREW[: SCREW.index("[[servos]]")]
    assert "[[servos]]" in servo.missing(subject(head))
    assert "damping" in servo.missing(subject(SCREW[len(head) :]))
    without = SCREW.replace('motor_inertia = "3 kg*cm^2"\n', "")
    assert "cannot be closed" in servo.missing(subject(without))
