"""What tests and benchmarks hold the package against; no part of the wheel."""
