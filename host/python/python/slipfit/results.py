"""Results of commands and what they are made of. Generated from the guide's page on JSON, which says more.

A field that is missing where a scene is of another kind, or an option was not given, is None as an attribute.
"""

from __future__ import annotations

from typing import Any

from slipfit._result import Result
from slipfit._slipfit import Columns


class Check(Result):
    """What ``check`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str
    #: Number of parts, always 2: the slide and the frame (N in eqs. 5–8 of the paper that the README names).
    parts: int | None
    #: Degrees of freedom that the contacts take.
    n_cl: int | None
    #: Degrees of freedom that are left, a whole number; 1 is the travel alone, 0 or less holds the slide.
    degrees_of_freedom: float | None
    #: Law of the normal force of contacts: linear, three-halves, power.
    normal_law: str | None
    #: None, regularised, exact.
    friction_law: str | None
    #: In words: what these laws cost the kernel.
    kernel_why: str | None
    #: Tolerance level of the gaps below.
    n: float | None
    #: All gaps of the scene.
    gaps: list[Gap] | list[Play] | None
    #: The level that closes each pair of gaps, the first to close first.
    n_star: list[ClosingLevel] | None
    #: Whether the slide locks itself; None if no two pins guide it sideways.
    guide: Guide | None
    #: What to know before trusting a run.
    warnings: list[str]
    #: Degrees of freedom.
    freedom: Freedom | None
    #: Measures at the drawing's nominal values.
    measures: list[Nominal] | None


class Gap(Result):
    """Gap."""
    #: Pin and surface.
    name: str
    #: Gap (mm), negative where parts are compressed.
    mm: float
    #: Compressed (negative), zero (within 1e-9 mm of 0), free (positive).
    class_: str


class ClosingLevel(Result):
    """Closing."""
    #: The pin.
    pin: str
    #: Across or up-down.
    pair: str
    #: The level at which the sum of both gaps is zero.
    n: float


class Guide(Result):
    """Guide."""
    #: L: distance of the two guiding contacts along the travel (m).
    length: float
    #: X of the guide line, in the middle between the two guiding contacts (m).
    line_x: float
    #: B: distance of the drive from the guide line (m), not negative.
    drive_distance: float
    #: Distance of the centre of mass, where the other resistances act, from the guide line (m).
    resistance_distance: float
    #: Where the drive is, seen from the guide line: farther than the centre of mass (beyond), equally far (edge), or
    #: nearer (short).
    side: str
    #: The same up and down; None if the drive is at the height of the contacts.
    height: Lever | None
    #: 1/(2·Σ b/L): friction from which on the slide may lock; None if the drive is on the guide line.
    critical_friction: float | None
    #: Coefficient of friction of the scene.
    friction: float
    #: True if friction reaches the critical one and the side is not short.
    warn: bool


class Lever(Result):
    """Lever."""
    #: L: distance of the two guiding contacts along the travel (m).
    length: float
    #: B: distance of the drive from the middle between them (m); negative where friction does not lock.
    distance: float


class Freedom(Result):
    """Freedom."""
    #: Number of bodies, the frame included.
    parts: int
    #: Degrees of freedom of a free body: 6 in space, 3 in a plane.
    of_each: int
    #: How many ideal joints remove i degrees of freedom, at index i from 0 on.
    ideal: list[int]
    #: Degrees of freedom that joints with play take.
    by_clearance: int
    #: Degrees of freedom that are left, a whole number.
    degrees_of_freedom: float


class Play(Result):
    """Play."""
    #: Joint, and wall where it has several.
    name: str
    #: Gap (mm).
    mm: float
    #: The level at which the gap is zero; missing if the gap does not vary.
    closes_at_n: float | None


class Nominal(Result):
    """Nominal."""
    #: Name of the measure.
    name: str
    #: Its value at the drawing's nominal values.
    nominal: float
    #: Unit of its value: mm, °, N, N/mm, g, N·mm, MPa or s; empty for a plain number.
    unit: str


class Simulation(Result):
    """What ``simulate`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str
    #: Tolerance level: one for all gaps, or sixteen: left, right, rail and wall of each of four pins, 0 where there
    #: is no such gap. With ``unit``: by how many σ each gap is below its mean.
    n: list[float]
    #: The longest simulated time.
    duration_s: float | None
    #: What computed the run.
    solver: Solver | None
    #: Time that the integration alone took.
    integration_ms: float
    #: Last time that the speed rises through 0.2 mm/s after the ramp's start (s); None if it does not.
    breakaway: float | None
    #: Magnitude of the greatest force, driving or braking, from the ramp's start on (N; N·m of a drive that turns);
    #: None if the run ends before.
    peak_force: float | None
    #: Mean force over the last 20 ms (N, N·m); None if it varies by 1 % or more.
    settled_force: float | None
    #: Speed at the end (m/s, rad/s).
    final_velocity: float | None
    #: When and where the run ended.
    end: Moment | None
    #: Whether the run came to the end of the stroke; None if the scene states none.
    stroke_reached: bool | None
    #: Least and greatest velocity (m/s) over the last 20 ms, if a limit between two verdicts lies between them; the
    #: verdict is then that of the last instant.
    swings: list[float] | None
    #: From where on it stays slower than half of the command; None if it does not.
    slows: Moment | None
    #: From where on it stays slower than 1 % of the command; None if it does not.
    stops: Moment | None
    #: Where the slide tips: a wall that was free meets its pin; None if none does.
    tips: Moment | None
    #: Runs, crawls, jammed, overruns, undecided.
    verdict: str | None
    #: The unit's gaps before the motion.
    gaps: list[Gap] | list[Play]
    #: How far the run can be trusted.
    trust: Trust | None
    #: The controller's run of the same unit; missing if the run itself is the controller's.
    controller: ControllerComparison | MechanismController | None
    #: Where the energy went (J); with ``audit``.
    audit_j: dict[str, float] | None
    #: What to know before trusting the run.
    warnings: list[str]
    #: The motion, a row every ``every``, as ``csv`` writes it.
    columns: Columns
    #: Integration scheme.
    integrator: str | None
    #: Error of speed that a step may make (m/s, rad/s), less than run.error asks for where a finer run was needed.
    tolerance_m_per_s: float | None
    #: Steps that count.
    accepted: int | None
    #: Attempts at steps that were repeated shorter.
    refused: int | None
    #: Greatest difference of a column from a run at a tenth of the error limit. It is a share of the column's peak;
    #: of a body's place, orientation, velocity and angular velocity the greatest of their columns counts.
    difference: float | None
    #: The column of that difference; None if nothing differs.
    difference_column: str | None
    #: Each drive's figures.
    drives: list[Drive] | None


class Solver(Result):
    """Solver."""
    #: Desk or controller.
    by: str
    #: Integration scheme.
    integrator: str
    #: F32 or f64.
    scalar: str
    #: Step (s); only of the controller.
    step_s: float | None
    #: Error of the drive's force that a step may make (N); only of the desk, for slides.
    tolerance_n: float | None
    #: Error of speed that a step may make (m/s, rad/s); only of the desk, for mechanisms.
    tolerance_m_per_s: float | None
    #: Stick band by which the desk replaces exact friction (m/s); only then.
    stick_band_m_per_s: float | None
    #: Steps that count.
    accepted: int
    #: Attempts at steps that were repeated shorter, because their error was too large.
    refused: int
    #: Greatest imbalance of momentum that a step left (N·s); 0 of the desk, whose steps leave none.
    worst_residual: float


class Moment(Result):
    """Moment."""
    #: Time (s).
    t: float
    #: Travel (m, or rad).
    z: float


class Trust(Result):
    """Trust."""
    #: Greatest error that a step reports of itself, as a force, as a share of the peak force; above 0.3 there is a
    #: warning.
    doubtful_force: float
    #: Greatest residual of a step as a share of the greatest momentum; above 0.3 there is a warning.
    imbalance: float
    #: Greatest difference of the drive's force from a better run, from the ramp's start on, as a share of its peak. A
    #: desk's run is compared with one at a tenth of its error limit, a controller's with the desk's. Above 0.005
    #: there is a warning; None without a better run.
    difference: float | None
    #: A step that should do (s); None if the step is short enough, and for the desk.
    better_step: float | None
    #: Whether a run with that step was made and found good enough.
    better_step_tried: bool


class ControllerComparison(Result):
    """Beside."""
    #: How it was computed.
    solver: Solver
    #: The controller's verdict.
    verdict: str
    #: How far the controller's run can be trusted.
    trust: Trust


class MechanismController(Result):
    """Controller of a mechanism."""
    #: Integration scheme.
    integrator: str
    #: Its step (s).
    step_s: float
    #: Whether drives and samples are those of its run; else they are the desk's.
    shown: bool
    #: Greatest difference of a drive's force or torque from the desk, as a share of its peak; None if the motion left
    #: the finite range.
    difference: float | None


class Drive(Result):
    """Drive."""
    #: Name of the drive.
    name: str
    #: N, or N·m of a drive that turns: of the forces below.
    unit: str
    #: Last time that the speed rises through 0.2 mm/s after the ramp's start (s); None if it does not.
    breakaway: float | None
    #: Magnitude of the greatest force, driving or braking, from the ramp's start on (N; N·m of a drive that turns);
    #: None if the run ends before.
    peak_force: float | None
    #: Mean force over the last 20 ms (N, N·m); None if it varies by 1 % or more.
    settled_force: float | None
    #: Speed at the end (m/s, rad/s).
    final_velocity: float
    #: When and where the run ended.
    end: Moment
    #: Whether the run came to the end of the stroke; None if the scene states none.
    stroke_reached: bool | None
    #: Least and greatest velocity (m/s) over the last 20 ms, if a limit between two verdicts lies between them; the
    #: verdict is then that of the last instant.
    swings: list[float] | None
    #: From where on it stays slower than half of the command; None if it does not.
    slows: Moment | None
    #: From where on it stays slower than 1 % of the command; None if it does not.
    stops: Moment | None
    #: Where the slide tips: a wall that was free meets its pin; None if none does.
    tips: Moment | None
    #: Runs, crawls, jammed, overruns, undecided.
    verdict: str


class Sweep(Result):
    """What ``sweep`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str
    #: Name of the drive that verdicts and forces are about.
    drive: str
    #: N, or N·m of a drive that turns. Then all forces here are torques (N·m), speeds rad/s and travel rad.
    effort_unit: str
    #: Levels grouped: neighbours with the same verdict.
    ranges: list[Range] | None
    #: Every level, loosest first.
    levels: list[Level] | None
    #: What to know before trusting the runs.
    warnings: list[str]
    #: Figures of each level or value, as ``csv`` writes it.
    columns: Columns
    #: The keys that were swept.
    keys: list[str] | None
    #: Every combination of values, those of the last key fastest.
    points: list[PointOverKeys] | None


