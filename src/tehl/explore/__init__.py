"""The live page of ``tehl explore``: controls, a warm worker that solves, pictures and numbers."""
