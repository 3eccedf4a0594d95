"""What an author of a vendor plugin tests with: Hypothesis strategies and a conformance suite.

from flyby.testing.conformance import VendorConformance

class TestAcme(VendorConformance):
    name = "acme"
"""

import pytest

pytest.register_assert_rewrite(f"{__name__}.conformance", f"{__name__}.checks")
