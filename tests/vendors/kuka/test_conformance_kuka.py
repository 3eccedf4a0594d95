from flyby.testing.conformance import VendorConformance


class TestKukaConformance(VendorConformance):
    name = "kuka"
