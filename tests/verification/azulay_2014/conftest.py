"""The paper's static comparison, made once for all tests of a worker."""

from __future__ import annotations

import pytest

from strutwork.papers.azulay_2014.comparison import AzulayComparison
from strutwork.papers.azulay_2014.machine_study import Comparison, study_comparison


@pytest.fixture(scope="session")
def study() -> Comparison:
    return study_comparison()


@pytest.fixture(scope="session")
def comparison(study: Comparison) -> AzulayComparison:
    return study.azulay
