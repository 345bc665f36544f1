"""What is known before any solve: scales, formulas, domain, grids, duration, cost."""
