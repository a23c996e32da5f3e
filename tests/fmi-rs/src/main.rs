//! Looks at a co-simulation unit with the crate `fmi`: slipfit-fmi-rs UNIT.fmu EXPECTED.json
//!
//! EXPECTED.json is what `host/tests/fmu/check.py` takes. The unit must have these bits whatever the communication steps,
//! refuse what has to be refused, and be new after a reset. In version 2 also after its state was saved and restored, and after
//! it was written down and read by another instance; in version 3 the crate (0.8.0) has no functions for states.
#![forbid(unsafe_code)]

use std::{
    collections::{BTreeMap, HashMap},
    env, fs,
};

use fmi::{
    Error,
    fmi2::{
        import::Fmi2Import,
        instance::{self as instance2, CoSimulation as _, Common as _},
    },
    fmi3::{CoSimulation as _, Fmi3Model, GetSet, import::Fmi3Import, instance as instance3},
    import,
    schema::{
        MajorVersion,
        traits::{DefaultExperiment, FmiInterfaceType, FmiModelDescription},
    },
    traits::{FmiImport, FmiInstance, FmiStatus},
};
use serde::Deserialize;

/// By how much of a step a communication point may miss it and still count as on it.
const SLACK: f64 = 1e-3;

/// What the unit has to be.
#[derive(Deserialize)]
struct Expected {
    /// Step of the kernel (s).
    step: f64,
    /// Values to set before the start.
    set: BTreeMap<String, f64>,
    /// Names of outputs.
    columns: Vec<String>,
    /// Their values at the start and after every step.
    rows: Vec<Vec<f64>>,
    /// About what outputs are at the start.
    first: BTreeMap<String, f64>,
    /// Values that a running unit does not take.
    refused: Vec<(String, f64)>,
}

/// An instance of either version of the standard.
trait Unit: FmiInstance {
    fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error>;
    fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error>;
    fn step(&mut self, time: f64, size: f64) -> Result<(), Error>;
}

impl Unit for instance2::InstanceCS {
    fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        self.set_real(references, values)?;
        Ok(())
    }

    fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        self.get_real(references, values)?;
        Ok(())
    }

    fn step(&mut self, time: f64, size: f64) -> Result<(), Error> {
        // The standard's flag says here that the importer does not go back.
        self.do_step(time, size, false)?;
        Ok(())
    }
}

impl Unit for instance3::InstanceCS {
    fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        self.set_float64(references, values)?;
        Ok(())
    }

    fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        self.get_float64(references, values)?;
        Ok(())
    }

    fn step(&mut self, time: f64, size: f64) -> Result<(), Error> {
        let (mut event, mut terminate, mut early, mut last) = (true, true, true, f64::NAN);
        self.do_step(time, size, false, &mut event, &mut terminate, &mut early, &mut last)?;
        assert_eq!((event, terminate, early, last), (false, false, false, time + size));
        Ok(())
    }
}

/// Goes through what is expected of a unit whose variables have these `references`.
struct Check {
    expected: Expected,
    references: HashMap<String, u32>,
}

