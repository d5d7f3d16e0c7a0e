//! L-BFGS-B (Byrd, Lu, Nocedal and Zhu 1995): minima of smooth functions within bounds, by the crate `basin`.

use std::convert::Infallible;

use basin::{
    BoxBounds, CancellationToken, ConstraintDescription, ConstraintSet, Constraints, CostFunction, Executor,
    FirstOrderState, Gradient, Lbfgs,
};

/// Function to be minimised: its value and its gradient at some parameters.
pub(crate) trait Objective {
    /// Value, and one slope for every parameter.
    fn evaluate(&self, parameters: &[f64]) -> (f64, Vec<f64>);
}

/// Least and largest value of every parameter; infinite where there is no bound.
pub(crate) struct Bounds {
    pub(crate) lower: Vec<f64>,
    pub(crate) upper: Vec<f64>,
}

/// Conditions that end the search.
pub(crate) struct Limits<'a> {
    /// An iteration that lowers the cost by less than this share of it is the last.
    pub(crate) relative_reduction: f64,
    /// Iterations, at most.
    pub(crate) iterations: u64,
    /// Whether to end with the best parameters so far; asked at every evaluation.
    pub(crate) is_stopped: &'a (dyn Fn() -> bool + Sync),
}

/// Parameters of the lowest cost found from `start`, which lies within the bounds. The search has no history.
pub(crate) fn minimise(objective: &dyn Objective, bounds: &Bounds, start: Vec<f64>, limits: &Limits<'_>) -> Vec<f64> {
    let stop = CancellationToken::new();
    let problem = Problem { objective, bounds, is_stopped: limits.is_stopped, stop: stop.clone() };
    let solver = Lbfgs::new().with_relative_cost_reduction_tolerance(limits.relative_reduction);
    let state = FirstOrderState::new(start);
    let run = Executor::new(problem, solver, state).max_iter(limits.iterations).with_cancellation_token(stop).run();
    // A line search that finds nothing better ends the run, too: it has found what the objective's precision allows.
    run.expect("a start within its bounds and a cost that cannot fail").param().clone()
}

/// An objective as `basin` sees it: of one type, so that the solver is compiled once.
struct Problem<'a> {
    objective: &'a dyn Objective,
    bounds: &'a Bounds,
    is_stopped: &'a (dyn Fn() -> bool + Sync),
    stop: CancellationToken,
}

impl Problem<'_> {
    fn evaluate(&self, parameters: &[f64]) -> (f64, Vec<f64>) {
        if (self.is_stopped)() {
            self.stop.cancel();
        }
        self.objective.evaluate(parameters)
    }
}

impl CostFunction for Problem<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, parameters: &Vec<f64>) -> Result<f64, Infallible> {
        Ok(self.evaluate(parameters).0)
    }
}

impl Gradient for Problem<'_> {
    type Gradient = Vec<f64>;

    fn gradient(&self, parameters: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        Ok(self.evaluate(parameters).1)
    }

    fn cost_and_gradient(&self, parameters: &Vec<f64>) -> Result<(f64, Vec<f64>), Infallible> {
        Ok(self.evaluate(parameters))
    }
}

impl Constraints for Problem<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.bounds.lower), Some(&self.bounds.upper)))
    }
}
