"""Transient runs: the steady film at time zero, then the time steps to the end."""

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from functools import partial

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.contact.transient import Transient
from tehl.estimate.duration import misplaced, number_of_steps, stride_on
from tehl.estimate.grid import Grid
from tehl.estimate.halving import halvings
from tehl.estimate.in_time import PART_IN_STEP
from tehl.estimate.nodes import finest_grid, least_in_time, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.schedule import schedule_of
from tehl.kernels.warmup import warm_up
from tehl.operators.heights import MovingHeights, check_ends
from tehl.result.solution import ConvergenceError, Solution, Status
from tehl.result.transient import StepReport, TransientSolution
from tehl.solver.attempts import Attempt
from tehl.solver.cost import Clock, end_of_time, working_time
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.relaxation import BROAD, CAREFUL, FAST, ROBUST, ROUGH, Relaxation
from tehl.solver.judging.measures import (
    is_resolved,
    mid_film_stress,
    rolling_moment,
    solid_friction,
    tractions,
)
from tehl.solver.monitor import SILENT, StepMonitor
from tehl.solver.steady import try_strategies
from tehl.solver.transient.checks import check_size, check_stride, check_waves
from tehl.solver.transient.coarser import at_nodes, go_coarser
from tehl.solver.transient.endings import no_film, step_not_settled, time_over
from tehl.solver.transient.oil import Lead
from tehl.solver.transient.snapshot import ANEW, COLUMNS, Record, Snapshot, kept_steps
from tehl.solver.transient.step import LastStep, StepEnd, StepError, Stepper

SETTINGS, COUPLED_SETTINGS = (FAST, ROUGH, CAREFUL), (BROAD, ROBUST, CAREFUL)
"""Relaxations of a step, fastest first; and those for heated or shear-thinning films."""
START_TOLERANCE, TIGHT_TIME = 1e-7, 0.5
"""Tolerance of the steady film at time zero, and part of the time for it."""
ACCEPTED_START_TOLERANCE = 2e-5
"""Tolerance at which cycles of the steady film may end without that: a fiftieth of that of a step.
At steep ends of rollers a cycle leaves 0.8 to 0.9 of the change (M = 72 and 52: 6e-7 and 1.05e-5
after the most cycles). The second one then has its central film to 1e-8 and the minimum to 4e-6."""
SolveStart = Callable[..., tuple[Attempt, Solution]]
"""Solves for the steady film by options; keywords are those of `try_strategies`."""


def solve_transient(  # noqa: PLR0913 (keywords with defaults)
    problem: ContactProblem,
    options: Options | None = None,
    *,
    monitor: StepMonitor = SILENT,
    resume: Snapshot | None = None,
    keep: Callable[[Snapshot], None] | None = None,
    until: float | None = None,
    one_grid: bool = False,
) -> TransientSolution:
    """Solve a transient contact.

    Parameters
    ----------
    problem : ContactProblem
        The contact, with a ``transient`` table.
    options : Options
        Numerical options; the defaults if left out.
    monitor : StepMonitor
        Receives the report of each step.
    resume : Snapshot
        State of an interrupted run of the same problem.
    keep : callable
        Called with a snapshot after each step; copies it if it is to be kept.
    until : float
        When the time is over, on the clock of `working_time` [s]; that of the options if left out.
    one_grid : bool
        Keep the nodes of the start, where a contact that grows would go on with fewer.

    Returns
    -------
    TransientSolution
        The transient film; its ``status`` is that of the last step.

    Raises
    ------
    ConvergenceError
        When the steady film at time zero did not converge.
    InputError
        When the transient problem is not valid, or does not fit into the memory.
    """
    options = options or Options()
    transient = problem.transient
    if transient is None:
        raise InputError("transient: missing from the case; solve the steady film with tehl.solve")
    warm_up(coupled=problem.is_coupled)
    run = Run(problem, options, transient, monitor, until=until, one_grid=one_grid)
    if resume is not None:
        run.restore(resume)
    return run.result(run.advance(monitor, keep))


