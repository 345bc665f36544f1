"""The founding paper of this package, reproduced and judged."""
