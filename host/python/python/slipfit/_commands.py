"""Commands as functions. Generated from the command line.

A keyword is the option of that name. Options that are None are left out. Every function has these keywords, too:

progress: a function of what is done, how much, and of how much; or whether a line on standard error shows it. Without it a line
    is shown where standard error is a terminal.
picture: whether the result has the pictures of ``plot`` in ``pictures``. Without it, it has them in notebooks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, overload

from slipfit import results
from slipfit._call import Files, Option, Paths, Table, call, paths_of
from slipfit._progress import Progress


class SceneCommands:
    """The commands that work on a scene."""

    def _call(
        self, kind: Any, command: str, options: Mapping[str, Option], others: Sequence[Table] = (), **wanted: Any
    ) -> Any:
        raise NotImplementedError

    def run(
        self,
        *,
        out: Option = None,
        drive: Option = None,
        n: Option = None,
        units: Option = None,
        threads: Option = None,
        progress: Progress = None,
    ) -> results.Report:
        """The main job: says at which tolerance levels the product works and what force it takes.

        For slides and mechanisms. Analyses the tolerances, where the scene has a product. Simulates the opening and
        the whole stroke of a slide, or the run of a mechanism, at every level, and units of the production. Writes
        the flash table over time, and a page with all pictures.

        Args:
            out: Folder for the report and the other files; if not given, slipfit-out with a folder named after the
                scene. It gets report.html, table.bin, sweep.csv and the figures; for a product also tolerance.csv and
                pictures of its measures.
            drive: Name of the drive, where a mechanism has several.
            n: Tolerance levels from A to B, such as -3:5:0.1, or one level; positive is tighter. If not given, the
                levels are the scene's `sweep.n`.
            units: Units of the production to simulate one by one; 512 if not given. `slipfit population` simulates
                more units and tells more about them. With `[uncertain]` in the scene four times as many more are
                simulated.
            threads: Number of threads; all cores if not given. The result does not depend on it.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"out": out, "drive": drive, "n": n, "units": units, "threads": threads}
        found: results.Report = self._call(results.Report, "run", options, progress=progress)
        return found

    def check(
        self,
        *,
        n: Option = None,
        plot: Option = None,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Check:
        """Checks a scene: degrees of freedom, gaps at a level, levels that close them, warnings.

        Of a product without a slide or mechanism it prints the nominal values of the measures. Warnings do not change
        the exit code.

        Args:
            n: Tolerance level at which the gaps are shown; positive is tighter. If not given: 0.
            plot: Draws a mechanism with its joints and gaps as SVG; not for slides.
            picture: Whether the result has pictures; if None, in notebooks.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"n": n, "plot": plot}
        found: results.Check = self._call(results.Check, "check", options, picture=picture, progress=progress)
        return found

    @overload
    def tolerance(
        self,
        *,
        samples: Option = None,
        method: Option = None,
        replicates: Option = None,
        seed: Option = None,
        threads: Option = None,
        shard: None = None,
        out: Option = None,
        resume: bool = False,
        n: Option = None,
        csv: Option = None,
        plots: Option = None,
        draws: bool = False,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Tolerance: ...
    @overload
    def tolerance(
        self,
        *,
        samples: Option = None,
        method: Option = None,
        replicates: Option = None,
        seed: Option = None,
        threads: Option = None,
        shard: str,
        out: Option = None,
        resume: bool = False,
        n: Option = None,
        csv: Option = None,
        plots: Option = None,
        draws: bool = False,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Tolerance | results.Shard: ...
    def tolerance(
        self,
        *,
        samples: Option = None,
        method: Option = None,
        replicates: Option = None,
        seed: Option = None,
        threads: Option = None,
        shard: Option = None,
        out: Option = None,
        resume: bool = False,
        n: Option = None,
        csv: Option = None,
        plots: Option = None,
        draws: bool = False,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Tolerance | results.Shard:
        """Shows how measures vary: Monte Carlo, worst case, RSS, contributors, capability.

        For scenes with a product. Where the scene has a slide as well, the output ends with the clearances of its
        pins at the level `n`. Of a slide with stated gaps it shows the gaps and these clearances, and draws nothing.

        Args:
            samples: Units to draw, in each replicate; if not given 5000.
            method: How units are drawn. Allowed: mc, lhs, sobol, factorial, taguchi, taguchi3. If not given: mc.
            replicates: Independent repetitions, 1 to 1024; if not given 8 for lhs and sobol, 1 for mc. Standard
                errors follow from their spread.
            seed: Seed of the production; if not given 1. The same scene, seed and number give the same unit on every
                machine.
            threads: Number of threads; all cores if not given. The result does not depend on it.
            shard: Works on part I of N and writes it to `out`; `slipfit merge` joins the parts. I is 1 to N. `auto`
                takes the part of this task in a SLURM job array.
            out: Writes the results of the units to a file that `slipfit merge` reads.
            resume: Continues where an interrupted run with the same `out` stopped.
            n: Tolerance level at which a slide's clearances are shown; positive is tighter. The default is the level
                that closes the first pair of gaps, to a hundredth: 3.43 for the paper's slide.
            csv: Writes the measures' statistics as CSV.
            plots: Draws histograms, contributors and correlations as SVG files in a folder.
            draws: Whether the result has the measures of each unit.
            picture: Whether the result has pictures; if None, in notebooks.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"samples": samples, "method": method, "replicates": replicates, "seed": seed, "threads": threads, "shard": shard, "out": out, "resume": resume, "n": n, "csv": csv, "plots": plots}
        found: results.Tolerance | results.Shard = self._call(results.Tolerance | results.Shard, "tolerance", options, draws=draws, picture=picture, progress=progress)
        return found

    def allocate(
        self,
        *,
        require: Option = None,
        force_limit: Option = None,
        units: Option = None,
        samples: Option = None,
        seed: Option = None,
        threads: Option = None,
        write: Option = None,
        csv: Option = None,
        plot: Option = None,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Allocation:
        """Chooses the cheapest tolerances that meet the requirements.

        A requirement limits how measures vary, or how many units of a slide malfunction. It stands in the scene
        (`require` of a measure, `[allocate]`) or follows `require`. Tolerances with a `cost` are chosen, the others
        stay as they are. Where even the tightest tolerances do not meet a requirement, the command says by how much
        and exits with 1.

        Args:
            require: Requirement instead of those of the scene, such as rss, ppm=100 or malfunction=0.01. For every
                measure with limits: rss, rss-off-centre, worst-case, ppm=100, ppk=1.33. For all measures together:
                yield=0.999, the share of units with all measures within their limits. For the units of a slide:
                malfunction=0.01, the permitted share of units that crawl or jam over the whole stroke.
            force_limit: Greatest force (N) of the motor; units that need more count as malfunctioning. Only together
                with `require` malfunction=SHARE`.
            units: Units to simulate for every set of tolerances that is tried. Only for requirements on malfunction.
                The tolerances found are confirmed with eight times as many other units, or more if the share is
                small. More units find cheaper tolerances and take longer. If not given: 2048.
            samples: Units to draw for the check of the tolerances found. If not given: 1000000.
            seed: Seed of the production. If not given: 1.
            threads: Number of threads; all cores if not given. The result does not depend on it.
            write: Writes the scene with the tolerances found.
            csv: Writes the curve of cost against defects as CSV. A row has a number of defects, 10,000 to 1 ppm, the
                least cost for it, and the tolerances.
            plot: Draws the curve of cost against defects as SVG.
            picture: Whether the result has pictures; if None, in notebooks.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"require": require, "force_limit": force_limit, "units": units, "samples": samples, "seed": seed, "threads": threads, "write": write, "csv": csv, "plot": plot}
        found: results.Allocation = self._call(results.Allocation, "allocate", options, picture=picture, progress=progress)
        return found

    def simulate(
        self,
        *,
        n: Option = None,
        unit: Option = None,
        seed: Option = None,
        correlation: Option = None,
        csv: Option = None,
        plot: Option = None,
        page: Option = None,
        every: Option = None,
        audit: bool = False,
        stroke: bool = False,
        error: Option = None,
        step: Option = None,
        integrator: Option = None,
        scalar: Option = None,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Simulation:
        """Simulates one unit: speed and drive force over time.

        For slides and mechanisms. The unit is that of a tolerance level (`n`) or one of the production (`unit`). A
        slide runs its opening (`run.duration`) unless `stroke` is given. The desk computes the run by error-
        controlled steps. It also says how far the controller is off, which takes steps of one length. With `step`,
        `integrator`, `scalar` or `audit` the run shown is the controller's, and its error against the desk's is
        printed.

        For slides only: `audit`, `stroke`, `scalar`.

        Args:
            n: Tolerance level, for all gaps or one for each; positive is tighter. One for each gap is a list with
                commas. A slide takes sixteen levels: left, right, rail and wall of each of four pins, whether the
                scene has that gap or not. A mechanism takes them in the order in which `slipfit check` lists its
                gaps. If not given: 0.
            unit: Number of a unit of the production, instead of a tolerance level. The units are those of `slipfit
                population`, which runs the whole stroke: add `stroke` for the same run.
            seed: Seed of the production, for `unit`. If not given: 1.
            correlation: Correlation between the gaps, for `unit`. It holds for any two gaps that the scene states by
                mean and standard deviation. If not given: 0.
            csv: Writes the run as CSV, in SI units. Of a slide the columns are time, speed and force along the drive,
                displacement of the centre of mass. Of a mechanism they are time, the force of each drive, and the
                motion of each body. Their heads have units.
            plot: Draws speed and force over time as SVG.
            page: Writes a page with the run and an animation of the bodies on their joints, gaps enlarged, by the
                desk's run.
            every: Interval between the samples in the output, such as 1ms or 500us; a bare number is in ms. If not
                given: 1ms.
            audit: Prints the energy balance of the controller's run. Work of the drive = gains + losses + defect. The
                defect is the error of the integration scheme: positive where the scheme lost energy, negative where
                it added some.
            stroke: Runs the whole stroke (run.stroke) instead of the opening (run.duration); for slides.
            error: Error that one step of the desk may make, such as 1e-6; replaces run.error. Of a slide it is a
                share of the drive's greatest force, of a mechanism a share of its own speed. Smaller is more exact
                and slower.
            step: Length of the controller's steps, such as 1ms; a bare number is in µs.
            integrator: Integration scheme of the controller. Allowed: semi-implicit-euler, rk4, linearly-implicit-
                euler, rodas3, implicit-euler, rodas4, sdirk2, extrapolated.
            scalar: Number type of the controller. Allowed: f32, f64.
            picture: Whether the result has pictures; if None, in notebooks.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"n": n, "unit": unit, "seed": seed, "correlation": correlation, "csv": csv, "plot": plot, "page": page, "every": every, "audit": audit, "stroke": stroke, "error": error, "step": step, "integrator": integrator, "scalar": scalar}
        found: results.Simulation = self._call(results.Simulation, "simulate", options, columns=True, picture=picture, progress=progress)
        return found

    def sweep(
        self,
        *,
        drive: Option = None,
        n: Option = None,
        over: Option = None,
        units: Option = None,
        csv: Option = None,
        plot: Option = None,
        stroke: bool = False,
        error: Option = None,
        step: Option = None,
        integrator: Option = None,
        scalar: Option = None,
        threads: Option = None,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Sweep:
        """Simulates a slide or a mechanism at many tolerance levels, or values of any key: where does it run, crawl,
        jam?

        A slide runs its opening (`run.duration`) unless `stroke` is given; a mechanism runs for `run.duration`, or to
        the end of its stroke. The desk computes the runs by error-controlled steps. With `step`, `integrator` or
        `scalar` the controller computes them by steps of one length, and a warning names the levels whose runs cannot
        be trusted.

        For slides only: `step`, `integrator`, `scalar`, `stroke`.

        Args:
            drive: Name of the drive, where a mechanism has several.
            n: Tolerance levels from A to B, such as -3:5:0.1, or one level; positive is tighter. If not given, the
                levels are the scene's `sweep.n`.
            over: Goes over the values of a key of the scene, from A to B, such as friction.coefficient=0.1:0.4:0.02;
                given twice, over two keys. A key is any that `set` takes with a number, in the key's unit, or n, the
                tolerance level. At each value, or combination of two, the unit of level n = 0 or of the one `n` is
                simulated.
            units: Units of the production to simulate at every value of `over`: which share of them malfunctions. The
                units are the same at every value. A slide's run the opening unless `stroke` is given.
            csv: Writes a row of figures for every level, or value, as CSV.
            plot: Draws verdict and force over the tolerance level, or over the keys, as SVG.
            stroke: Runs the whole stroke (run.stroke) instead of the opening (run.duration); for slides.
            error: Error that one step of the desk may make, such as 1e-6; replaces run.error. Of a slide it is a
                share of the drive's greatest force, of a mechanism a share of its own speed. Smaller is more exact
                and slower.
            step: Length of the controller's steps, such as 1ms; a bare number is in µs.
            integrator: Integration scheme of the controller. Allowed: semi-implicit-euler, rk4, linearly-implicit-
                euler, rodas3, implicit-euler, rodas4, sdirk2, extrapolated.
            scalar: Number type of the controller. Allowed: f32, f64.
            threads: Number of threads; all cores if not given. The result does not depend on it.
            picture: Whether the result has pictures; if None, in notebooks.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"drive": drive, "n": n, "over": over, "units": units, "csv": csv, "plot": plot, "stroke": stroke, "error": error, "step": step, "integrator": integrator, "scalar": scalar, "threads": threads}
        found: results.Sweep = self._call(results.Sweep, "sweep", options, columns=True, picture=picture, progress=progress)
        return found

    @overload
    def population(
        self,
        *,
        drive: Option = None,
        units: Option = None,
        seed: Option = None,
        opening: bool = False,
        force_limit: Option = None,
        correlation: Option = None,
        rare: bool = False,
        csv: Option = None,
        plot: Option = None,
        plot_distance: Option = None,
        page: Option = None,
        shard: None = None,
        out: Option = None,
        resume: bool = False,
        threads: Option = None,
        columns: bool = False,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Population: ...
    @overload
    def population(
        self,
        *,
        drive: Option = None,
        units: Option = None,
        seed: Option = None,
        opening: bool = False,
        force_limit: Option = None,
        correlation: Option = None,
        rare: bool = False,
        csv: Option = None,
        plot: Option = None,
        plot_distance: Option = None,
        page: Option = None,
        shard: str,
        out: Option = None,
        resume: bool = False,
        threads: Option = None,
        columns: bool = False,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Population | results.Shard: ...
    def population(
        self,
        *,
        drive: Option = None,
        units: Option = None,
        seed: Option = None,
        opening: bool = False,
        force_limit: Option = None,
        correlation: Option = None,
        rare: bool = False,
        csv: Option = None,
        plot: Option = None,
        plot_distance: Option = None,
        page: Option = None,
        shard: Option = None,
        out: Option = None,
        resume: bool = False,
        threads: Option = None,
        columns: bool = False,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Population | results.Shard:
        """Simulates units of a production one by one: how many malfunction, and why.

        For slides and mechanisms with a drive. Every unit has gaps of its own. Gaps that are measures follow from the
        product's tolerances; the others are drawn from the mean and the standard deviation in the scene. With
        `[vary]` in the scene friction, stiffness, damping, mass, gain, ramp and the direction of gravity vary, too.
        With `[uncertain]` four times as many units more are simulated, and the answer covers the unknown values. A
        slide runs the whole stroke unless `opening` is given, a mechanism `run.duration` or to the end of its stroke.

        For slides only: `opening`.

        Args:
            drive: Name of the drive, where a mechanism has several.
            units: Units to simulate. If not given: 5000.
            seed: Seed of the production. If not given: 1.
            opening: Runs the opening (run.duration) instead of the whole stroke.
            force_limit: Greatest force (N) of the motor, or torque (N·m), driving or braking; units that need more
                count as malfunctioning.
            correlation: Correlation between any two gaps that the scene states by mean and standard deviation. If not
                given: 0.
            rare: Also estimates the probability of rare malfunctions, by subset simulation; takes seconds to minutes.
                There is an estimate for each kind of malfunction (crawls, jams, over the force limit) on each side
                (tight units, loose units).
            csv: Writes a row for every unit as CSV. Its columns: number of the unit, tightness (σ, mean over its
                gaps), breakaway time, peak force, settled force, final velocity, end of the run, travel, verdict,
                whether the desk decided it, then every gap (m). Units stand in the names; what a unit does not have
                is empty.
            plot: Draws the peak force over the tightness of the units as SVG, and marks those that malfunction.
            plot_distance: Draws which share malfunctions over the distance from the mean unit, as SVG. At each
                distance it compares the unit with all gaps tighter, the unit with all gaps looser, and random
                combinations of gaps.
            page: Writes a page with all results and pictures, and an animation of one unit of each verdict.
            shard: Works on part I of N and writes it to `out`; `slipfit merge` joins the parts. I is 1 to N. `auto`
                takes the part of this task in a SLURM job array.
            out: Writes the results of the units to a file that `slipfit merge` reads.
            resume: Continues where an interrupted run with the same `out` stopped.
            threads: Number of threads; all cores if not given. The result does not depend on it.
            columns: Whether the result has a row for each unit, as `csv` writes it.
            picture: Whether the result has pictures; if None, in notebooks.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"drive": drive, "units": units, "seed": seed, "opening": opening, "force_limit": force_limit, "correlation": correlation, "rare": rare, "csv": csv, "plot": plot, "plot_distance": plot_distance, "page": page, "shard": shard, "out": out, "resume": resume, "threads": threads}
        found: results.Population | results.Shard = self._call(results.Population | results.Shard, "population", options, columns=columns, picture=picture, progress=progress)
        return found

    def table(
        self,
        *,
        output: Option = None,
        drive: Option = None,
        over: Option = None,
        speeds: Option = None,
        end: Option = None,
        max_error: Option = None,
        n: Option = None,
        plot: Option = None,
        production: bool = False,
        units: Option = None,
        seed: Option = None,
        noise: Option = None,
        stroke_friction: Option = None,
        period: Option = None,
        bytes: Option = None,
        threads: Option = None,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Table:
        """Makes the flash table of drive force and speed, and says how large and how exact it is.

        For slides and mechanisms with a drive. The table is over the tolerance level and over time, or over position,
        or over position and commanded speed.

        Args:
            output: File to write; its extension gives the format: .bin, .hex, .h (C header) or .rs (Rust). Names in a
                header follow the file's: `slipfit_left_bytes` in left.h. If not given: table.bin.
            drive: Name of the drive, where a mechanism has several.
            over: What the table is over, besides the tolerance level. Over position a slide's whole stroke is
                simulated. Allowed: time, position, position,speed. If not given: time.
            speeds: Commanded speeds from A to B (mm/s, or rad/s where the drive turns) of a table over
                position,speed. Each speed is simulated in place of the scene's `drive.speed`.
            end: Last position of the table (mm, or ° where the drive turns). If not given, it is where the slowest
                level with the verdict "runs" is when its run ends, at most the end of the stroke. Where no level
                runs, it is the farthest position that one reaches.
            max_error: Greatest force error (N, or N·m where the drive turns) that the smallest table may have. The
                error counts where the table is used: over time from the ramp's start on, over position where all
                neighbouring levels get to. Values are stored in 16 bits with a scale (i16), or as f32. If not given,
                the table has every level, the finest steps that fit into its region of flash, and f32.
            n: Tolerance levels from A to B, such as -3:5:0.1, or one level; positive is tighter. If not given, the
                levels are the scene's `sweep.n`.
            plot: Draws the force at every level over time or position, as SVG.
            production: Makes the table of the production instead of the one over the level n. It holds the mean force
                of units that complete their stroke, how far units are from it, and in which modes they differ. From a
                unit's first strokes the controller learns its modes, and from then on knows its force.
            units: Units to simulate for a table of the production. If not given, 10000.
            seed: Seed of the production. If not given, 1.
            noise: White noise of the measured force: its standard deviation, in % of the greatest mean force. The
                limits of the controller's watch hold for this noise. If not given, 2 %.
            stroke_friction: How the friction of a unit differs from stroke to stroke: its standard deviation, in % of
                it. If not given, 3 %.
            period: Interval of the controller's samples (ms). If not given, 1 ms.
            bytes: Greatest size of the table. If not given, 16384 bytes.
            threads: Number of threads; all cores if not given. The result does not depend on it.
            picture: Whether the result has pictures; if None, in notebooks.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"output": output, "drive": drive, "over": over, "speeds": speeds, "end": end, "max_error": max_error, "n": n, "plot": plot, "production": production, "units": units, "seed": seed, "noise": noise, "stroke_friction": stroke_friction, "period": period, "bytes": bytes, "threads": threads}
        found: results.Table = self._call(results.Table, "table", options, picture=picture, progress=progress)
        return found

    def kernel(
        self,
        *,
        output: Option = None,
        crate: Option = None,
        core: Option = None,
        step: Option = None,
        integrator: Option = None,
        progress: Progress = None,
    ) -> results.Kernel:
        """Writes the scene as source code for firmware: a type and its constants.

        For slides and mechanisms.

        Args:
            output: File to write: .rs for slipfit-core, .h for the C library (slides only; `crate` is for any scene).
                Names in a header follow the file's: `slipfit_this_left` in left.h. If not given: scene.rs.
            crate: Writes a crate into this folder, with the folder's name, instead of a file; with functions and a
                header for C. The folder is new or empty, or one that `crate` has written, which is overwritten. The
                step is compiled in that crate alone. So a line in the workspace's Cargo profile, which the crate's
                Cargo.toml shows, keeps the step fast in a firmware image that is built for size.
            core: Folder of slipfit-core, on which the crate depends. If not given, the crate asks crates.io for it.
                crates.io does not have it, so the crate does not build.
            step: Length of the controller's steps, such as 1ms; a bare number is in µs.
            integrator: Integration scheme of the controller. Allowed: semi-implicit-euler, rk4, linearly-implicit-
                euler, rodas3, implicit-euler, rodas4, sdirk2, extrapolated.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"output": output, "crate": crate, "core": core, "step": step, "integrator": integrator}
        found: results.Kernel = self._call(results.Kernel, "kernel", options, progress=progress)
        return found

    def fmu(
        self,
        *,
        output: Option = None,
        fmi: Option = None,
        core: Option = None,
        step: Option = None,
        integrator: Option = None,
        progress: Progress = None,
    ) -> results.Fmu:
        """Packs the controller's kernel as an FMI co-simulation unit (FMU).

        For slides and mechanisms. The kernel is compiled on this machine, which needs Cargo. The FMU runs on machines
        of the same kind only.

        Args:
            output: File to write. If not given: scene.fmu.
            fmi: Version of the FMI standard; 2 is for tools that cannot read version 3. Allowed: 2, 3. If not given:
                3.
            core: Folder of slipfit-core to compile, instead of the source that is part of this program.
            step: Length of the controller's steps, such as 1ms; a bare number is in µs.
            integrator: Integration scheme of the controller. Allowed: semi-implicit-euler, rk4, linearly-implicit-
                euler, rodas3, implicit-euler, rodas4, sdirk2, extrapolated.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"output": output, "fmi": fmi, "core": core, "step": step, "integrator": integrator}
        found: results.Fmu = self._call(results.Fmu, "fmu", options, progress=progress)
        return found

    def precision(
        self,
        *,
        drive: Option = None,
        n: Option = None,
        csv: Option = None,
        plot: Option = None,
        stability: bool = False,
        random: Option = None,
        seed: Option = None,
        threads: Option = None,
        picture: bool | None = None,
        progress: Progress = None,
    ) -> results.Precision:
        """Measures error against run time of every integration scheme, step and number type.

        For slides, and mechanisms with a drive. The error is that of the drive's force or torque every millisecond,
        in % of its peak, against a far finer run. Explicit schemes are tried at finer steps, too, because they are
        stable only there. Of a mechanism the implicit schemes are tried, in double precision.

        For slides only: `stability`.

        Args:
            drive: Name of the drive, where a mechanism has several.
            n: Tolerance level of the unit; positive is tighter. If not given: 2.5.
            csv: Writes every measured point as CSV.
            plot: Draws error over run time as SVG.
            stability: Makes the stability map instead: for which parameters steps of one length are right. Parameters
                of the scene are varied one at a time and in random combinations, far beyond any slide. For each run
                the map says whether its drive force is right, and whether a wrong run comes with a warning.
            random: Number of random combinations in the stability map. If not given: 1000.
            seed: Seed of the random combinations. If not given: 1.
            threads: Number of threads; all cores if not given. The result does not depend on it.
            picture: Whether the result has pictures; if None, in notebooks.
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError: A mistake in the scene, with file, line, column and what is allowed.
            InputError: Another argument that is not allowed.
            WorkError: Valid input without a result, such as a full disk.
        """
        options: dict[str, Option] = {"drive": drive, "n": n, "csv": csv, "plot": plot, "stability": stability, "random": random, "seed": seed, "threads": threads}
        found: results.Precision = self._call(results.Precision, "precision", options, picture=picture, progress=progress)
        return found


def capability(
    file: Table,
    *,
    group: Option = None,
    label: Option = None,
    ignore: Option = None,
    family: Option = None,
    page: Option = None,
    progress: Progress = None,
) -> results.Capability:
    """Tells performance and capability of measured parts by ISO 22514-2.

    Intervals are of 95 %. They are of the distribution that the parts choose, from 30 parts on, or of the one that
    `family` states.

    A CSV file has a row for each part. Its first row names the characteristics with their units, such as "length
    [mm]"; rows named nominal, lower and upper (or target, LSL and USL) state limits. A QIF 3.0 file of results (.qif)
    has all that by itself. Outliers are named and stay in every figure.

    Args:
        file: Measured parts: CSV, or QIF results (.qif).
        group: Column of the CSV whose texts divide the parts into subgroups, such as a cavity or a machine.
        label: Column of the CSV that labels the parts; default: "part".
        ignore: Leaves out a column of the CSV; or a list of them.
        family: Family of the distribution; default: chosen from the parts, of which that takes 30.
        page: Writes a page with pictures of every characteristic.
        progress: A function, or whether a line on standard error says how far it is.

    Raises:
        InputError: Another argument that is not allowed.
        WorkError: Valid input without a result, such as a full disk.
    """
    options: dict[str, Option] = {"group": group, "label": label, "ignore": ignore, "family": family, "page": page}
    with Files() as files:
        path = files.of(file)
        found: results.Capability = call(results.Capability, "capability", [path], options, progress=progress)
    return found


def merge(
    files: Paths,
    *,
    out: Option = None,
    n: Option = None,
    csv: Option = None,
    plots: Option = None,
    picture: bool | None = None,
    progress: Progress = None,
) -> results.Population | results.Tolerance:
    """Joins the parts that `tolerance` with `shard` or `population` with `shard` wrote.

    The result has the same bytes as that of one run without `shard`.

    Args:
        files: Files that `slipfit tolerance `shard` or `slipfit population `shard` wrote.
        out: Writes all parts as one file.
        n: Tolerance level at which a slide's clearances are shown; positive is tighter. The default is the level that
            closes the first pair of gaps, to a hundredth: 3.43 for the paper's slide.
        csv: Writes the measures' statistics as CSV.
        plots: Draws histograms, contributors and correlations as SVG files in a folder.
        picture: Whether the result has pictures; if None, in notebooks.
        progress: A function, or whether a line on standard error says how far it is.

    Raises:
        InputError: Another argument that is not allowed.
        WorkError: Valid input without a result, such as a full disk.
    """
    options: dict[str, Option] = {"out": out, "n": n, "csv": csv, "plots": plots}
    paths = paths_of(files)
    found: results.Population | results.Tolerance = call(results.Population | results.Tolerance, "merge", paths, options, picture=picture, progress=progress)
    return found
