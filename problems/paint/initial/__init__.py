"""First curves for the paint gun, by section IV of D. Gleeson et al. 2022."""
