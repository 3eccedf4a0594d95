from flyby.testing.conformance import VendorConformance


class TestUrConformance(VendorConformance):
    name = "ur"