class Range(Result):
    """Range."""
    #: Loosest level.
    first: float
    #: Tightest level.
    last: float
    #: Of all levels in the range.
    verdict: str
    #: Least and greatest peak force in the range (N, N·m).
    peak_force: list[float] | None
    #: Least and greatest travel at the end (m, rad).
    travel: list[float]
    #: Earliest and latest end (s).
    time: list[float]
    #: Whether all levels reach the end of the stroke; None if the scene states none.
    stroke_reached: bool | None


class Level(Result):
    """Level."""
    #: Tolerance level.
    n: float
    #: Last time that the speed rises through 0.2 mm/s after the ramp's start (s); None if it does not.
    breakaway: float | None
    #: Magnitude of the greatest force, driving or braking, from the ramp's start on (N; N·m of a drive that turns);
    #: None if the run ends before.
    peak_force: float | None
    #: Mean force over the last 20 ms (N, N·m); None if it varies by 1 % or more.
    settled_force: float | None
    #: Speed at the end (m/s, rad/s).
    final_velocity: float
    #: When and where the run ended.
    end: Moment
    #: Whether the run came to the end of the stroke; None if the scene states none.
    stroke_reached: bool | None
    #: Least and greatest velocity (m/s) over the last 20 ms, if a limit between two verdicts lies between them; the
    #: verdict is then that of the last instant.
    swings: list[float] | None
    #: From where on it stays slower than half of the command; None if it does not.
    slows: Moment | None
    #: From where on it stays slower than 1 % of the command; None if it does not.
    stops: Moment | None
    #: Where the slide tips: a wall that was free meets its pin; None if none does.
    tips: Moment | None
    #: Runs, crawls, jammed, overruns, undecided.
    verdict: str
    #: How it was computed.
    solver: Solver
    #: How far it can be trusted.
    trust: Trust
    #: Number of gaps that are compressed.
    compressed: int
    #: Number of gaps that are zero.
    zero: int
    #: Number of gaps that are free.
    free: int
    #: Class of each gap: compressed, zero, free.
    classes: dict[str, str]


class PointOverKeys(Result):
    """Point over keys."""
    #: Value of each key, in its unit.
    values: list[float]
    #: Tolerance level of the unit.
    n: float
    #: Last time that the speed rises through 0.2 mm/s after the ramp's start (s); None if it does not.
    breakaway: float | None
    #: Magnitude of the greatest force, driving or braking, from the ramp's start on (N; N·m of a drive that turns);
    #: None if the run ends before.
    peak_force: float | None
    #: Mean force over the last 20 ms (N, N·m); None if it varies by 1 % or more.
    settled_force: float | None
    #: Speed at the end (m/s, rad/s).
    final_velocity: float
    #: When and where the run ended.
    end: Moment
    #: Whether the run came to the end of the stroke; None if the scene states none.
    stroke_reached: bool | None
    #: Least and greatest velocity (m/s) over the last 20 ms, if a limit between two verdicts lies between them; the
    #: verdict is then that of the last instant.
    swings: list[float] | None
    #: From where on it stays slower than half of the command; None if it does not.
    slows: Moment | None
    #: From where on it stays slower than 1 % of the command; None if it does not.
    stops: Moment | None
    #: Where the slide tips: a wall that was free meets its pin; None if none does.
    tips: Moment | None
    #: Runs, crawls, jammed, overruns, undecided.
    verdict: str
    #: What units of the production do, the same at every point; None without ``units``.
    population: Statistics | None


