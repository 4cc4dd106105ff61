//! Sums of weighted normals in logarithms.

/// The evidence of one model in one background.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evidence<const K: usize> {
    pub(crate) ln: f64,
    pub(crate) sizes: [f64; K],
    pub(crate) deviations: [f64; K],
}

/// A sum of weighted normals in logarithms: total weight, mean and standard deviation of the mixture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mixture<const K: usize> {
    largest: f64,
    total: f64,
    first: [f64; K],
    second: [f64; K],
}

impl<const K: usize> Mixture<K> {
    pub(crate) const fn new() -> Self {
        Self { largest: f64::NEG_INFINITY, total: 0.0, first: [0.0; K], second: [0.0; K] }
    }

    pub(crate) fn add(&mut self, ln: f64, sizes: [f64; K], deviations: [f64; K]) {
        if ln.is_nan() || ln == f64::NEG_INFINITY {
            return;
        }
        if ln > self.largest {
            let shrink = (self.largest - ln).exp();
            self.total *= shrink;
            for k in 0..K {
                self.first[k] *= shrink;
                self.second[k] *= shrink;
            }
            self.largest = ln;
        }
        let weight = (ln - self.largest).exp();
        self.total += weight;
        for k in 0..K {
            self.first[k] += weight * sizes[k];
            self.second[k] += weight * (sizes[k] * sizes[k] + deviations[k] * deviations[k]);
        }
    }

    pub(crate) fn ln(&self) -> f64 {
        if self.total > 0.0 { self.largest + self.total.ln() } else { f64::NEG_INFINITY }
    }

    pub(crate) fn mean(&self) -> Evidence<K> {
        let mut sizes = [0.0; K];
        let mut deviations = [0.0; K];
        if self.total > 0.0 {
            for k in 0..K {
                sizes[k] = self.first[k] / self.total;
                deviations[k] = (self.second[k] / self.total - sizes[k] * sizes[k]).max(0.0).sqrt();
            }
        }
        Evidence { ln: self.ln(), sizes, deviations }
    }
}

/// A sum of normals with weights factor·exp(ln), so that factors cost no logarithm.
pub(crate) struct Factored {
    largest: f64,
    total: f64,
    first: f64,
    second: f64,
}

impl Factored {
    pub(crate) const fn new() -> Self {
        Self { largest: f64::NEG_INFINITY, total: 0.0, first: 0.0, second: 0.0 }
    }

    pub(crate) fn add(&mut self, ln: f64, factor: f64, size: f64, variance: f64) {
        if ln.is_nan() || factor.is_nan() {
            return;
        }
        let mut weight = factor;
        if ln > self.largest {
            if self.total > 0.0 {
                let shrink = (self.largest - ln).exp();
                self.total *= shrink;
                self.first *= shrink;
                self.second *= shrink;
            }
            self.largest = ln;
        } else {
            weight *= (ln - self.largest).exp();
        }
        self.total += weight;
        self.first += weight * size;
        self.second += weight * (size * size + variance);
    }

    pub(crate) fn mean(&self) -> Evidence<1> {
        if self.total <= 0.0 {
            return Evidence { ln: f64::NEG_INFINITY, sizes: [0.0], deviations: [0.0] };
        }
        let size = self.first / self.total;
        let variance = (self.second / self.total - size * size).max(0.0);
        let ln = self.largest + self.total.ln();
        Evidence { ln, sizes: [size], deviations: [variance.sqrt()] }
    }
}

/// ln Σ exp, in order.
pub(crate) fn ln_sum(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut sum = Mixture::<0>::new();
    for value in values {
        sum.add(value, [], []);
    }
    sum.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixture_by_hand() {
        // Weights 1 and 3 on sizes 2 and 6, each with deviation 1: mean 5, variance 1 + (9 + 3)/4 = 4.
        let mut sum = Mixture::<1>::new();
        sum.add(0.0, [2.0], [1.0]);
        sum.add(3.0_f64.ln(), [6.0], [1.0]);
        let mean = sum.mean();
        assert!((mean.sizes[0] - 5.0).abs() < 1e-14);
        assert!((mean.deviations[0] - 2.0).abs() < 1e-14);
        assert!((mean.ln - 4.0_f64.ln()).abs() < 1e-15);
    }
}
