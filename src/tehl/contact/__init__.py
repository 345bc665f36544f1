"""What a user states: bodies, motion, supply, heat, numerical options, and the whole problem."""