impl Check {
    fn references<'a>(&self, names: impl IntoIterator<Item = &'a String>) -> Vec<u32> {
        names
            .into_iter()
            .map(|name| *self.references.get(name).unwrap_or_else(|| panic!("no variable {name}")))
            .collect()
    }

    fn set<U: Unit>(&self, unit: &mut U, name: &String, value: f64) -> Result<(), Error> {
        unit.set(&self.references([name]), &[value])
    }

    fn get<U: Unit>(&self, unit: &mut U, name: &String) -> Result<f64, Error> {
        let mut value = [f64::NAN];
        unit.get(&self.references([name]), &mut value)?;
        Ok(value[0])
    }

    /// The last instant (s).
    fn end(&self) -> f64 {
        (self.expected.rows.len() - 1) as f64 * self.expected.step
    }

    /// Begins the simulation, with the values that are to be set or with the unit's own.
    fn start<U: Unit>(&self, unit: &mut U, with_values: bool) -> Result<(), Error> {
        if with_values {
            let values: Vec<_> = self.expected.set.values().copied().collect();
            unit.set(&self.references(self.expected.set.keys()), &values)?;
        }
        unit.enter_initialization_mode(None, 0.0, Some(self.end())).map_err(Into::into)?;
        unit.exit_initialization_mode().map_err(Into::into)?;
        Ok(())
    }

    /// Goes on from `time` by steps of `size` to the `end` and looks at every communication point; gives the last of them.
    fn run<U: Unit>(&self, unit: &mut U, mut time: f64, size: f64, end: f64) -> Result<f64, Error> {
        self.compare(unit, time)?;
        while time + size <= end * (1.0 + 1e-9) {
            unit.step(time, size)?;
            time += size;
            self.compare(unit, time)?;
        }
        Ok(time)
    }

    /// Whether outputs at `time` are those of the last step at or before it.
    fn compare<U: Unit>(&self, unit: &mut U, time: f64) -> Result<(), Error> {
        let mut found = vec![f64::NAN; self.expected.columns.len()];
        unit.get(&self.references(&self.expected.columns), &mut found)?;
        let row = &self.expected.rows[(time / self.expected.step + SLACK) as usize];
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert!(bits(&found) == bits(row), "at {time} s: {found:?}, not {row:?}");
        Ok(())
    }

    /// Everything that both versions can; `instantiated` makes one instance after another.
    fn whole<U: Unit>(&self, instantiated: impl Fn() -> Result<U, Error>) -> Result<(), Error> {
        let (step, end) = (self.expected.step, self.end());
        for size in [step, 0.4 * step, 2.5 * step, 7.0 * step, end] {
            let mut unit = instantiated()?;
            self.start(&mut unit, true)?;
            for (name, value) in &self.expected.first {
                let found = self.get(&mut unit, name)?;
                assert!((found - value).abs() < 3e-8, "{name}: {found}, not {value}");
            }
            self.run(&mut unit, 0.0, size, end)?;
            for (name, value) in &self.expected.refused {
                let before = self.get(&mut unit, name)?;
                assert!(self.set(&mut unit, name, *value).is_err(), "{name} = {value} was taken");
                assert_eq!(self.get(&mut unit, name)?, before, "{name}");
            }
            unit.reset().map_err(Into::into)?;
            self.start(&mut unit, true)?;
            self.run(&mut unit, 0.0, 11.0 * step, end)?;
            unit.terminate().map_err(Into::into)?;
        }
        Ok(())
    }

    /// The state, saved at half the time, set back, and read by another instance.
    fn state(&self, instantiated: impl Fn() -> Result<instance2::InstanceCS, Error>) -> Result<(), Error> {
        let (step, end) = (self.expected.step, self.end());
        let (mut unit, mut other) = (instantiated()?, instantiated()?);
        self.start(&mut unit, true)?;
        let half = self.run(&mut unit, 0.0, 1.6 * step, 0.5 * end)?;
        let state = unit.get_fmu_state()?;
        let written = unit.serialize_fmu_state(&state)?;
        self.run(&mut unit, half, step, end)?;
        unit.set_fmu_state(&state).ok()?;
        self.run(&mut unit, half, 0.7 * step, end)?;
        // Parameters are read with the state.
        self.start(&mut other, false)?;
        let read = other.deserialize_fmu_state(&written)?;
        other.set_fmu_state(&read).ok()?;
        self.run(&mut other, half, 3.3 * step, end)?;
        assert_eq!(other.serialize_fmu_state(&read)?, written);
        Ok(())
    }
}

fn main() -> Result<(), Error> {
    let arguments: Vec<_> = env::args_os().skip(1).collect();
    let [unit, expected] = &arguments[..] else { panic!("slipfit-fmi-rs UNIT.fmu EXPECTED.json") };
    let expected: Expected = serde_json::from_slice(&fs::read(expected)?).expect("what a unit has to be");
    match import::peek_descr_path(unit)?.major_version()? {
        MajorVersion::FMI2 => {
            let import: Fmi2Import = import::from_path(unit)?;
            let description = import.model_description();
            let kind = description.co_simulation.as_ref().expect("it is for co-simulation");
            assert_eq!(kind.can_handle_variable_communication_step_size, Some(true));
            assert_eq!((kind.can_get_and_set_fmu_state, kind.can_serialize_fmu_state), (Some(true), Some(true)));
            assert_eq!(DefaultExperiment::step_size(description), Some(expected.step));
            let references =
                description.get_model_variables().map(|one| (one.name.clone(), one.value_reference)).collect();
            let check = Check { expected, references };
            let instantiated = || import.instantiate_cs("unit", false, true);
            assert_eq!(instantiated()?.name(), "unit");
            check.whole(instantiated)?;
            check.state(instantiated)
        }
        MajorVersion::FMI3 => {
            let import: Fmi3Import = import::from_path(unit)?;
            let description = import.model_description();
            let kind = description.co_simulation.as_ref().expect("it is for co-simulation");
            assert_eq!(kind.can_handle_variable_communication_step_size, Some(true));
            assert_eq!((kind.can_get_and_set_fmu_state(), kind.can_serialize_fmu_state()), (Some(true), Some(true)));
            assert_eq!(kind.fixed_internal_step_size, Some(expected.step));
            let variables = description.model_variables.iter_abstract();
            let references = variables.map(|one| (one.name().to_owned(), one.value_reference())).collect();
            let check = Check { expected, references };
            check.whole(|| import.instantiate_cs("unit", false, true, false, false, &[]))
        }
        other => panic!("the description says version {other:?}"),
    }
}
