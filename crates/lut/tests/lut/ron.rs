//! Reading what was written restores the same bits; text edited into nonsense is refused.

use std::sync::Arc;

use lut::surface::{Basis, Surface};
use lut::{Axis, Grid, Table};
use proptest::prelude::*;

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn any_finite() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |value| value.is_finite())
}

proptest! {
    #[test]
    fn tables_come_back_to_the_bit(
        values in prop::collection::vec(any_finite(), 12),
        (first, step) in (-1.0..1.0, 1e-6..10.0),
    ) {
        let axis = |count: u32| {
            Axis::new((0..count).map(|i| first + f64::from(i) * step).collect()).unwrap()
        };
        let table = Table::new(Arc::new(Grid::new(axis(4), axis(3))), values).unwrap();
        let text = ron::to_string(&table).unwrap();
        let back: Table = ron::from_str(&text).unwrap();
        prop_assert_eq!(bits(back.values()), bits(table.values()));
        prop_assert_eq!(bits(back.grid().x().breakpoints()), bits(table.grid().x().breakpoints()));
        prop_assert_eq!(bits(back.grid().y().breakpoints()), bits(table.grid().y().breakpoints()));
        let pretty = ron::ser::to_string_pretty(&back, ron::ser::PrettyConfig::default()).unwrap();
        prop_assert_eq!(bits(ron::from_str::<Table>(&pretty).unwrap().values()), bits(table.values()));
    }

    #[test]
    fn surfaces_come_back_to_the_bit(coefficients in prop::array::uniform6(any_finite())) {
        let surface = Surface { basis: Basis::FullQuadratic, coefficients };
        let back: Surface = ron::from_str(&ron::to_string(&surface).unwrap()).unwrap();
        prop_assert_eq!(bits(&back.coefficients), bits(&coefficients));
        prop_assert_eq!(back.basis, surface.basis);
    }
}

#[test]
fn text_is_for_people() {
    let x = Axis::from_step(0.1, 0.2, 0.05).unwrap();
    let y = Axis::new(vec![0.5, 0.6]).unwrap();
    let values = vec![-0.0, 1.0, 0.1 + 0.2, 0.3, 1e-3, 2.5];
    let table = Table::new(Arc::new(Grid::new(x, y)), values).unwrap();
    assert_eq!(
        ron::to_string(&table).unwrap(),
        "(grid:(x:[0.1,0.15,0.2],y:[0.5,0.6]),values:[-0.0,1.0,0.30000000000000004,0.3,0.001,2.5])"
    );
}

#[test]
fn edited_text_goes_through_the_same_checks() {
    let refused = |text: &str, reason: &str| {
        let error = ron::from_str::<Table>(text).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    };
    assert!(ron::from_str::<Table>("(grid:(x:[0.1,0.2],y:[0.5,0.6]),values:[1,2,3,4])").is_ok());
    refused("(grid:(x:[0.2,0.1],y:[0.5,0.6]),values:[1,2,3,4])", "breakpoints must increase");
    refused("(grid:(x:[0.1],y:[0.5,0.6]),values:[1,2])", "an axis needs 2 or more");
    refused("(grid:(x:[0.1,0.2],y:[0.5,0.6]),values:[1,2,3])", "3 values for 4 nodes");
    refused("(grid:(x:[0.1,0.2],y:[0.5,0.6]),values:[1,2,3,NaN])", "not a finite number");
    refused("(grid:(x:[0.1,0.2],y:[0.5,0.6]),values:[1,2,3,4],z:1)", "z");
}
