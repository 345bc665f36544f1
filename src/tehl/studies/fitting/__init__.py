"""The oil from a test: constants of a lubricant fitted to measured films and tractions."""
