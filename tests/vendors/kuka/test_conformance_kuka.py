from flyby.testing.conformance import VendorConformance

from ..words import KukaWords


class TestKukaConformance(KukaWords, VendorConformance):
    pass
