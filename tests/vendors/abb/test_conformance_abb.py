from flyby.testing.conformance import VendorConformance


class TestAbbConformance(VendorConformance):
    name = "abb"
