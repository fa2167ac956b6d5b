"""Where the statements on Kim et al. 2001 are tested, and why some are no predictions."""

from __future__ import annotations

TESTS = "tests/verification/kim_2001"
OURS = f"{TESTS}/test_published.py"
HERE = f"{TESTS}/test_statements.py"

#: Why what was fitted to other numbers is no prediction.
FITTED = "four dimensions were fitted to Table II and to the two singular tilts"
#: What has no number of ours.
UNDRAWN = f"{HERE}::test_every_result_is_there"
