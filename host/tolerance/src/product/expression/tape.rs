//! Expressions of a product as one list of instructions.
//!
//! Every instruction works on all lanes at once. Constants are folded, and what several expressions have in common is computed
//! once; the operations and their order are those of the expressions, and so are the bits.

use std::{cell::Cell, collections::HashMap};

use super::operation::{Expression, One, Operation, Source, Two};
use crate::numeric::lanes::Lanes;

/// Instructions for the measures that are expressions.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    instructions: Vec<Instruction>,
    /// Measures, and what they are.
    results: Vec<(usize, Operand)>,
    /// What `abs` is taken of, and both arguments of `min` and `max`.
    kinks: Vec<[Operand; 2]>,
    /// Instructions that are there, by what they do.
    known: HashMap<Key, usize>,
}

#[derive(Clone, Copy, Debug)]
enum Instruction {
    One(One, Operand),
    Two(Two, Operand, Operand),
}

#[derive(Clone, Copy, Debug)]
enum Operand {
    Constant(f64),
    Variable(usize),
    /// A measure that is no expression on the tape.
    Measure(usize),
    /// The result of an instruction.
    Result(usize),
}

/// An instruction that can be compared: constants by their bits.
type Key = (Operator, [(u8, u64); 2]);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Operator {
    One(One),
    Two(Two),
}

impl Tape {
    /// Adds the expression of the measure with number `measure`. Measures that it reads and that are not on the tape are there
    /// before the tape runs.
    pub fn push(&mut self, measure: usize, expression: &Expression) {
        let mut stack = Vec::new();
        for step in &expression.steps {
            let operand = match step.operation {
                Operation::Constant(constant) => Operand::Constant(constant),
                Operation::Read(Source::Variable(variable)) => Operand::Variable(variable),
                Operation::Read(Source::Measure(measure)) => self.measure(measure),
                Operation::One(one) => match stack.pop() {
                    Some(Operand::Constant(x)) => Operand::Constant(one.of(Lanes::splat(x)).0[0]),
                    Some(x) => self.result(Instruction::One(one, x)),
                    None => return,
                },
                Operation::Two(two) => match (stack.pop(), stack.pop()) {
                    (Some(Operand::Constant(b)), Some(Operand::Constant(a))) => {
                        Operand::Constant(two.of(Lanes::splat(a), Lanes::splat(b)).0[0])
                    }
                    (Some(b), Some(a)) => self.result(Instruction::Two(two, a, b)),
                    _ => return,
                },
            };
            stack.push(operand);
        }
        self.results.extend(stack.pop().map(|result| (measure, result)));
    }

    /// What stands for a measure.
    fn measure(&self, measure: usize) -> Operand {
        let place = self.results.binary_search_by_key(&measure, |(measure, _)| *measure);
        place.map_or(Operand::Measure(measure), |place| self.results[place].1)
    }

    /// The result of an instruction, which is added unless it is there.
    fn result(&mut self, instruction: Instruction) -> Operand {
        let key = match instruction {
            Instruction::One(one, x) => (Operator::One(one), [x.key(); 2]),
            Instruction::Two(two, a, b) => (Operator::Two(two), [a.key(), b.key()]),
        };
        let next = self.instructions.len();
        let place = *self.known.entry(key).or_insert(next);
        if place == next {
            self.instructions.push(instruction);
            self.kinks.extend(match instruction {
                Instruction::One(One::Absolute, x) => Some([x, Operand::Constant(0.0)]),
                Instruction::Two(Two::Least | Two::Greatest, a, b) => Some([a, b]),
                _ => None,
            });
        }
        Operand::Result(place)
    }

    /// Writes its `measures` of the units with these `variables`.
    #[inline(always)]
    pub fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        if !self.results.is_empty() {
            let results = self.run(variables, measures);
            for (measure, operand) in &self.results {
                measures[*measure] = operand.value(variables, measures, &results);
            }
            RESULTS.set(results);
        }
    }

    /// How far units with these `variables` and `measures` are from each kink: what `abs` is taken of, the difference of the
    /// arguments of `min` and `max`.
    pub fn kinks(&self, variables: &[Lanes], measures: &[Lanes]) -> Vec<Lanes> {
        let results = self.run(variables, measures);
        let value = |operand: Operand| operand.value(variables, measures, &results);
        let kinks = self.kinks.iter().map(|[a, b]| value(*a) - value(*b)).collect();
        RESULTS.set(results);
        kinks
    }

    /// The results of all instructions.
    #[inline(always)]
    fn run(&self, variables: &[Lanes], measures: &[Lanes]) -> Vec<Lanes> {
        let mut results = RESULTS.take();
        results.clear();
        for instruction in &self.instructions {
            let value = |operand: Operand| operand.value(variables, measures, &results);
            results.push(match *instruction {
                Instruction::One(one, x) => one.of(value(x)),
                Instruction::Two(two, a, b) => two.of(value(a), value(b)),
            });
        }
        results
    }
}

thread_local! {
    /// Room for results, so that units are not waiting for memory.
    static RESULTS: Cell<Vec<Lanes>> = const { Cell::new(Vec::new()) };
}

impl Operand {
    #[inline(always)]
    fn value(self, variables: &[Lanes], measures: &[Lanes], results: &[Lanes]) -> Lanes {
        match self {
            Self::Constant(value) => Lanes::splat(value),
            Self::Variable(variable) => variables[variable],
            Self::Measure(measure) => measures[measure],
            Self::Result(place) => results[place],
        }
    }

    fn key(self) -> (u8, u64) {
        match self {
            Self::Constant(value) => (0, value.to_bits()),
            Self::Variable(variable) => (1, variable as u64),
            Self::Measure(measure) => (2, measure as u64),
            Self::Result(place) => (3, place as u64),
        }
    }
}
