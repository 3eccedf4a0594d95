"""Proof that a driven program keeps a clearance between samples, and the certificate."""
