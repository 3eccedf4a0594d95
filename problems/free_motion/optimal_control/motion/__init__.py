"""A motion as polynomials: grid, first guess, audit, proof, result."""
