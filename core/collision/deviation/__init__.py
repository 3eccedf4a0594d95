"""How far motions leave their path at most: bounds that proofs rest on."""
