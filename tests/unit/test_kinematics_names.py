"""What packages offer by name, and what the import of `strutwork.kinematics` does not yet read."""

from __future__ import annotations

import pkgutil
import subprocess
import sys
from types import ModuleType

import pytest

from strutwork import kinematics, msa, overconstraint
from strutwork.kinematics.motion import Motion

PACKAGES = (kinematics, msa, overconstraint)


@pytest.mark.parametrize(("package", "name"), [(p, name) for p in PACKAGES for name in p.__all__])
def test_each_name_is_there_and_is_listed(package: ModuleType, name: str) -> None:
    assert getattr(package, name) is not None
    assert name in dir(package)


@pytest.mark.parametrize("package", PACKAGES)
def test_names_that_are_read_later_are_public_and_of_no_other_file(package: ModuleType) -> None:
    files = {found.name for found in pkgutil.iter_modules(package.__path__)}
    assert set(package._LATER) <= set(package.__all__)
    assert {package._LATER[name] for name in package._LATER} <= files
    # Python puts a file that is read in the place of its name: only its own name may stand there
    assert all(file == name for name, file in package._LATER.items() if name in files)


@pytest.mark.parametrize("first", ["import strutwork.msa.solve", "from strutwork.msa import solve"])
def test_a_name_stands_in_the_place_of_its_file_whoever_reads_it_first(first: str) -> None:
    program = (
        f"{first}; import strutwork.msa as m; from strutwork.msa.solve import solve as own; "
        "from strutwork.msa import solve; print(m.solve is own, solve is own)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == ["True", "True"]


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
