//! The library of physical effects as a table: id, usual size, what it needs, what it does to the model.
//!
//! `cargo run -p cruisefit-flight --example library_of_effects`
#![allow(clippy::print_stdout, reason = "an example")]

use flight::effect::{EffectId, TypicalSize};

fn main() {
    // An aircraft with two engines.
    let library = EffectId::library(2);
    for id in &library {
        let entry = id.entry();
        let size = match entry.typical {
            TypicalSize::Absolute(size) => format!("{size} {}", entry.unit),
            TypicalSize::ShareOfMass(share) => format!("{:.1} % of the mass", 100.0 * share),
            TypicalSize::Known => "known, 1".to_owned(),
        };
        let needs: Vec<&str> = entry.needs.iter().map(|input| input.name()).collect();
        println!("{:26} {size:32} {:12} {}", id.to_string(), needs.join(" "), entry.perturbation);
    }
    // Names go both ways, and effects of single engines follow the number of engines.
    assert!(library.iter().all(|id| EffectId::from_name(&id.to_string()) == Some(*id)));
    assert_eq!(EffectId::library(4).len(), library.len() + 4);
}
