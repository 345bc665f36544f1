"""Imported by the server of workers: what each of them needs is loaded before they are forked."""

from contextlib import suppress

from tehl.solver.warmup import warm_up

with suppress(Exception):  # whoever solves meets it again, and tells it with the case
    warm_up(coupled=False)
