//! A unit that an importer steps: its values, its motion, and in which mode it is.

use crate::{
    clock::steps_until,
    model::{FIXED, Model, NAMES, OUTPUTS, START, STEP, State, TOKEN, VALUES},
    numbers::Numbers,
};
use slipfit_core::{ParameterError, clearance::GapStatistics, kernel::Report, table::layout::checksum};

/// Why a call is refused, in words for the importer's log.
pub struct Trouble(pub String);

impl From<String> for Trouble {
    fn from(why: String) -> Self {
        Self(why)
    }
}

impl From<&str> for Trouble {
    fn from(why: &str) -> Self {
        Self(why.into())
    }
}

impl From<ParameterError<f32>> for Trouble {
    fn from(error: ParameterError<f32>) -> Self {
        Self(error.to_string())
    }
}

/// The gap of that `name` at the level `n`, where it is `mean` at level 0 (m), from the least to the greatest that is allowed.
pub fn gap(name: &str, mean: f64, deviation: f32, n: f64, [least, greatest]: [f64; 2]) -> Result<f32, Trouble> {
    let gap = GapStatistics { mean: mean as f32, deviation }.at(n as f32);
    if (least..=greatest).contains(&f64::from(gap)) {
        Ok(gap)
    } else {
        Err(format!("at n = {n} the gap {name} is {gap} m, allowed is {least} to {greatest} m").into())
    }
}

/// Value reference of the time; then come parameters and inputs, then outputs.
const TIME: u32 = 0;

/// Which calls are allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// Before initialization mode.
    Instantiated,
    /// In it.
    Initialization,
    /// Between two steps.
    Step,
    /// After the last.
    Terminated,
}

/// Everything about an instance that changes: what its state is to the importer.
#[derive(Clone)]
pub struct Situation {
    mode: Mode,
    /// Time (s) at which the kernel's is 0.
    start: f64,
    /// The last communication point (s).
    time: f64,
    /// Steps taken.
    steps: u64,
    values: [f64; VALUES],
    /// Which of them have been set in step mode: a command that was replaces the scene's ramp.
    set_while_stepping: [bool; VALUES],
    /// The kernel of these values; none where they have changed since, or allow none.
    model: Option<Model>,
    state: State,
    report: Report<f32>,
}

impl Situation {
    /// Before anything was set.
    pub fn new() -> Result<Self, Trouble> {
        let set_while_stepping = [false; VALUES];
        let model = Model::new(&START, &set_while_stepping)?;
        Ok(Self {
            mode: Mode::Instantiated,
            start: 0.0,
            time: 0.0,
            steps: 0,
            values: START,
            set_while_stepping,
            model: Some(model),
            state: model.start(),
            report: Report { residual: 0.0, error: 0.0 },
        })
    }

    pub fn time(&self) -> f64 {
        self.time
    }

    /// As it was when it was instantiated, with the start values.
    pub fn reset(&mut self) -> Result<(), Trouble> {
        *self = Self::new()?;
        Ok(())
    }

    fn allowed(&self, call: &str, modes: &[Mode]) -> Result<(), Trouble> {
        if modes.contains(&self.mode) {
            Ok(())
        } else {
            Err(format!("{call} is not allowed in the mode {:?}", self.mode).into())
        }
    }

    pub fn enter_initialization(&mut self, start: f64) -> Result<(), Trouble> {
        self.allowed("entering initialization mode", &[Mode::Instantiated])?;
        self.set_start(start)?;
        self.mode = Mode::Initialization;
        Ok(())
    }

    pub fn set_start(&mut self, start: f64) -> Result<(), Trouble> {
        self.allowed("setting the start time", &[Mode::Instantiated])?;
        if !start.is_finite() {
            return Err(format!("the start time is {start}, allowed are finite numbers").into());
        }
        (self.start, self.time) = (start, start);
        Ok(())
    }

    pub fn exit_initialization(&mut self) -> Result<(), Trouble> {
        self.allowed("leaving initialization mode", &[Mode::Initialization])?;
        self.made()?;
        self.mode = Mode::Step;
        Ok(())
    }

    pub fn terminate(&mut self) -> Result<(), Trouble> {
        self.allowed("terminating", &[Mode::Step])?;
        self.mode = Mode::Terminated;
        Ok(())
    }

    /// The kernel of the present values.
    fn made(&mut self) -> Result<Model, Trouble> {
        let model = match self.model {
            Some(model) => model,
            None => Model::new(&self.values, &self.set_while_stepping)?,
        };
        self.model = Some(model);
        Ok(model)
    }

    /// Reads the values of `references`.
    pub fn get(&mut self, references: &[u32], into: &mut [f64]) -> Result<(), Trouble> {
        if references.len() != into.len() {
            return Err(
                format!("{} values are asked for and there is room for {}", references.len(), into.len()).into()
            );
        }
        let mut outputs: Option<[f64; OUTPUTS]> = None;
        for (reference, value) in references.iter().zip(into) {
            let at = *reference as usize;
            *value = if *reference == TIME {
                self.time
            } else if at <= VALUES {
                self.values[at - 1]
            } else if at <= VALUES + OUTPUTS {
                let known = match outputs {
                    Some(known) => known,
                    None => self.made()?.outputs(&self.state, &self.report),
                };
                outputs = Some(known);
                known[at - 1 - VALUES]
            } else {
                return Err(format!("there is no variable of the value reference {reference}").into());
            };
        }
        Ok(())
    }

