"""The paper's static comparison, made once for all tests."""

from __future__ import annotations

import pytest

from strutwork.papers.azulay_2014.comparison import AzulayComparison
from strutwork.papers.azulay_2014.machine_study import Comparison, study_comparison
from tests.sharing import folder_of, once


@pytest.fixture(scope="session")
def study(tmp_path_factory: pytest.TempPathFactory) -> Comparison:
    folder = folder_of(tmp_path_factory.getbasetemp())
    return once("azulay-comparison", folder, study_comparison)


@pytest.fixture(scope="session")
def comparison(study: Comparison) -> AzulayComparison:
    return study.azulay
