from flyby.testing.conformance import VendorConformance

from ..words import AbbWords


class TestAbbConformance(AbbWords, VendorConformance):
    pass
