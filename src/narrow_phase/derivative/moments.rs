//! How large is the mean of random matrices, and how well is it known?

use nalgebra::SMatrix;

/// Sums over what was drawn.
#[derive(Clone, Debug)]
pub(super) struct Moments<const ROWS: usize, const COLUMNS: usize> {
    count: u32,
    mean: SMatrix<f64, ROWS, COLUMNS>,
    /// Sums of squared differences to the mean (Welford 1962).
    spread: SMatrix<f64, ROWS, COLUMNS>,
}

impl<const ROWS: usize, const COLUMNS: usize> Moments<ROWS, COLUMNS> {
    pub fn new() -> Self {
        Self { count: 0, mean: SMatrix::zeros(), spread: SMatrix::zeros() }
    }

    pub fn add(&mut self, drawn: &SMatrix<f64, ROWS, COLUMNS>) {
        self.count += 1;
        let from_old = drawn - self.mean;
        self.mean += from_old / f64::from(self.count);
        self.spread += from_old.component_mul(&(drawn - self.mean));
    }

    pub fn mean(&self) -> &SMatrix<f64, ROWS, COLUMNS> {
        &self.mean
    }

    /// The largest standard error of an entry of the mean; infinite where there is nothing to tell it from.
    pub fn standard_error(&self) -> f64 {
        let count = f64::from(self.count);
        if self.count < 2 { f64::INFINITY } else { (self.spread.max() / (count * (count - 1.0))).sqrt() }
    }
}
