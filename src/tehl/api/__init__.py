"""What `tehl` shows to its users: problems, solvers and results with all their methods."""
