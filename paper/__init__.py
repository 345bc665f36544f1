"""The paper on which this package is based, recomputed: each table, figure and conclusion judged.

V. B. Awati, P. M. Obannavar and M. Kumar N., Multigrid method for the solution of thermal
elastohydrodynamic lubrication point contact problem with surface asperities.

``python -m paper -o DIR [NAME ...]`` is a client of the public interface of ``tehl`` only.
"""