    /// Sets the values of `references`: all, or none if one of them is not allowed.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Trouble> {
        if references.len() != values.len() {
            return Err(format!("{} variables are to be set to {} values", references.len(), values.len()).into());
        }
        let (mut next, mut set_while_stepping) = (self.values, self.set_while_stepping);
        for (reference, value) in references.iter().zip(values) {
            let at = (*reference as usize).wrapping_sub(1);
            let Some(name) = NAMES.get(at) else {
                return Err(format!("no parameter or input has the value reference {reference}").into());
            };
            let settled = !matches!(self.mode, Mode::Instantiated | Mode::Initialization);
            if settled && at < FIXED {
                return Err(format!("{name} is fixed: it is set before initialization ends, or after a reset").into());
            }
            self.allowed(&format!("setting {name}"), &[Mode::Instantiated, Mode::Initialization, Mode::Step])?;
            if !value.is_finite() {
                return Err(format!("{name} is {value}, allowed are finite numbers").into());
            }
            next[at] = *value;
            set_while_stepping[at] = self.mode == Mode::Step;
        }
        // While stepping, values that allow no kernel must not be taken.
        let model = if self.mode == Mode::Step { Some(Model::new(&next, &set_while_stepping)?) } else { None };
        (self.values, self.set_while_stepping, self.model) = (next, set_while_stepping, model);
        Ok(())
    }

    /// Goes on from the communication point `current` (s) by `size` (s).
    pub fn advance(&mut self, current: f64, size: f64) -> Result<(), Trouble> {
        self.allowed("a step", &[Mode::Step])?;
        if !(size >= 0.0 && size.is_finite()) {
            return Err(format!("the communication step is {size} s, allowed are finite numbers of at least 0").into());
        }
        if !((current - self.time).abs() <= 1e-3 * STEP + 1e-9 * self.time.abs()) {
            return Err(
                format!("the communication point is {current} s, the last step ended at {} s", self.time).into()
            );
        }
        let end = current + size;
        let target = steps_until(end - self.start, STEP)
            .ok_or_else(|| format!("{end} s cannot be reached from {} s by steps of {STEP} s", self.start))?;
        let model = self.made()?;
        while self.steps < target {
            let report = model.step(&mut self.state);
            self.report = report;
            if !report.residual.is_finite() {
                let time = self.start + self.steps as f64 * STEP;
                return Err(format!("the motion leaves the finite range at {time} s").into());
            }
            self.steps += 1;
        }
        self.time = end;
        Ok(())
    }
}

/// The situation as bytes, in little-endian order whatever the machine, and their checksum, CRC-32/ISO-HDLC.
pub fn serialised(situation: &Situation) -> Vec<u8> {
    let Situation { mode, start, time, steps, values, set_while_stepping, state, report, .. } = situation;
    let mut bytes = Vec::new();
    bytes.extend((TOKEN.len() as u64).to_le_bytes());
    bytes.extend(TOKEN.as_bytes());
    bytes.push(*mode as u8);
    bytes.extend(start.to_le_bytes());
    bytes.extend(time.to_le_bytes());
    bytes.extend(steps.to_le_bytes());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes.extend(set_while_stepping.map(u8::from));
    bytes.extend(state.steps.to_le_bytes());
    let mut state = *state;
    let mut number = |number: &mut f32| bytes.extend(number.to_le_bytes());
    [report.residual, report.error].each(&mut number);
    state.motion.pose.each(&mut number);
    state.motion.velocity.each(&mut number);
    state.motion.acceleration.each(&mut number);
    state.motion.internal.each(&mut number);
    bytes.extend(checksum(&bytes).to_le_bytes());
    bytes
}

/// The situation that was written as `bytes`.
pub fn deserialised(bytes: &[u8]) -> Result<Situation, Trouble> {
    let mut situation = Situation::new()?;
    if bytes.len() != serialised(&situation).len() {
        return Err(format!("a state of {} bytes is not one of this unit", bytes.len()).into());
    }
    let body = bytes.split_last_chunk().filter(|(body, found)| checksum(body).to_le_bytes() == **found);
    let Some((mut rest, _)) = body else {
        return Err("the state is damaged: its checksum does not match".into());
    };
    let mut word = |count: usize| {
        let (word, after) = rest.split_at(count);
        rest = after;
        word
    };
    let double = |word: &[u8]| f64::from_le_bytes(word.try_into().unwrap_or_default());
    let single = |word: &[u8]| f32::from_le_bytes(word.try_into().unwrap_or_default());
    let foreign = || Trouble::from("the state is another unit's");
    if word(8) != (TOKEN.len() as u64).to_le_bytes() || word(TOKEN.len()) != TOKEN.as_bytes() {
        return Err(foreign());
    }
    let mode = word(1)[0];
    let modes = [Mode::Instantiated, Mode::Initialization, Mode::Step, Mode::Terminated];
    situation.mode = *modes.get(usize::from(mode)).ok_or_else(foreign)?;
    situation.start = double(word(8));
    situation.time = double(word(8));
    situation.steps = u64::from_le_bytes(word(8).try_into().unwrap_or_default());
    for value in &mut situation.values {
        *value = double(word(8));
    }
    for set_while_stepping in &mut situation.set_while_stepping {
        *set_while_stepping = word(1)[0] != 0;
    }
    situation.state.steps = u32::from_le_bytes(word(4).try_into().unwrap_or_default());
    let mut number = |number: &mut f32| *number = single(word(4));
    let mut report = [0.0; 2];
    report.each(&mut number);
    let motion = &mut situation.state.motion;
    motion.pose.each(&mut number);
    motion.velocity.each(&mut number);
    motion.acceleration.each(&mut number);
    motion.internal.each(&mut number);
    situation.report = Report { residual: report[0], error: report[1] };
    situation.model = None;
    Ok(situation)
}
