"""Modules that subcommands load when they use them, under plain names."""

from typing import TYPE_CHECKING

from tehl.base.lazy import lazy

if TYPE_CHECKING:
    from tehl import plots, roughness
    from tehl.api import problem as problems
    from tehl.api import results, solvers
    from tehl.base import mistakes, units
    from tehl.contact import materials as solid_library
    from tehl.contact import options as numerics
    from tehl.estimate import scaling
    from tehl.explore import case_text, server
    from tehl.io import case as case_files
    from tehl.io import export as exports
    from tehl.io import store
    from tehl.io import summary as summaries
    from tehl.io import templates as case_templates
    from tehl.kernels import cache as kernel_cache
    from tehl.kernels import samples, warmup
    from tehl.lubricant import fluid as oil_library
    from tehl.lubricant import law as oil_laws
    from tehl.plots import animation
    from tehl.plots import surface as surface_pictures
    from tehl.post import layer as layers
    from tehl.post import micro_film, thermal_effect
    from tehl.report import explain as explanations
    from tehl.report import page as pages
    from tehl.report import rendering
    from tehl.roughness import preview as previews
    from tehl.solver import monitor as monitors
    from tehl.studies import runner
else:
    problems = lazy("tehl.api.problem")
    results = lazy("tehl.api.results")
    solvers = lazy("tehl.api.solvers")
    mistakes = lazy("tehl.base.mistakes")
    units = lazy("tehl.base.units")
    numerics = lazy("tehl.contact.options")
    solid_library = lazy("tehl.contact.materials")
    scaling = lazy("tehl.estimate.scaling")
    case_text = lazy("tehl.explore.case_text")
    server = lazy("tehl.explore.server")
    case_files = lazy("tehl.io.case")
    exports = lazy("tehl.io.export")
    store = lazy("tehl.io.store")
    summaries = lazy("tehl.io.summary")
    case_templates = lazy("tehl.io.templates")
    kernel_cache = lazy("tehl.kernels.cache")
    samples = lazy("tehl.kernels.samples")
    warmup = lazy("tehl.kernels.warmup")
    oil_library = lazy("tehl.lubricant.fluid")
    oil_laws = lazy("tehl.lubricant.law")
    plots = lazy("tehl.plots")
    animation = lazy("tehl.plots.animation")
    surface_pictures = lazy("tehl.plots.surface")
    layers = lazy("tehl.post.layer")
    micro_film = lazy("tehl.post.micro_film")
    thermal_effect = lazy("tehl.post.thermal_effect")
    explanations = lazy("tehl.report.explain")
    pages = lazy("tehl.report.page")
    rendering = lazy("tehl.report.rendering")
    roughness = lazy("tehl.roughness")
    previews = lazy("tehl.roughness.preview")
    monitors = lazy("tehl.solver.monitor")
    runner = lazy("tehl.studies.runner")
