//! Small dense linear algebra for the slab: Cholesky, symmetric eigenvectors, LU. Row-major, f64, and always
//! the same order of operations.

/// A dense matrix.
#[derive(Clone, Debug)]
pub(super) struct Matrix {
    pub rows: usize,
    pub columns: usize,
    values: Vec<f64>,
}

impl Matrix {
    pub(super) fn zero(rows: usize, columns: usize) -> Self {
        Matrix { rows, columns, values: vec![0.0; rows * columns] }
    }

    pub(super) fn of(rows: usize, columns: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        let mut m = Matrix::zero(rows, columns);
        for i in 0..rows {
            for j in 0..columns {
                m.values[i * columns + j] = value(i, j);
            }
        }
        m
    }

    #[inline(always)]
    pub(super) fn at(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.columns + j]
    }

    #[inline(always)]
    fn set(&mut self, i: usize, j: usize, v: f64) {
        self.values[i * self.columns + j] = v;
    }

    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// self · other
    pub(super) fn times(&self, other: &Matrix) -> Matrix {
        let mut out = Matrix::zero(self.rows, other.columns);
        for i in 0..self.rows {
            for k in 0..self.columns {
                let a = self.at(i, k);
                for j in 0..other.columns {
                    out.values[i * other.columns + j] += a * other.at(k, j);
                }
            }
        }
        out
    }

    pub(super) fn transposed(&self) -> Matrix {
        Matrix::of(self.columns, self.rows, |i, j| self.at(j, i))
    }

    /// The lower triangle L of a symmetric positive definite matrix L Lᵀ; none where it is not one.
    pub(super) fn cholesky(&self) -> Option<Matrix> {
        let n = self.rows;
        let mut l = Matrix::zero(n, n);
        for i in 0..n {
            for j in 0..=i {
                let dot: f64 = (0..j).map(|k| l.at(i, k) * l.at(j, k)).sum();
                let rest = self.at(i, j) - dot;
                if i == j && rest <= 0.0 {
                    return None;
                }
                l.set(i, j, if i == j { rest.sqrt() } else { rest / l.at(j, j) });
            }
        }
        Some(l)
    }

    /// L⁻¹ b for a lower triangle, a column of `b` at a time.
    pub(super) fn forward(&self, b: &[f64]) -> Vec<f64> {
        let mut x = b.to_vec();
        for i in 0..self.rows {
            let dot: f64 = (0..i).map(|k| self.at(i, k) * x[k]).sum();
            x[i] = (x[i] - dot) / self.at(i, i);
        }
        x
    }

    /// L⁻ᵀ b for a lower triangle.
    pub(super) fn backward(&self, b: &[f64]) -> Vec<f64> {
        let mut x = b.to_vec();
        for i in (0..self.rows).rev() {
            let dot: f64 = (i + 1..self.rows).map(|k| self.at(k, i) * x[k]).sum();
            x[i] = (x[i] - dot) / self.at(i, i);
        }
        x
    }

    /// Eigenvalues of a symmetric matrix and its eigenvectors in columns, by Jacobi's rotations (Golub & Van
    /// Loan, Matrix Computations, §8.5).
    pub(super) fn symmetric_eigen(mut self) -> (Vec<f64>, Matrix) {
        let n = self.rows;
        let mut vectors = Matrix::of(n, n, |i, j| if i == j { 1.0 } else { 0.0 });
        for _ in 0..60 {
            let off: f64 = (0..n).map(|i| (0..i).map(|j| self.at(i, j) * self.at(i, j)).sum::<f64>()).sum();
            let on: f64 = (0..n).map(|i| self.at(i, i) * self.at(i, i)).sum();
            if off <= 1e-30 * on {
                break;
            }
            for p in 0..n {
                for q in p + 1..n {
                    self.rotate(p, q, &mut vectors);
                }
            }
        }
        ((0..n).map(|i| self.at(i, i)).collect(), vectors)
    }

    /// The rotation of the plane (p, q) that makes the element there vanish.
    fn rotate(&mut self, p: usize, q: usize, vectors: &mut Matrix) {
        let element = self.at(p, q);
        if element == 0.0 {
            return;
        }
        let ratio = (self.at(q, q) - self.at(p, p)) / (2.0 * element);
        let sign = if ratio >= 0.0 { 1.0 } else { -1.0 };
        let t = sign / (ratio.abs() + (1.0 + ratio * ratio).sqrt());
        let c = 1.0 / (1.0 + t * t).sqrt();
        let s = t * c;
        for k in 0..self.rows {
            let (a, b) = (self.at(k, p), self.at(k, q));
            self.set(k, p, c * a - s * b);
            self.set(k, q, s * a + c * b);
        }
        for k in 0..self.rows {
            let (a, b) = (self.at(p, k), self.at(q, k));
            self.set(p, k, c * a - s * b);
            self.set(q, k, s * a + c * b);
            let (a, b) = (vectors.at(k, p), vectors.at(k, q));
            vectors.set(k, p, c * a - s * b);
            vectors.set(k, q, s * a + c * b);
        }
    }

    /// Decomposed for [`Factors::solve`].
    pub(super) fn factorise(mut self) -> Factors {
        let n = self.rows;
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let mut pivot = k;
            for i in k + 1..n {
                if self.at(i, k).abs() > self.at(pivot, k).abs() {
                    pivot = i;
                }
            }
            if pivot != k {
                order.swap(k, pivot);
                let (top, bottom) = self.values.split_at_mut(pivot * n);
                top[k * n..(k + 1) * n].swap_with_slice(&mut bottom[..n]);
            }
            let head = self.row(k).to_vec();
            for i in k + 1..n {
                let row = self.row_mut(i);
                let factor = row[k] / head[k];
                row[k] = factor;
                for j in k + 1..n {
                    row[j] -= factor * head[j];
                }
            }
        }
        Factors { lu: self, order }
    }
}