class Population(Result):
    """What ``population`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str
    #: Name of the drive that verdicts and forces are about.
    drive: str
    #: N, or N·m of a drive that turns. Then all forces here are torques (N·m), speeds rad/s and travel rad.
    effort_unit: str
    #: Seed of the production.
    seed: int
    #: What the units do, counted.
    statistics: Statistics
    #: Contributors that the greatest force varies with, the strongest first.
    force_drivers: list[Driver]
    #: Contributors that malfunction varies with, the strongest first.
    malfunction_drivers: list[Driver]
    #: What the production does over all unknowns; None if nothing is unknown.
    uncertain: UncertainAnswer | None
    #: For comparison: the units of the levels −6 to 6, in which all gaps move together (eq. 9); without those that
    #: cannot be assembled.
    levels: list[LevelInPopulation]
    #: All gaps tighter and all gaps looser, compared with random combinations.
    hypothesis: Hypothesis
    #: Probabilities that ``rare`` estimates; None without it.
    rare: RareMalfunction | None
    #: Up to five units: malfunctioning ones first, by shortest travel, then by greatest force.
    worst: list[Unit]
    #: What to know before trusting a run.
    warnings: list[str]
    #: A row for each unit, as ``csv`` writes it; if they were asked for.
    columns: Columns | None


class Statistics(Result):
    """Statistics."""
    #: Units that were simulated.
    units: int
    #: Units that move at half of the commanded speed or more at the end.
    runs: Share
    #: Units that run, but are not at the end of the stroke when the run is over; None where no stroke is asked for.
    short: Share | None
    #: Units that move at 1 % to 50 % of it.
    crawls: Share
    #: Units below 1 % of it.
    jammed: Share
    #: Units above 150 % of it, or that move backwards at more than half of it.
    overruns: Share
    #: Units without a verdict.
    undecided: Share
    #: Units that crawl, jam or need more than the force limit.
    malfunctions: Share
    #: Units that need more than the force limit; None without one.
    over_limit: Share | None
    #: The z above which a standard normal distribution has the share of malfunctions; negative if more than half
    #: malfunction; None if no unit or every unit does, or if one is undecided.
    sigma_level: float | None
    #: Greatest force of a unit (N).
    peak_force: Spread | None
    #: Greatest force of a unit that runs (N).
    running_force: Spread | None
    #: Breakaway time (s) of those that break away.
    breakaway: Spread | None
    #: Velocity at the end (m/s).
    final_velocity: Spread | None
    #: Units so near to the bound between two verdicts that the desk computed them again.
    at_desk: int
    #: Units that cannot be assembled, because a pin is wider than its hole; they count as jammed.
    unassembled: int
    #: Units of which no step meets the tolerance, however short; they are undecided.
    unsolved: int
    #: Units with a parameter that is out of bounds; they are undecided.
    out_of_bounds: int


class UncertainAnswer(Result):
    """Uncertain answer."""
    #: The unknown values.
    unknowns: list[Unknown]
    #: Dimensions and gaps of which measured parts leave something open.
    measured: list[str]
    #: Units that were simulated at each value.
    units_each: int
    #: Share that crawls, jams or needs more than the force limit.
    malfunctions: Expected
    #: Share that crawls.
    crawls: Expected
    #: Share that jams.
    jammed: Expected
    #: Share that overruns the command.
    overruns: Expected
    #: Share that needs more than the force limit; None without one.
    over_limit: Expected | None
    #: Greatest force (N; torque, N·m) that half of the units do not exceed; None if a run ends before the ramp.
    median_force: Expected | None
    #: The same of 95 % of the units.
    high_force: Expected | None
    #: The unknowns that decide which share malfunctions, the strongest first; none that chance explains.
    decides: list[Decider]
    #: The values that were tried, in the order in which they were.
    values: list[TriedValue]
    #: Units without a verdict.
    undecided: int
    #: Units among these with a parameter that is out of bounds.
    out_of_bounds: int


class Unknown(Result):
    """Unknown."""
    #: Name of the parameter.
    name: str
    #: Unit of its values; empty for a plain number.
    unit: str
    #: The least and the greatest value that was tried.
    tried: list[float]


class Expected(Result):
    """Expected."""
    #: Mean over all unknowns.
    expected: float
    #: What holds it with 95 %: lower and upper end.
    interval: list[float]


class Decider(Result):
    """Decider."""
    #: Name of the unknown.
    name: str
    #: Share of the variance between the values that it explains alone; 1 if nothing else is unknown.
    share: float
    #: Standard error of the share.
    error: float


class TriedValue(Result):
    """Tried value."""
    #: A value of each unknown, in the order and the units of ``unknowns``.
    values: list[float]
    #: Units that malfunction with it.
    malfunctions: int


class Share(Result):
    """Share."""
    #: Number of units of this sort.
    units: int
    #: Their share of all units, from 0 to 1.
    share: float
    #: 95 % confidence interval of the share: lower and upper end.
    interval: list[float]


class Spread(Result):
    """Spread."""
    #: That have the figure.
    units: int
    #: Mean.
    mean: float
    #: Standard deviation.
    deviation: float
    #: The values that 0, 5, 50, 95 and 100 % of the units do not exceed.
    quantiles: list[float]


class Driver(Result):
    """Driver."""
    #: Name of the contributor.
    name: str
    #: Its share of the variance, without interactions (correlation ratio).
    share: float
    #: Standard error of the share.
    error: float
    #: What the greatest share of as many contributors without effect exceeds in at most 5 % of populations.
    chance: float


class LevelInPopulation(Result):
    """Level in the population."""
    #: Tolerance level.
    n: float
    #: Verdict of the unit of that level.
    verdict: str
    #: Its greatest force (N); None if the run ends before the ramp starts.
    peak_force_n: float | None
    #: Share of the population that needs less force than it.
    share_below: float


class Hypothesis(Result):
    """Hypothesis."""
    #: One entry for each distance from the mean unit, ascending.
    distances: list[Distance]


class Distance(Result):
    """Distance."""
    #: Distance from the mean unit: root mean square over the gaps, each in its standard deviations.
    distance: float
    #: Verdict of the unit with all gaps tighter by that many deviations.
    tight: str
    #: Whether that unit malfunctions.
    tight_malfunctions: bool
    #: Verdict of the unit with all gaps looser by that many deviations.
    loose: str
    #: Whether that unit malfunctions.
    loose_malfunctions: bool
    #: Random combinations of gaps at the same distance that malfunction.
    random: Share


class RareMalfunction(Result):
    """Rare malfunction."""
    #: Probability of any kind on any side.
    malfunction: Probability
    #: The same by kind and side; a unit belongs to one of them at most.
    parts: list[PartOfMalfunction]
    #: Units that were simulated for it.
    simulated: int
    #: Those of them that come to no verdict or whose parameters are out of bounds.
    unknown: int


class Probability(Result):
    """Probability."""
    #: Probability that a unit malfunctions so.
    probability: float | None
    #: Standard error of it, from sixteen independent repeats.
    standard_error: float | None
    #: 95 % confidence interval of it.
    interval: list[float] | None
    #: In place of a figure: it is below this with 95 % confidence, as none of the units that were drawn malfunctions
    #: so.
    rarer_than: float | None
    #: About the probability down to which subsets hold no malfunction.
    searched_to: float | None
    #: Searches that found none.
    searches: int | None
    #: In place of a figure: why there is none.
    reason: str | None


class PartOfMalfunction(Result):
    """Part of malfunction."""
    #: Crawls, jams, overruns, over-limit (does its job with too much force).
    kind: str
    #: Tight or loose: tighter or looser than the mean unit; any if no gap varies.
    side: str
    #: Probability that a unit malfunctions so.
    probability: float | None
    #: Standard error of it, from sixteen independent repeats.
    standard_error: float | None
    #: 95 % confidence interval of it.
    interval: list[float] | None
    #: In place of a figure: it is below this with 95 % confidence, as none of the units that were drawn malfunctions
    #: so.
    rarer_than: float | None
    #: About the probability down to which subsets hold no malfunction.
    searched_to: float | None
    #: Searches that found none.
    searches: int | None
    #: In place of a figure: why there is none.
    reason: str | None


class Unit(Result):
    """Unit."""
    #: Number of the unit in the production, for ``simulate`` with ``unit``.
    number: int
    #: Mean over the gaps of how far each is below its mean, in its standard deviations; positive is tighter.
    tightness: float
    #: Verdict.
    verdict: str
    #: Breakaway time (s).
    breakaway: float | None
    #: Greatest force (N); None if the run ends before the ramp starts.
    peak_force: float | None
    #: Mean force over the last 20 ms (N); None if it varies by 1 % or more.
    settled_force: float | None
    #: Velocity at the end (m/s).
    final_velocity: float
    #: When and where the run ended.
    end: Moment
    #: Two values for the contact that was pressed in deepest: its index from 0 on (left, right, rail, wall of the
    #: first pin, then of the next), and its elastic force (N); known of slides on pins.
    most_loaded: list[float] | None
    #: Whether the desk computed the unit again.
    at_desk: bool
    #: Why the unit has no run and no figures: unassembled, unsolved or out-of-bounds; None if it has one.
    fault: str | None


class Capability(Result):
    """What ``capability`` finds."""
    #: Version of this format.
    json_version: int
    #: Number of parts.
    parts: int
    #: What was measured, in the order of the file.
    characteristics: list[Characteristic]
    #: Characteristics whose capability cannot be told.
    refused: list[RefusedCharacteristic]
    #: What to know before trusting a figure.
    warnings: list[str]


class Characteristic(Result):
    """Characteristic."""
    #: Its name.
    name: str
    #: Mm, µm, m, in, °, rad, or empty.
    unit: str
    #: Nominal value.
    nominal: float | None
    #: Lower and upper limit.
    limits: list[float | None]
    #: Parts that were measured.
    count: int
    #: Parts that were not.
    missing: int
    #: Mean.
    mean: Estimate
    #: Standard deviation.
    deviation: Estimate
    #: Least value.
    least: float
    #: Median.
    median: float
    #: Greatest value.
    greatest: float
    #: The distribution that intervals, indices and shares are of.
    distribution: DistributionOfParts
    #: Pp and Ppk, by points of the distribution (ISO 22514-2).
    performance: Indices
    #: Shares outside the limits.
    failing: Failing
    #: Parts outside the limits; None without limits.
    counted: CountedParts | None
    #: Figures within subgroups; None without ``group``.
    within: Subgroups | None
    #: Test of normality; None below eight parts.
    normality: Normality | None
    #: Values too far away for a normal production.
    outliers: list[Outlier]
    #: Statistical tolerance intervals (ISO 16269-6).
    tolerance_intervals: list[ToleranceInterval]


class RefusedCharacteristic(Result):
    """Refused characteristic."""
    #: Its name.
    name: str
    #: Why its capability cannot be told.
    why: str


class Estimate(Result):
    """Estimate of 95 %."""
    #: The figure.
    value: float
    #: Its interval of 95 %; an end is None where it is infinite.
    interval: list[float | None]
    #: Its standard error, where it is known.
    error: float | None


class Indices(Result):
    """Indices."""
    #: Pp or Cp: of a normal distribution (upper − lower)/6σ.
    spread: Estimate | None
    #: (mean − lower)/3σ.
    lower: Estimate | None
    #: (upper − mean)/3σ.
    upper: Estimate | None
    #: The lesser of the two: Ppk or Cpk.
    least: Estimate | None


class Failing(Result):
    """Failing."""
    #: Share below the lower limit.
    below: Estimate | None
    #: Share above the upper limit.
    above: Estimate | None
    #: Share outside either.
    both: Estimate | None


class CountedParts(Result):
    """Counted parts."""
    #: Parts below the lower limit, and above the upper one.
    parts: list[int]
    #: Share of both in the production, whatever its distribution.
    share: Estimate


class Subgroups(Result):
    """Subgroups."""
    #: Name of the column.
    grouping: str
    #: Each of them.
    groups: list[Subgroup]
    #: Standard deviation within the subgroups, pooled.
    deviation: Estimate
    #: Its degrees of freedom.
    freedom: int
    #: Cp and Cpk.
    indices: Indices
    #: Share of the variance that is between the subgroups.
    between: float
    #: Probability of means as different if the subgroups have the same one (F test).
    p: float


class Subgroup(Result):
    """Subgroup."""
    #: Its name; empty for the parts of no subgroup.
    name: str
    #: Parts that were measured.
    count: int
    #: Mean.
    mean: float
    #: Standard deviation; None of one part.
    deviation: float | None


class Normality(Result):
    """Normality."""
    #: A² of Anderson and Darling.
    statistic: float
    #: The same, corrected for the number of parts.
    adjusted: float
    #: Probability of so great a statistic if the production is normal.
    p: float


class Outlier(Result):
    """Outlier."""
    #: Number of the part, from 0.
    part: int
    #: Its label.
    label: str
    #: Its value.
    value: float
    #: From the mean in standard deviations, without the outliers farther out.
    distance: float


class DistributionOfParts(Result):
    """Distribution of parts."""
    #: Its family.
    family: str
    #: Whether ``family`` stated it; otherwise the parts chose it.
    stated: bool
    #: Its parameters: name and value of each.
    parameters: list[Any]
    #: Akaike's information criterion, corrected for few parts; None where there are too few.
    aicc: float | None
    #: Correlation of the sorted values and the distribution's quantiles.
    qq_correlation: float
    #: The values below which 0.135 %, 50 % and 99.865 % lie.
    points: list[float]
    #: Families that the intervals allow for.
    allowed: list[str]


class ToleranceInterval(Result):
    """Tolerance interval."""
    #: Share of the production that it holds, with 95 % confidence.
    share: float
    #: K of the two-sided normal interval mean ± k·s.
    factor: float
    #: That interval.
    normal: list[float]
    #: K of the one-sided intervals.
    one_sided_factor: float
    #: Their ends: all but the share lie above the first, or below the second.
    one_sided: list[float]
    #: The interval of any distribution; None of too few parts.
    any_distribution: list[float] | None
    #: Parts that it needs.
    parts_for_any: int


class Identification(Result):
    """What ``identify`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str
    #: Slide, mechanism or drive-train.
    model: str
    #: Files of the records.
    records: list[str] | None
    #: Name of the estimate that counts, among those compared.
    law: str | None
    #: Single wrong samples that were replaced; drive trains only.
    spikes: int | None
    #: Cut-off frequency of the filter (Hz); drive trains only.
    cutoff_hz: float | None
    #: Every law with its estimate; of a slide one.
    compared: list[Identified] | None
    #: What to know before trusting a figure.
    warnings: list[str]
    #: What is found of each unit.
    units: list[IdentifiedUnit] | None
    #: Each parameter over all units.
    between: list[MeanOfUnits] | None


class Identified(Result):
    """Identified."""
    #: Name of the law.
    name: str
    #: How much worse it is than the best law, by the criterion of Schwarz; above 10 decisively.
    behind: float
    #: Whether it explains the record.
    lack: LackOfFit
    #: Estimates.
    parameters: list[IdentifiedParameter]
    #: Correlations of the parameters.
    correlation: list[list[float]]
    #: What the record does not determine.
    undetermined: list[str]
    #: Squares, huber or bisquare.
    loss: str
    #: Gradient or grid.
    by: str
    #: Samples that were compared.
    samples: int
    #: Independent samples that know as much.
    effective_samples: float
    #: Standard deviation of the residuals (N).
    residual_deviation: float


class LackOfFit(Result):
    """Lack of fit."""
    #: Root of the residuals' squares over that of the forces.
    relative_error: float
    #: Correlation of neighbouring residuals.
    lag_1_correlation: float
    #: Relative error in the last quarter, for the estimate from the rest.
    held_out_error: float | None
    #: Why the model does not explain the record; None where nothing speaks against it.
    verdict: str | None


class IdentifiedParameter(Result):
    """Identified parameter."""
    #: Its name.
    name: str
    #: SI unit; empty for a plain number.
    unit: str
    #: Estimate.
    value: float
    #: Standard deviation, the greater of the next two, or with what is known beforehand; None where it is not
    #: determined.
    deviation: float | None
    #: Standard deviation by the autocovariance of the residuals.
    deviation_by_autocovariance: float | None
    #: Standard deviation by the block bootstrap.
    deviation_by_bootstrap: float | None
    #: Interval of 95 % by the deviation or the profile, whichever is wider.
    interval: list[float] | None
    #: Interval of 95 % by the block bootstrap.
    bootstrap: list[float] | None
    #: Interval of 95 % by profile likelihood.
    profile: Profile
    #: Whether the estimate lies at a bound of the search.
    at_bound: bool


class Profile(Result):
    """Profile."""
    #: Lower and upper end; None where the record sets none.
    ends: list[float | None]
    #: Bounded, one-sided or flat.
    shape: str
    #: Values that were tried, ascending, and how much the loss rises there, as a share of what ends the interval.
    points: list[list[float]]


class IdentifiedUnit(Result):
    """Identified unit."""
    #: Files of the records.
    records: list[str]
    #: Name of the estimate that counts, among those compared.
    law: str
    #: Single wrong samples that were replaced; drive trains only.
    spikes: int | None
    #: Cut-off frequency of the filter (Hz); drive trains only.
    cutoff_hz: float | None
    #: Every law with its estimate; of others one.
    compared: list[Identified]
    #: What to know before trusting a figure.
    warnings: list[str]


class MeanOfUnits(Result):
    """Mean of units."""
    #: Its name.
    name: str
    #: SI unit; empty for a plain number.
    unit: str
    #: Units whose records determine it.
    units: int
    #: Mean of all units.
    mean: float
    #: Standard deviation of the mean.
    deviation: float
    #: Interval of 95 % for the mean.
    interval: list[float]
    #: Standard deviation between units, beside the errors of their estimates.
    spread: float


class Table(Result):
    """What ``table`` finds."""
    #: Version of this format.
    json_version: int
    #: Name of the file that was written.
    file: str
    #: Size of the table.
    bytes: int
    #: The axes of the table: level, then time or position, then speed.
    axes: list[Axis]
    #: How values are stored: f32 or i16.
    encoding: str | None
    #: N, or N·m of a drive that turns. Then all forces here are torques (N·m), speeds rad/s and positions rad,
    #: whatever the field's name says.
    effort_unit: str
    #: Hash of the scene's physics, hexadecimal.
    scene_hash: str
    #: Greatest error of interpolation that was found, at the levels and half way between; on the second axis at the
    #: nodes and at three points between neighbours.
    worst_force_error_n: float | None
    #: The same of the velocity.
    worst_velocity_error_m_per_s: float | None
    #: The same where the table is used. Over time: from the ramp's start on. Over position: only positions that the
    #: units of both neighbouring levels reach.
    worst_force_error_in_use_n: float | None
    #: The same of the velocity.
    worst_velocity_error_in_use_m_per_s: float | None
    #: Root mean square of the error where the table is used.
    rms_force_error_n: float | None
    #: The same of the velocity.
    rms_velocity_error_m_per_s: float | None
    #: Pairs of neighbouring levels with different verdicts; a lookup between them says ``mixed``.
    mixed_levels: list[list[float]] | None
    #: Units that do not come to the last position; only of tables over position.
    short: list[Reach] | None
    #: What to know of the table.
    warnings: list[str]
    #: Units that were simulated.
    units: int | None
    #: Those that complete their stroke; the table is about these.
    complete: int | None
    #: Modes in which they differ.
    modes: int | None
    #: Greatest mean force, either sign.
    greatest_mean_force_n: float | None
    #: Standard deviation of the noise of a measured force, for which limits hold.
    noise_n: float | None
    #: Root mean square of the difference of strokes from the mean.
    rms_from_mean_n: float | None
    #: The same from what is expected of a unit after three strokes.
    rms_of_taught_n: float | None
    #: The same with what the stroke has told of its friction so far.
    rms_within_stroke_n: float | None
    #: The same from the mean and the modes that fit the stroke best.
    rms_of_fit_n: float | None
    #: Width of the band that holds 99 % of the strokes, mean over the places.
    band_mean_n: float | None
    #: Its greatest width.
    band_widest_n: float | None
    #: Standard deviation of the friction that a stroke tells, as a share of it; 0.5 and more: it does not tell it.
    friction_deviation: float | None
    #: Rise of the friction, as a share of it, with which one unit in a hundred does not complete its stroke; 1 if
    #: fewer do not with twice the friction.
    friction_margin: float | None
    #: Place (s, m, rad) from which units that complete their stroke move; from there on the watch reports a jam.
    moving_from: float | None


class Reach(Result):
    """Reach."""
    #: Tolerance level.
    n: float
    #: Commanded speed (m/s, rad/s).
    speed: float
    #: Farthest position (m, rad).
    z: float
    #: Verdict at the end of the run.
    verdict: str


class Axis(Result):
    """Axis."""
    #: Level, time, position, speed, row.
    kind: str
    #: 1, s, m, m/s, rad, rad/s.
    unit: str
    #: Value of the first node.
    first: float
    #: Distance between nodes.
    step: float
    #: Number of nodes.
    count: int


class Allocation(Result):
    """What ``allocate`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str
    #: Cost of all tolerances that were chosen.
    cost: float
    #: Lower bound of the cost, proven for measures taken as linear at the result; of measures with kinks, and of
    #: malfunctions, the cost of the widest tolerances.
    bound: float
    #: Cost of the tolerances that the scene states; None if no process can hold one of them.
    cost_before: float | None
    #: One entry for each tolerance that was chosen.
    tolerances: list[Chosen]
    #: What was required. A requirement that is judged separately at the lower and the upper limit has two entries,
    #: see ``side``.
    requirements: list[Required]
    #: By how much the cost falls if all requirements that bind are relaxed at once; None unless several bind.
    price_together: float | None
    #: What the full model says of every measure with limits, at the chosen tolerances.
    check: list[Checked]
    #: Number of units drawn for the check.
    samples: int
    #: Share of these units with all measures within their limits.
    good: float | None
    #: Other units, which confirm the share of malfunctions; None unless that is required.
    malfunctions: Confirmation | None
    #: Whether that holds over all unknowns; None unless it is required and something is unknown.
    uncertain: UncertainRequirement | None
    #: Cost against defects; empty without ``csv`` and ``plot``.
    curve: list[CurvePoint]
    #: What to know before trusting it.
    warnings: list[str]


