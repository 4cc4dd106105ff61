//! Random numbers: one stream a purpose, the same on every machine.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Open01, StandardNormal};

/// A source of standard normal numbers: the same for the same seed and stream on every machine.
pub(crate) struct RandomStream(ChaCha8Rng);

impl RandomStream {
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&stream.to_le_bytes());
        Self(ChaCha8Rng::from_seed(key))
    }

    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    pub(crate) fn fill(&mut self, into: &mut [f64]) {
        for slot in into {
            *slot = self.normal();
        }
    }

    /// A number evenly between 0 and 1, neither of them.
    pub(crate) fn uniform(&mut self) -> f64 {
        Open01.sample(&mut self.0)
    }

    /// An exponential number of mean 1.
    pub(crate) fn exponential(&mut self) -> f64 {
        -self.uniform().ln()
    }

    /// A number from 0 to n − 1.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        use rand_chacha::rand_core::Rng;
        // The upper half of a product with 64 random bits; biased by less than n/2^64.
        let wide = u128::from(self.0.next_u64()) * n as u128;
        usize::try_from(wide >> 64).unwrap_or(0)
    }
}
