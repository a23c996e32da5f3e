//! A model and a loss as a problem of least squares.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, storage::Owned};

use super::{bounds, loss::Loss};
use crate::{
    beforehand::Beforehand,
    model::{Model, ModelError},
};

/// Steps of the search, in evaluations for each parameter.
const PATIENCE: usize = 20;

/// The search for the parameters that are not held.
struct Problem<'m, M: Model + ?Sized> {
    model: &'m M,
    /// Indices of the parameters that are searched; the others keep their values.
    free: &'m [usize],
    values: Vec<f64>,
    searched: DVector<f64>,
    cost: Cost<'m>,
    output: Option<Vec<f64>>,
    error: std::cell::RefCell<Option<ModelError>>,
}

impl<M: Model + ?Sized> Problem<'_, M> {
    fn compute(&mut self) {
        self.output = self.model.simulate(&self.values).map_err(|error| self.error.replace(Some(error))).ok();
    }

    /// Residuals in deviations.
    fn scaled<'a>(&'a self, output: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.model.measured().iter().zip(output).map(|(measured, output)| (measured - output) / self.cost.scale)
    }
}

impl<M: Model + ?Sized> LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_, M> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, searched: &DVector<f64>) {
        self.searched.copy_from(searched);
        for (i, u) in self.free.iter().zip(searched.iter()) {
            self.values[*i] = bounds::value(&self.model.parameters()[*i], *u)[0];
        }
        self.compute();
    }

    fn params(&self) -> DVector<f64> {
        self.searched.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let output = self.output.as_ref()?;
        let roots = self.scaled(output).map(|u| self.cost.loss.root(u)[0]);
        let all: Vec<f64> = roots.chain(self.cost.beforehand.residuals(&self.values)).collect();
        Some(DVector::from_vec(all))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let output = self.output.as_ref()?;
        let of_output = self.model.sensitivities(&self.values, output).map_err(|error| self.error.replace(Some(error)));
        let of_output = of_output.ok()?;
        let Cost { loss, scale, beforehand } = self.cost;
        let slopes: Vec<f64> = self.scaled(output).map(|u| loss.root(u)[1] / scale).collect();
        let known: Vec<(usize, f64)> = beforehand.parameters().zip(beforehand.slopes()).collect();
        let mut jacobian = DMatrix::zeros(output.len() + known.len(), self.free.len());
        for (mut column, (i, u)) in jacobian.column_iter_mut().zip(self.free.iter().zip(self.searched.iter())) {
            let inner = bounds::value(&self.model.parameters()[*i], *u)[1];
            let of_record = slopes.iter().zip(&of_output[*i]).map(|(slope, of_output)| -slope * of_output * inner);
            let of_known = known.iter().map(|(parameter, slope)| if parameter == i { slope * inner } else { 0.0 });
            column.iter_mut().zip(of_record.chain(of_known)).for_each(|(entry, value)| *entry = value);
        }
        Some(jacobian)
    }
}

/// Cosine of the angle between residuals and derivatives at which a search ends. Times the root of the number of samples it is how far the
/// minimum is, in standard errors of white noise, of a parameter that no other one resembles; of those that do it may be a hundred times
/// as far, and still near.
pub const CLOSE: f64 = 1e-6;
/// The same of a search that another one follows.
pub const NEAR: f64 = 1e-3;

/// What a search minimises.
#[derive(Clone, Copy)]
pub struct Cost<'a> {
    /// What a residual of the record costs.
    pub loss: Loss,
    /// The deviation in which it is counted.
    pub scale: f64,
    /// What is known of the parameters.
    pub beforehand: &'a Beforehand,
}

impl Cost<'_> {
    /// The cost of `residuals` with these `values` of the parameters.
    pub fn of(&self, residuals: &[f64], values: &[f64]) -> f64 {
        let root = |residual: &f64| self.loss.root(residual / self.scale)[0];
        residuals.iter().map(root).map(|root| root * root).sum::<f64>() + self.beforehand.cost(values)
    }
}

/// The values from `start` that minimise the `cost`, those not `free` held, and the output there; as `close` to the minimum as [`CLOSE`] says.
///
/// # Errors
/// [`ModelError`] where the model cannot be computed.
pub fn minimise<M: Model + ?Sized>(
    model: &M,
    start: &[f64],
    free: &[usize],
    cost: Cost,
    close: f64,
) -> Result<(Vec<f64>, Vec<f64>), ModelError> {
    let parameters = model.parameters();
    let searched: Vec<f64> = free.iter().map(|i| bounds::searched(&parameters[*i], start[*i])).collect();
    let mut problem = Problem {
        model,
        free,
        values: start.to_vec(),
        searched: DVector::from_vec(searched.clone()),
        cost,
        output: None,
        error: None.into(),
    };
    problem.set_params(&DVector::from_vec(searched));
    if !free.is_empty() {
        let search = LevenbergMarquardt::new().with_tol(1e-9).with_gtol(close).with_patience(PATIENCE);
        let (at, _) = search.minimize(problem);
        problem = at;
    }
    match (problem.output, problem.error.into_inner()) {
        (Some(output), _) => Ok((problem.values, output)),
        (None, Some(error)) => Err(error),
        (None, None) => model.simulate(&problem.values).map(|output| (problem.values, output)),
    }
}