class UncertainRequirement(Result):
    """Uncertain requirement."""
    #: Share of the units that may malfunction.
    allowed: float
    #: Whether no more do over the whole interval of 95 %.
    holds: bool
    #: The unknown values.
    unknowns: list[Unknown]
    #: Dimensions and gaps of which measured parts leave something open.
    measured: list[str]
    #: Units that were simulated at each value.
    units_each: int
    #: Share that crawls, jams or needs more than the force limit.
    malfunctions: Expected
    #: Share that crawls.
    crawls: Expected
    #: Share that jams.
    jammed: Expected
    #: Share that overruns the command.
    overruns: Expected
    #: Share that needs more than the force limit; None without one.
    over_limit: Expected | None
    #: Greatest force (N; torque, N·m) that half of the units do not exceed; None if a run ends before the ramp.
    median_force: Expected | None
    #: The same of 95 % of the units.
    high_force: Expected | None
    #: The unknowns that decide which share malfunctions, the strongest first; none that chance explains.
    decides: list[Decider]
    #: The values that were tried, in the order in which they were.
    values: list[TriedValue]
    #: Units without a verdict.
    undecided: int
    #: Units among these with a parameter that is out of bounds.
    out_of_bounds: int


class Chosen(Result):
    """Chosen."""
    #: Name of the dimension, or of part, feature and tolerance.
    name: str
    #: Half the distance of the limits of a dimension, or width of a zone.
    tolerance: float
    #: Mm or °.
    unit: str
    #: The tolerance that the scene states.
    before: float
    #: Name of the process, if it has one.
    process: str | None
    #: Of this tolerance.
    cost: float
    #: The line for the scene, with six digits, rounded down.
    written: str
    #: Part of the feature; None for a dimension that is of no part.
    part: str | None
    #: The feature, or the dimension.
    feature: str
    #: The tolerance as it stands on a drawing.
    callout: str


