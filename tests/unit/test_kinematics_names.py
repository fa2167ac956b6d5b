"""What `strutwork.kinematics` offers by name, and what its import does not yet read."""

from __future__ import annotations

import pkgutil
import subprocess
import sys

import pytest

from strutwork import kinematics
from strutwork.kinematics.motion import Motion


@pytest.mark.parametrize("name", kinematics.__all__)
def test_each_name_is_there_and_is_listed(name: str) -> None:
    assert getattr(kinematics, name) is not None
    assert name in dir(kinematics)


def test_names_that_are_read_later_are_public_and_no_file_takes_their_place() -> None:
    files = {found.name for found in pkgutil.iter_modules(kinematics.__path__)}
    later = set(kinematics._LATER)
    assert later <= set(kinematics.__all__)
    assert not later & files


def test_a_name_is_the_one_of_its_file() -> None:
    assert kinematics.Motion is Motion


def test_a_name_that_is_not_there_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Motoin'"):
        kinematics.Motoin  # noqa: B018


def test_the_import_reads_no_compiler_and_a_file_only_when_it_is_asked_for() -> None:
    program = (
        "import sys, strutwork.kinematics as k; name = 'strutwork.kinematics.motion'; "
        "print('numba' in sys.modules, name in sys.modules); k.Motion; print(name in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == ["False", "False", "True"]
