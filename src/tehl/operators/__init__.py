"""The discrete equations, one operator per file, thin over the compiled loops."""
