"""The parts of the conformance suite, one subject each."""
