"""Full multigrid of one film: levels, relaxation, cycles, and what accelerates them."""