/// A square matrix as L U with rows interchanged.
#[derive(Clone, Debug)]
pub(super) struct Factors {
    lu: Matrix,
    order: Vec<usize>,
}

impl Factors {
    /// A⁻¹ b
    pub(super) fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = b.len();
        let mut x: Vec<f64> = self.order.iter().map(|&i| b[i]).collect();
        for i in 0..n {
            let row = self.lu.row(i);
            let dot: f64 = (0..i).map(|k| row[k] * x[k]).sum();
            x[i] -= dot;
        }
        for i in (0..n).rev() {
            let row = self.lu.row(i);
            let dot: f64 = (i + 1..n).map(|k| row[k] * x[k]).sum();
            x[i] = (x[i] - dot) / row[i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A symmetric matrix is its eigenvectors times eigenvalues, the solved system holds, L Lᵀ is the matrix.
    #[test]
    fn decompositions_multiply_back() {
        let a = Matrix::of(5, 5, |i, j| 1.0 / (1.0 + (i + j) as f64) + if i == j { 1.0 } else { 0.0 });
        let (values, v) = a.clone().symmetric_eigen();
        let scaled = Matrix::of(5, 5, |i, j| v.at(i, j) * values[j]);
        let back = scaled.times(&v.transposed());
        let l = a.cholesky().unwrap();
        let product = l.times(&l.transposed());
        let x = a.clone().factorise().solve(&[1.0, -2.0, 3.0, 0.5, 4.0]);
        for i in 0..5 {
            for j in 0..5 {
                assert!((back.at(i, j) - a.at(i, j)).abs() < 1e-14);
                assert!((product.at(i, j) - a.at(i, j)).abs() < 1e-14);
            }
            let sum: f64 = (0..5).map(|j| a.at(i, j) * x[j]).sum();
            assert!((sum - [1.0, -2.0, 3.0, 0.5, 4.0][i]).abs() < 1e-13);
        }
        let y = l.backward(&l.forward(&[1.0, -2.0, 3.0, 0.5, 4.0]));
        assert!((0..5).all(|i| (x[i] - y[i]).abs() < 1e-13));
    }
}
