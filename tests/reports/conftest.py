"""Reports written once, and one browser for all tests of a worker."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from strutwork.reports.build import WrittenReport
from tests.reports.browser import Browser, chromium
from tests.reports.shared import shared_report
from tests.sharing import folder_of

#: A structure with everything a page may stumble over: markup in names, a load case for each.
HOSTILE = """
title = "Arm </script><script>document.title='taken'</script> & <b>co</b>"
gravity = [0, 0, -9.80665]

[materials.steel]
youngs_modulus = "205 GPa"
poissons_ratio = 0.29
density = "7870 kg/m^3"

[sections.tube]
shape = "tube"
outer_diameter = "19 mm"
inner_diameter = "14 mm"

[nodes]
"<img src=x onerror=alert(1)>" = [0, 0, 0]
"B%{x}</script>" = ["200 mm", 0, 0]
C = ["200 mm", 0, 0]
TCP = ["300 mm", 0, "50 mm"]

[[beams]]
name = "<script>document.title='taken'</script>"
from = "<img src=x onerror=alert(1)>"
to = "B%{x}</script>"
material = "steel"
section = "tube"
elements = 3

[[beams]]
name = "tip"
from = "C"
to = "TCP"
material = "steel"
section = "tube"

[[joints]]
name = "<i>hinge</i>"
type = "revolute"
between = ["B%{x}</script>", "C"]
axis = [0, 1, 0]
driven = ["rz"]
stiffness = { rz = "1e4 N*m/rad" }

[[supports]]
node = "<img src=x onerror=alert(1)>"
fixed = "all"

[[loads]]
case = "</script><script>document.title='taken'</script>"
node = "TCP"
force = ["100 N", "-50 N", 0]

[tool]
tcp = "TCP"

[damping]
modal_ratio = 0.02
"""


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with chromium() as opened:
        yield opened


def shared(name: str, target: str, factory: pytest.TempPathFactory) -> WrittenReport:
    """The report of a target, written by whichever of the workers of a run asks first."""
    return shared_report(name, target, folder_of(factory.getbasetemp()))


@pytest.fixture(scope="session")
def machine_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    return shared("machine", "proposed-3pprs", tmp_path_factory)


@pytest.fixture(scope="session")
def comparison_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    return shared("comparison", "azulay-2014", tmp_path_factory)


@pytest.fixture(scope="session")
def prototype_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    return shared("prototype", "prototype-3ppprs", tmp_path_factory)


@pytest.fixture(scope="session")
def model_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    file = tmp_path_factory.mktemp("model") / "arm & <co>.toml"
    file.write_text(HOSTILE, encoding="utf-8")
    return shared("model", str(file), tmp_path_factory)


@pytest.fixture(scope="session")
def planar_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    return shared("planar", "mit-ss1", tmp_path_factory)


@pytest.fixture(scope="session")
def tolerance_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    example = Path(__file__).parents[2] / "examples" / "06_table_on_two_rails.toml"
    return shared("tolerance", str(example), tmp_path_factory)


@pytest.fixture(scope="session")
def hexapod_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    return shared("hexapod", "hexel-hexapod", tmp_path_factory)


@pytest.fixture(scope="session")
def document_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    return shared("document", "corbel-2008", tmp_path_factory)


@pytest.fixture(
    params=[
        *("machine", "comparison", "prototype", "model", "planar", "hexapod", "tolerance"),
        "document",
    ]
)
def any_report(request: pytest.FixtureRequest) -> WrittenReport:
    """Each kind of report in turn."""
    written: WrittenReport = request.getfixturevalue(f"{request.param}_report")
    return written


def text_of(path: Path) -> str:
    """A page's text; its hard spaces, which keep units with their numbers, as plain ones."""
    return path.read_text(encoding="utf-8").replace("\N{NO-BREAK SPACE}", " ")