class Run:
    """A transient run: its steady start, its stepper, and the record of its steps."""

    def __init__(
        self,
        problem: ContactProblem,
        options: Options,
        transient: Transient,
        monitor: StepMonitor,
        *,
        until: float | None = None,
        one_grid: bool = False,
    ) -> None:
        stated = "max_time" in options.model_fields_set
        own = end_of_time(options) if stated else math.inf
        self.clock = Clock(own if until is None else until)
        self.transient = transient
        self.scaled = scaled = ScaledProblem.of(problem)
        smooth = transient.start == "smooth"
        pose = partial(self._pose, smooth=smooth, part=PART_IN_STEP * options.target)
        pose(finest_grid(scaled, planned(scaled, options)))  # fails early
        attempt, self.start = self._steady_start(options, monitor)
        self.scaled = attempt.run.hierarchy.scaled  # it knows the flooded film
        pose(attempt.run.finest.grid)
        self.stepper = self._stepper(attempt.run)
        self.halvings = () if one_grid else self._halvings(options)
        self.record = Record()
        self.clock.end_start()
        self._note(0, self.heights.at(0.0, self.schedule.places(0)), None)

    @property
    def problem(self) -> ContactProblem:
        """The contact."""
        return self.scaled.problem

    def _halvings(self, options: Options) -> tuple[int, ...]:
        """Return when the run goes on with fewer nodes: if none are stated."""
        errors, nodes, stride = self.start.errors, self.level.grid.nx, self.transient.stride
        if options.points != "auto" or errors is None:
            return ()
        return halvings(self.scaled, options, (nodes, errors.film()), stride, self.steps)

    def _stepper(self, solver: FilmSolver) -> Stepper:
        settings: Sequence[Relaxation] = COUPLED_SETTINGS if self.problem.is_coupled else SETTINGS
        return Stepper(solver, self.transient, settings, self.schedule)

    def _pose(self, grid: Grid, *, smooth: bool, part: float) -> None:
        """Set heights, smooth or not at first, and time steps by `stride_on`; check them."""
        stride = stride_on(self.scaled, grid.dx, part)
        self.transient = transient = self.transient.model_copy(update={"stride": stride})
        check_ends(self.scaled, grid)
        self.heights = MovingHeights(self.scaled, grid, transient.entrance if smooth else None)
        units = self.scaled.scales
        self.seconds = stride * grid.dx * units.half_width_x / units.speed
        self.steps = number_of_steps(self.scaled, self.seconds)
        self.schedule = schedule_of(self.scaled, stride * grid.dx, self.steps)
        check_stride(transient, grid, self.schedule)
        check_size(self.scaled, grid, self.schedule)
        check_waves(self.heights, grid, self.schedule, stride)
        if (fault := misplaced(self.scaled, self.steps * self.seconds)) is not None:
            raise InputError(fault)
        self.kept = kept_steps(transient, self.steps, self.seconds)

    def _steady_start(self, options: Options, monitor: StepMonitor) -> tuple[Attempt, Solution]:
        """Solve for the steady film at time zero, rough or smooth.

        Heat and film may alternate by less than the mesh errs, and a tight solve may take all its
        time on a grid that is too coarse, or find it too coarse before its cycles end: then the
        accuracy of the options is enough. A film that no accuracy changes is not solved again.
        """
        least = min(options.tolerance, START_TOLERANCE)
        tight = options.model_copy(update={"accuracy": "tight", "tolerance": least})
        solve = partial(
            try_strategies, self.problem, monitor=monitor, rough=self.transient.start != "smooth"
        )
        now, end = working_time(), min(end_of_time(options), self.clock.until)
        attempt, result = solve(
            tight, until=now + TIGHT_TIME * (end - now), tolerance=ACCEPTED_START_TOLERANCE
        )
        status = result.status
        again = not attempt.reached or status.cause == "error_not_reached"
        if not status.converged and again and options.accuracy != "tight":
            attempt, result = solve(options, until=end)
        attempt, result = self._on_fewer_nodes(attempt, result, tight, partial(solve, until=end))
        result = result.but(options=options)
        if not result.status.converged:
            message = f"The steady film at time zero did not converge: {result.status.message}"
            status = replace(result.status, message=message)
            raise ConvergenceError(message, result.but(status=status))
        return attempt, result

    @staticmethod
    def _on_fewer_nodes(
        attempt: Attempt, result: Solution, tight: Options, solve: SolveStart
    ) -> tuple[Attempt, Solution]:
        """Return the start on a coarser grid where that is enough for the error, else this one."""
        run, errors = attempt.run, result.errors
        fewer = run.goal.fewer_nodes(run.finest, errors) if result.status.converged else None
        if fewer is None:
            return attempt, result
        if fewer[0] < least_in_time(run.hierarchy.scaled, tight):
            return attempt, result
        order = run.hierarchy.options.wedge_order
        stated = tight.on_points(*fewer).model_copy(update={"wedge_order": order})
        other, found = solve(stated, tolerance=ACCEPTED_START_TOLERANCE)
        enough = found.status.converged and run.goal.is_met(found.errors)
        cost = result.cost + found.cost
        return (other, found.but(cost=cost)) if enough else (attempt, result.but(cost=cost))

    @property
    def level(self) -> Level:
        """The finest level."""
        return self.stepper.solver.finest

    def advance(
        self, monitor: StepMonitor, keep: Callable[[Snapshot], None] | None = None
    ) -> Status:
        """Advance to the end, or until a step fails or the time is over; return the status.

        Parameters
        ----------
        monitor : StepMonitor
            Receives each step.
        keep : callable or None
            Receives a snapshot after each step, for a checkpoint.
        """
        for step in range(len(self.record.rows), self.steps + 1):
            time_now = step * self.seconds
            if self.clock.is_over:
                ended = step - 1, self.steps
                return time_over(self.start.options, self.clock, ended, self.seconds)
            for _ in range(self.halvings.count(step)):
                self._go_coarser()
            heights = self.heights.at(time_now, self.schedule.places(step))
            try:
                end = self.stepper.step(heights[0] + heights[1], step)
            except StepError as error:
                return step_not_settled(self.stepper, error, time_now)
            self._note(step, heights, end)
            if not is_resolved(self.level):
                return no_film(self.level, time_now, rough=self.problem.is_rough)
            monitor.step(self._report(step, end))
            if keep is not None:
                keep(self.snapshot())
        return Status(kind="converged")

    def _note(self, step: int, heights: tuple[Array, Array], end: StepEnd | None) -> None:
        """Record a step; at time zero it has no cycles."""
        time_now = step * self.seconds
        moment = self.schedule.moments[step]
        scaled = replace(self.scaled, moment=moment)
        numbers = {
            "time": time_now,
            "load": moment.load,
            "speed": moment.speed,
            "radius": 1.0 / moment.curvature,
            "sliding": moment.sliding,
            "solid_friction": solid_friction(self.level, scaled),
            **tractions(self.level, scaled, self.stepper.solver.coupling.state),
            "rolling_moment": rolling_moment(self.level, scaled),
            "temperature_rise": self.stepper.solver.coupling.temperature_rise(),
            "nodes": self.level.grid.nx,
            "cycles": end.cycles if end else 0,
            "change": end.change if end else 0.0,
        }
        keep, stress = step in self.kept, None
        if keep and self.problem.stress is not None:
            state = self.stepper.solver.coupling.state
            stress = mid_film_stress(self.level, self.scaled, state)
        self.record.note(self.level, heights, numbers, keep=keep, stress=stress)

    def _go_coarser(self) -> None:
        """Go on with half the nodes, and the state of the run at these."""
        nodes, before, predictor = self.level.grid.nx, self.snapshot(), self.stepper.predictor
        steady, squeezed = predictor.steady, self.stepper.squeeze.steady
        go_coarser(self.stepper.solver)
        self.transient = self.transient.model_copy(update={"stride": self.transient.stride // 2})
        entrance = self.transient.entrance if self.transient.start == "smooth" else None
        self.heights = MovingHeights(self.scaled, self.level.grid, entrance)
        self.stepper = self._stepper(self.stepper.solver)
        after = self.snapshot().fields
        fields = {
            name: at_nodes(field, after[name].shape, nodes) for name, field in before.fields.items()
        }
        self._take(replace(before, fields=fields))
        # they are those of the start, which a snapshot does not have
        self.stepper.predictor.steady = at_nodes(steady, self.level.film.p.shape, nodes)
        squeeze = self.stepper.squeeze
        if not isinstance(squeeze, Lead):
            squeeze.steady = at_nodes(squeezed, squeeze.steady.shape, nodes)

    def _report(self, step: int, end: StepEnd) -> StepReport:
        row = dict(zip(COLUMNS, self.record.rows[-1], strict=True))
        return StepReport(
            step=step,
            steps=self.steps,
            time=step * self.seconds,
            film_central=row["film_central"],
            film_minimum=row["film_minimum"],
            pressure_max=row["pressure_max"],
            **asdict(end),
        )

    def snapshot(self) -> Snapshot:
        """Return the state from which the run resumes; its arrays are those of the run."""
        return Snapshot(
            setting=self.stepper.setting,
            rigid_approach=self.level.rigid_approach,
            fields={
                "pressure": self.level.film.p,
                "asperity": self.level.film.asperity,
                "mass": self.stepper.oil.now,
                "mass_before": self.stepper.oil.before,
                "mass_steady": self.stepper.oil.steady,
                "pressure_changes": self.stepper.predictor.past,
                "rigid_motion": self.stepper.last.motion,
                "approaches": self.stepper.last.approaches,
                "excess": self.stepper.squeeze.past,
                "excess_steady": self.stepper.squeeze.steady,
                "coarsest": self.stepper.solver.hierarchy.coarsest.pack(),
                **self.stepper.solver.coupling.pack(self.stepper.solver.levels),
            },
            record=self.record,
            cost=self.clock.cost(),
        )

    def restore(self, snapshot: Snapshot) -> None:
        """Restore a snapshot of the same problem.

        Raises InputError if it belongs to another grid or other steps, or lacks a field.
        """
        ended = len(snapshot.record.rows) - 1
        for _ in range(sum(step <= ended for step in self.halvings)):
            self._go_coarser()
        self._check(snapshot)
        self._take(snapshot)
        self.record, self.clock.before = snapshot.record, snapshot.cost

    def _take(self, snapshot: Snapshot) -> None:
        """Take the fields of a snapshot."""
        level, fields = self.level, dict(snapshot.fields)
        oil = self.stepper.oil
        oil.now, oil.before = fields.pop("mass"), fields.pop("mass_before")
        steady = fields.pop("mass_steady")
        if oil.follows:
            oil.follow(steady)
        self.stepper.predictor.past = fields.pop("pressure_changes")
        self.stepper.last = LastStep(fields.pop("rigid_motion"), fields.pop("approaches"))
        squeeze, excess = self.stepper.squeeze, fields.pop("excess_steady")
        squeeze.past = fields.pop("excess")
        if isinstance(squeeze, Lead):
            squeeze.follow(excess)
        pressure, asperity = fields.pop("pressure"), fields.pop("asperity")
        level.set_state(pressure, snapshot.rigid_approach, asperity)
        self.stepper.choose(snapshot.setting)
        coarsest = fields.pop("coarsest")
        self.stepper.solver.coupling.unpack(self.stepper.solver.levels, fields)
        self.stepper.solver.hierarchy.coarsest.unpack(coarsest)

    def _check(self, snapshot: Snapshot) -> None:
        """Check that a snapshot belongs to this problem."""
        if _shapes(snapshot.fields) != _shapes(self.snapshot().fields):
            raise InputError(f"the checkpoint has another grid than the case, or is damaged{ANEW}")
        record, (_, nx) = snapshot.record, self.record.profiles[0].shape
        steps, fields = np.arange(len(record.rows)), 3 + (self.problem.stress is not None)
        times = np.array([row[0] for row in record.rows])
        fitting = (
            steps.size <= self.steps + 1
            and 0 <= snapshot.setting < len(self.stepper.settings)
            and np.allclose(times, steps * self.seconds, rtol=1e-9, atol=0.0)
            and record.profiles[0].shape[-1] == nx
            and record.frame_steps == [step for step in steps if step in self.kept]
            and all(frame.shape == (fields, self.level.grid.ny, nx) for frame in record.frames)
        )
        if not fitting:
            raise InputError(f"the checkpoint has other steps than the case, or is damaged{ANEW}")

    def result(self, status: Status) -> TransientSolution:
        """Return the result; an open minimum of the steady film is reported in its status."""
        if status.converged and (steady := self.start.status).is_vague:
            status = replace(status, message=f"At time zero: {steady.message}", hint=steady.hint)
        (_, nx), scales = self.record.profiles[0].shape, self.scaled.scales
        return TransientSolution(
            start=self.start,
            history=self.record.history(scales),
            profiles=self.record.lines(scales),
            frames=self.record.fields(scales, (self.level.grid.ny, nx)),
            time_step=self.seconds,
            status=status,
            cost=self.clock.cost(),
            provenance=self.start.provenance,
        )


def _shapes(fields: dict[str, Array]) -> dict[str, tuple[tuple[int, ...], np.dtype]]:
    return {name: (field.shape, field.dtype) for name, field in fields.items()}
