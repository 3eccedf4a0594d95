from flyby.testing.conformance import VendorConformance

from ..words import UrWords


class TestUrConformance(UrWords, VendorConformance):
    pass