class Required(Result):
    """Required."""
    #: Name of the measure; None if the requirement is on all together.
    measure: str | None
    #: Worst-case, rss, rss-off-centre, ppm, ppk, malfunction; a required yield is ppm with ``measure`` None.
    requirement: str
    #: Which limit: lower or upper; None if it is on both.
    side: str | None
    #: The figure reached: tolerance, extreme value, ppm, Ppk or percent.
    found: float
    #: The figure allowed.
    allowed: float
    #: Unit of both: that of the measure, ppm or %; empty if they have none.
    unit: str
    #: By how much the cost falls if the requirement is relaxed by ``price_of``.
    price: float
    #: 1 % wider limits, 10 % more ppm, or 10 % more malfunctions.
    price_of: str


class Checked(Result):
    """Checked."""
    #: Name of the measure.
    name: str
    #: Unit of its value: mm, °, N, N/mm, g, N·mm, MPa or s; empty for a plain number.
    unit: str
    #: Lowest and highest value within all limits and zones; None where there is no bound.
    worst_case: list[float | None]
    #: Tolerance by root sum of squares; None if slopes do not describe the measure.
    rss: float | None
    #: Defects if the measure were normal, in the middle of its limits, with three standard deviations equal to
    #: ``rss``.
    rss_ppm: float | None
    #: Defects by importance sampling or subset simulation; None if no figure can be trusted.
    ppm: float | None
    #: Standard error of ``ppm``.
    ppm_error: float | None
    #: Defects counted among the drawn units, those in which the measure cannot be computed among them.
    counted_ppm: float
    #: 95 % confidence interval of the counted defects (ppm).
    counted_interval: list[float]
    #: Ppk of the drawn units.
    ppk: float | None


