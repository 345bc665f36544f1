"""A small piece of a rough surface: how it is pressed flat, and what flows through it."""
