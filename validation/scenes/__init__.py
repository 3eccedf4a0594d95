"""Reference scenes: one code for tests, benchmarks and examples."""