class Confirmation(Result):
    """Confirmation."""
    #: Units that were simulated, none of which the search has seen.
    units: int
    #: Those of them that malfunction or come to no verdict.
    failed: int
    #: Their share.
    share: float
    #: What the share of the production is at most, with 95 % confidence.
    at_most: float
    #: Share of the units of the search that it aimed at.
    target: float
    #: How many choices were counted, each in other units.
    rounds: int


class CurvePoint(Result):
    """Curve point."""
    #: Share of units with any measure outside of its limits, in a million.
    ppm: float
    #: Cost of the cheapest tolerances for that.
    cost: float
    #: These tolerances, in the order and units of ``tolerances`` above.
    tolerances: list[float]


class Report(Result):
    """What ``run`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str
    #: Name of the drive that verdicts and forces are about.
    drive: str
    #: N, or N·m of a drive that turns. Then all forces here are torques (N·m), speeds rad/s and travel rad.
    effort_unit: str
    #: Names of the files that were written.
    files: list[str]
    #: Size of the table.
    table_bytes: int
    #: Greatest interpolation error of the table's force that was found, release included.
    worst_force_error_n: float
    #: Levels grouped: neighbours with the same verdict.
    ranges: list[Range]
    #: Every level of the sweep, of a slide simulated over the stroke.
    levels: list[Level]
    #: Units drawn at random, each simulated over the same run as the levels; None where nothing varies.
    population: Statistics | None
    #: What the production does over all unknowns; None if nothing is unknown.
    uncertain: UncertainAnswer | None
    #: How the measures of the product vary; None without a product.
    tolerance: Analysis | None
    #: What to know before trusting the runs.
    warnings: list[str]


class Kernel(Result):
    """What ``kernel`` finds."""
    #: Version of this format.
    json_version: int
    #: Name of the file or folder that was written.
    file: str
    #: Hash of the scene's physics, hexadecimal, as in flash tables; missing for a mechanism without a drive or with
    #: several.
    scene_hash: str | None
    #: What to know before trusting the result.
    warnings: list[str]


class Tolerance(Result):
    """What ``tolerance`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str
    #: Pseudo-random, latin-hypercube, scrambled-sobol.
    method: str | None
    #: Units of all designs together; with lhs and sobol that is ``samples`` times ``replicates``.
    samples: int | None
    #: Independent designs that they were split into.
    replicates: int | None
    #: Seed of the production.
    seed: int | None
    #: Share of units with all measures within their limits; None if no measure has limits.
    yield_of_all: Estimate | None
    #: Measures of the product, in the order of the scene.
    measures: list[Measure] | list[StatedGap] | list[Effect]
    #: Correlations of the measures, row by row.
    correlation: list[list[float]] | None
    #: Lower and upper end of the 95 % interval of each correlation; None where a measure does not vary.
    correlation_intervals: list[list[list[float | None]]] | None
    #: Sums of measures that must stay positive, such as two opposite gaps.
    sums: list[Sum] | None
    #: What to know before trusting a figure.
    notes: list[str] | None
    #: Clearances, middle positions and closing levels of the pins, the derived columns of Table 2 of the paper; only
    #: of a slide with a product.
    derived_m: Derived | None
    #: The pair of gaps that closes at the lowest level; only of a slide with a product.
    tightest: Closes | None
    #: The measures of each unit; if they were asked for.
    draws: Columns | None
    #: What to know before trusting the result.
    warnings: list[str]
    #: Full-factorial, two-level, three-level.
    design: str | None
    #: Combinations that were computed.
    runs: int | None
    #: The tolerances that were varied.
    factors: list[str] | None


class Analysis(Result):
    """Analysis."""
    #: Title of the scene.
    title: str
    #: Pseudo-random, latin-hypercube, scrambled-sobol.
    method: str
    #: Units of all designs together; with lhs and sobol that is ``samples`` times ``replicates``.
    samples: int
    #: Independent designs that they were split into.
    replicates: int
    #: Seed of the production.
    seed: int
    #: Share of units with all measures within their limits; None if no measure has limits.
    yield_of_all: Estimate | None
    #: Measures of the product, in the order of the scene.
    measures: list[Measure]
    #: Correlations of the measures, row by row.
    correlation: list[list[float]]
    #: Lower and upper end of the 95 % interval of each correlation; None where a measure does not vary.
    correlation_intervals: list[list[list[float | None]]]
    #: Sums of measures that must stay positive, such as two opposite gaps.
    sums: list[Sum]
    #: What to know before trusting a figure.
    notes: list[str]


class Measure(Result):
    """Measure."""
    #: Name of the measure.
    name: str
    #: Unit of its values; empty for plain numbers.
    unit: str
    #: Mean of the units drawn.
    mean: float
    #: Standard deviation.
    sd: float
    #: Skewness; None if the measure does not vary.
    skew: float | None
    #: Kurtosis, 3 for a normal distribution; None if the measure does not vary.
    kurtosis: float | None
    #: Least value drawn.
    min: float
    #: Greatest value drawn.
    max: float
    #: Value that 0.135 % of the units are below.
    q00135: float
    #: Value that half of the units are below.
    median: float
    #: Value that 99.865 % of the units are below.
    q99865: float
    #: Units in which the measure could not be computed.
    undefined: int
    #: Value at the nominal values of the drawing.
    nominal: float | None
    #: Lower and upper limit; None for a side without limit.
    limits: list[float | None]
    #: Distance of the limits over 6σ; None unless there are two.
    pp: float | None
    #: Distance from the mean to the nearer limit over 3σ.
    ppk: float | None
    #: Whether the measure is near enough to normal for ``pp`` and ``ppk``.
    normal: bool
    #: Pp by the 0.135 % and 99.865 % points (ISO 22514-2), where the measure is not normal.
    pp_by_points: float | None
    #: Ppk by these points and the median, where the measure is not normal.
    ppk_by_points: float | None
    #: Defects per million below the lower and above the upper limit, counted or estimated, whichever has the smaller
    #: standard error.
    dpm: list[Defects | None]
    #: Share within the limits, counted.
    yield_: float | None
    #: Taguchi's loss, if the scene states one.
    loss: Loss | None
    #: The same figures with standard errors and intervals.
    estimates: Estimates
    #: Least and greatest value within all limits and zones: exact for a linear measure, by corners and a search for
    #: any other; None where there is no bound, as beside a pole.
    worst_case: list[float | None]
    #: The same by slopes in the middle of the limits: no bound for a measure that is not linear; None if it has no
    #: slopes there.
    worst_case_linear: list[float] | None
    #: Root sum of squares; None where slopes do not describe the measure.
    rss: Rss | None
    #: Moments of second order; None where a quadratic does not describe the measure.
    second_order: SecondOrder | None
    #: Moments by quadrature, as good as exact, where the measure is not linear and has few variables.
    quadrature: Quadrature | None
    #: Whether the contributors' ``percent`` is by total Sobol' indices.
    by_indices: bool
    #: Tolerances by falling share of the variance.
    contributors: list[Contributor]


class Estimates(Result):
    """Estimates."""
    #: As in measure.
    mean: Estimate
    #: As in measure.
    sd: Estimate
    #: As in measure.
    skew: Estimate | None
    #: As in measure.
    kurtosis: Estimate | None
    #: As in measure.
    q00135: Estimate
    #: As in measure.
    median: Estimate
    #: As in measure.
    q99865: Estimate
    #: As in measure.
    pp: Estimate | None
    #: As in measure.
    ppk: Estimate | None
    #: As in measure.
    pp_by_points: Estimate | None
    #: As in measure.
    ppk_by_points: Estimate | None
    #: Defects per million below the lower limit, counted.
    dpm_below: Estimate | None
    #: Defects per million above the upper limit, counted.
    dpm_above: Estimate | None
    #: As in measure.
    yield_: Estimate | None


class Defects(Result):
    """Defects."""
    #: Defects per million.
    dpm: float
    #: Standard error.
    error: float | None
    #: Where the figure comes from: counted, importance-sampling, subset-simulation.
    source: str
    #: Lower and upper end of the 95 % interval.
    interval: list[float | None]
    #: Distance of the most probable defect from the mean, in standard deviations; None if the search did not reach
    #: one.
    reliability: float | None
    #: How often the measure was computed for it.
    evaluations: int | None


class Loss(Result):
    """Loss."""
    #: Value without loss, in the unit of the measure.
    target: float
    #: K: cost by the square of the unit of the measure.
    coefficient: float
    #: Mean loss of a unit.
    mean: Estimate
    #: Signal-to-noise ratio (dB).
    signal_to_noise: float | None
    #: Half-width ± of limits at which the loss equals the cost of repairing a unit (``loss.repair`` of the measure).
    balanced_tolerance: float | None


class Rss(Result):
    """Rss."""
    #: Value where every dimension is in the middle of its limits.
    middle: float
    #: Root sum of squares ± about it.
    tolerance: float
    #: 1.5 times that.
    bender: float
    #: 1.6 times that.
    gilson: float
    #: The same with a factor by the number of tolerances.
    modified: float
    #: Standard deviation of first order.
    sd: float


class SecondOrder(Result):
    """Second order."""
    #: Mean.
    mean: float
    #: Mean minus the value at the means of the dimensions.
    mean_shift: float
    #: Standard deviation.
    sd: float
    #: Skewness; None if the measure does not vary.
    skew: float | None
    #: Kurtosis; None if the measure does not vary.
    kurtosis: float | None


class Quadrature(Result):
    """Quadrature."""
    #: Mean.
    mean: float
    #: Standard deviation.
    sd: float
    #: Skewness.
    skew: float
    #: Kurtosis.
    kurtosis: float


class Contributor(Result):
    """Contributor."""
    #: Dimension, or part, feature and tolerance.
    name: str
    #: Share of the variance (%), of first order; of the total Sobol' indices where curvature changes the variance by
    #: more than 1 %.
    percent: float | None
    #: Change of the measure by that of the dimension.
    slope: float | None
    #: Unit of the dimension; None without a slope.
    per: str | None
    #: How far the whole tolerance moves the measure to either side.
    reach: float
    #: Sobol' index of first order, where the measure is not linear.
    sobol_first: float | None
    #: Total Sobol' index, where the measure is not linear.
    sobol_total: float | None


class Sum(Result):
    """Sum."""
    #: Name of the sum.
    name: str
    #: Unit of its values.
    unit: str
    #: Mean of second order.
    mean: float
    #: Standard deviation with the correlation that follows from the drawing.
    sd: float
    #: Correlation of its measures; None unless there are two.
    correlation: float | None
    #: Its 95 % interval.
    correlation_interval: list[float | None] | None
    #: Units per million in which the sum is negative, counted or estimated, whichever has the smaller standard error.
    model: Defects
    #: The same, counted.
    counted: Estimate
    #: The same if the sum were normal.
    normal_ppm: float
    #: The same if its measures moved together, as eq. 9 of the paper has it.
    eq9_ppm: float
    #: The same if its measures were independent.
    independent_ppm: float


class Derived(Result):
    """Derived."""
    #: Tolerance level of the columns.
    n: float
    #: The four pins.
    pins: list[Pin]
    #: Differences between the middle positions of the pins across (toe-out); None unless the pins are four corners
    #: with all gaps.
    toes_across: Toes | None
    #: The same up and down.
    toes_up_down: Toes | None


class Pin(Result):
    """Pin."""
    #: Name of the pin.
    name: str
    #: Left, right, rail and wall (m); None where there is no contact.
    gaps: list[float | None]
    #: Left and right together.
    across: Pair | None
    #: Rail and wall together.
    up_down: Pair | None


class Pair(Result):
    """Pair."""
    #: Both gaps together (m).
    clearance: float
    #: Half of the second gap minus the first (right − left, wall − rail): how far the middle of the clearance is from
    #: the pin (m).
    mean: float
    #: Level at which both gaps together are zero; None if nothing varies.
    closes_at: float | None


class Toes(Result):
    """Toes."""
    #: Right minus left of the back pins (m).
    back: float
    #: Right minus left of the front pins (m).
    front: float
    #: Front minus back of the left pins (m).
    left: float
    #: Front minus back of the right pins (m).
    right: float
    #: ``front`` minus ``back`` (m).
    front_minus_back: float
    #: ``right`` minus ``left`` (m).
    right_minus_left: float


class Closes(Result):
    """Closes."""
    #: Name of the pin.
    pin: str
    #: Across or up-down.
    direction: str
    #: Level at which the pair closes.
    n: float


class StatedGap(Result):
    """Given."""
    #: Pin and surface.
    name: str
    #: Mean gap (mm).
    mean: float
    #: Standard deviation (mm).
    sd: float


class Effect(Result):
    """Effect."""
    #: Name of the measure.
    name: str
    #: Unit of its values.
    unit: str
    #: Runs in which it has no value; if there are any, ``mean``, ``effects`` and ``shares`` are None.
    undefined: int
    #: Mean over all runs.
    mean: float | None
    #: Least and greatest value of all runs.
    range: list[float]
    #: For each factor: mean at its highest level minus mean at its lowest.
    effects: list[float] | None
    #: For each factor: its share of the sum of squares of all factors.
    shares: list[float] | None


class Shard(Result):
    """A shard of `tolerance` or `population`."""
    #: Version of this format.
    json_version: int
    #: Number of the shard, from 1 on.
    shard: int
    #: How many shards there are.
    of: int
    #: Units in it.
    units: int
    #: The file that was written.
    file: str
    #: What to know before trusting the result.
    warnings: list[str]


class Precision(Result):
    """What ``precision`` finds."""
    #: Version of this format.
    json_version: int
    #: Title of the scene.
    title: str | None
    #: Tolerance level.
    n: float | None
    #: How well the reference itself is known: below that no error can be judged.
    floors: list[Floor] | None
    #: A solver at a setting, on a problem.
    points: list[Point] | None
    #: What to know before trusting the result.
    warnings: list[str]
    #: Seed of the random combinations.
    seed: int | None
    #: One parameter varied, the others as in the scene.
    one_at_a_time: list[Trial] | None
    #: The order of the values of random combinations.
    factors: list[str] | None
    #: Random combinations.
    random: list[Trial] | None


class Floor(Result):
    """Floor."""
    #: Opening or stroke; run, of a mechanism.
    problem: str
    #: Greatest difference of the two finest reference runs (% of the peak force or torque).
    max: float
    #: Its root mean square (%).
    rms: float
    #: Greatest difference from 50 ms on (%).
    late_max: float
    #: Its root mean square from 50 ms on (%).
    late_rms: float


class Point(Result):
    """Point."""
    #: Opening or stroke; run, of a mechanism.
    problem: str
    #: Integration scheme of a controller, or ``desk``.
    solver: str
    #: F32 or f64.
    scalar: str
    #: What the setting is: step_s, force_n or share.
    knob: str
    #: Step (s), tolerance (N), or tolerance as a share of the mechanism's own speed.
    setting: float
    #: Least time of the integration alone; None if the run left the finite range.
    run_ms: float | None
    #: Greatest error of the force (% of its peak).
    max_percent: float | None
    #: Its root mean square (%).
    rms_percent: float | None
    #: Greatest error from 50 ms on (%).
    late_max_percent: float | None
    #: Its root mean square from 50 ms on (%).
    late_rms_percent: float | None
    #: When the motion left the finite range; None if it did not.
    blew_up_at_s: float | None


class Trial(Result):
    """Trial."""
    #: Integration scheme.
    integrator: str
    #: Parameter that was varied, or random.
    factor: str
    #: Its value; of a random combination all values in the order of factors.
    values: list[float]
    #: How the run went; None if it left the finite range and stopped.
    indicators: Indicators | None


class Indicators(Result):
    """Indicators."""
    #: Greatest error of the energy balance, divided by the energy exchanged.
    defect: float
    #: Greatest elastic energy, divided by the energy available to build it up.
    filling: float
    #: Greatest gain of energy of a unit at rest, divided by the energy exchanged; None if that run diverged.
    rise: float | None
    #: Momentum by which forces and motion do not balance, as a share.
    imbalance: float
    #: Greatest error that a step estimates of itself, as a force, as a share of the peak.
    doubtful_force: float
    #: Difference to a run with finer steps, as a share of the peak force.
    difference: float | None
    #: Greatest error from 50 ms on, as a share of the peak force; None if there is nothing to compare it with.
    error: float | None
    #: Whether the run itself says that its step is too large.
    warned: bool


class Fmu(Result):
    """What ``fmu`` finds."""
    #: Version of this format.
    json_version: int
    #: The file that was written.
    file: str
    #: 3.0 or 2.0.
    fmi_version: str
    #: What importers compare: the ``instantiationToken`` of FMI 3.0, the ``guid`` of FMI 2.0.
    token: str
    #: Step of the kernel.
    step_s: float
    #: Parameters, inputs and outputs.
    variables: list[Variable]
    #: What to know before trusting the result.
    warnings: list[str]


class Variable(Result):
    """Variable."""
    #: Name of the variable.
    name: str
    #: Unit of its value.
    unit: str
    #: Fixed parameter, tunable parameter, input, output.
    causality: str
    #: Value unless it is set; outputs have none.
    start: float | None
