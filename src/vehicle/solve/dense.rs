//! A small symmetric linear system, solved directly.

#![expect(
    clippy::needless_range_loop,
    reason = "indices are the mathematics here"
)]

use super::MOST_WHEELS as N;

/// A symmetric positive definite matrix of up to 16 rows, factored as `L D Lᵀ`.
pub(crate) struct Ldlt {
    n: usize,
    /// Lower triangle; the diagonal holds `1 / D`.
    m: [[f64; N]; N],
}

impl Ldlt {
    pub fn new() -> Self {
        Self {
            n: 0,
            m: [[0.0; N]; N],
        }
    }

    /// Factors the matrix whose lower triangle `entry(row, column)` tells.
    pub fn factor(&mut self, n: usize, entry: impl Fn(usize, usize) -> f64) {
        self.n = n.min(N);
        for i in 0..self.n {
            for j in 0..i {
                let mut sum = entry(i, j);
                for k in 0..j {
                    // `m[i][k]` holds L D while its row is built.
                    sum -= self.m[i][k] * self.m[j][k];
                }
                self.m[i][j] = sum;
            }
            let mut pivot = entry(i, i);
            for k in 0..i {
                let scaled = self.m[i][k];
                self.m[i][k] = scaled * self.m[k][k];
                pivot -= scaled * self.m[i][k];
            }
            self.m[i][i] = 1.0 / pivot.max(1.0e-30);
        }
    }

    /// Replaces `b` by the solution.
    pub fn solve(&self, b: &mut [f64; N]) {
        for i in 0..self.n {
            let mut sum = b[i];
            for k in 0..i {
                sum -= self.m[i][k] * b[k];
            }
            b[i] = sum;
        }
        for i in (0..self.n).rev() {
            let mut sum = b[i] * self.m[i][i];
            for k in i + 1..self.n {
                sum -= self.m[k][i] * b[k];
            }
            b[i] = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solution_of_every_size_satisfies_its_system() {
        for n in 1..=N {
            // Diagonally dominant, so positive definite.
            let entry = |i: usize, j: usize| {
                if i == j {
                    n as f64 + i as f64
                } else {
                    1.0 / (1.0 + i as f64 + 2.0 * j as f64)
                        * if (i + j).is_multiple_of(3) { -1.0 } else { 1.0 }
                }
            };
            let mut ldlt = Ldlt::new();
            ldlt.factor(n, entry);
            let mut x = [0.0; N];
            for (i, x) in x.iter_mut().enumerate() {
                *x = 1.0 - 0.3 * i as f64;
            }
            let b = x;
            ldlt.solve(&mut x);
            for i in 0..n {
                let sum: f64 = (0..n).map(|j| entry(i.max(j), i.min(j)) * x[j]).sum();
                assert!((sum - b[i]).abs() < 1.0e-12, "{n} {i}: {sum} for {}", b[i]);
            }
        }
    }
}
