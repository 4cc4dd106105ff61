//! Random streams: one for every purpose of every flight of every tail, independent of the order in which they are drawn.
//!
//! The stream cipher is its own seed sequence: seed, tail, flight and purpose *are* the 256-bit key, so two streams
//! differ wherever one of the four differs, and adding a tail or drawing more numbers in one stream changes no other.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

/// The purpose of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub(crate) enum Purpose {
    Design = 1,
    Weather = 2,
    Patches = 3,
    Gusts = 4,
    Airframe = 5,
    Loading = 6,
    Sensors = 7,
    Faults = 8,
    SmoothErrors = 9,
    SensorsOfTail = 10,
    Clutter = 11,
    FleetChoice = 12,
    TypeScatter = 13,
    TailEffect = 14,
    Lives = 15,
    Washes = 16,
    EngineChanges = 17,
}

/// A key of streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Streams {
    seed: u64,
    tail: u64,
    flight: u64,
}

impl Streams {
    /// Streams of one flight of a tail; by the tail's name, so that a plan's other tails do not matter.
    pub(crate) fn of_flight(seed: u64, tail: &str, flight: usize) -> Self {
        Self { seed, tail: fnv_1a(tail.as_bytes()), flight: flight as u64 }
    }

    /// Streams of a tail as a whole.
    pub(crate) fn of_tail(seed: u64, tail: &str) -> Self {
        Self { seed, tail: fnv_1a(tail.as_bytes()), flight: u64::MAX }
    }

    pub(crate) fn stream(self, purpose: Purpose) -> Stream {
        let mut key = [0; 32];
        for (bytes, word) in
            key.chunks_exact_mut(8).zip([self.seed, self.tail, self.flight, purpose as u64])
        {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        Stream(ChaCha8Rng::from_seed(key))
    }
}

/// One random stream.
#[derive(Clone, Debug)]
pub(crate) struct Stream(ChaCha8Rng);

impl Stream {
    /// Standard normal.
    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// Uniform over a range.
    pub(crate) fn uniform(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// Uniform over 0..1, 53 bits.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// True with a probability.
    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// A whole number from 0 up to a count, which must not be 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a product of a share and a count"
        )]
        let drawn = (self.unit() * count as f64) as usize;
        drawn.min(count - 1)
    }

    /// Exponentially distributed.
    pub(crate) fn exponential(&mut self, mean: f64) -> f64 {
        -mean * (1.0 - self.unit()).ln()
    }
}

/// FNV-1a of a name. Source: Fowler, Noll, Vo; offset basis and prime of the 64-bit variant.
fn fnv_1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_of_the_reference() {
        // The authors' test vectors: empty string and "foobar".
        assert_eq!(fnv_1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv_1a(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn streams_differ_by_each_part_of_the_key_and_repeat() {
        let first = |streams: Streams, purpose| streams.stream(purpose).unit().to_bits();
        let base = first(Streams::of_flight(1, "T-001", 1), Purpose::Gusts);
        assert_eq!(base, first(Streams::of_flight(1, "T-001", 1), Purpose::Gusts));
        assert_ne!(base, first(Streams::of_flight(2, "T-001", 1), Purpose::Gusts));
        assert_ne!(base, first(Streams::of_flight(1, "T-002", 1), Purpose::Gusts));
        assert_ne!(base, first(Streams::of_flight(1, "T-001", 2), Purpose::Gusts));
        assert_ne!(base, first(Streams::of_flight(1, "T-001", 1), Purpose::Sensors));
    }
}
