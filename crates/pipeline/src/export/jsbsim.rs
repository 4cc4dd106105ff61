//! A drag function of JSBSim: a table over CL² and Mach number.

use std::fmt::Write;

use super::{origin, remainder_left_out};
use crate::model_file::ModelFile;

/// An `<aerodynamics>` file with the drag axis.
///
/// Rows are over CL² (`aero/cl-squared`), in which a polar is a straight line, so that JSBSim's linear interpolation is
/// exact for it; at the nodes of the table the values are the model's own. JSBSim holds a table's edge outside it: there
/// the drag is not the model's.
///
/// # Source
/// JSBSim Reference Manual, "Functions" and "Tables": a two-dimensional table has the column breakpoints in its first
/// line and a row breakpoint at the start of each other.
#[must_use]
pub fn jsbsim(model: &ModelFile) -> String {
    let grid = model.grid();
    let drag = model.drag_coefficient();
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    let _ = writeln!(text, "<!-- cruisefit: {} -->", comment(&origin(model)));
    let (lift, mach) = (grid.x(), grid.y());
    let _ = writeln!(
        text,
        "<!-- Cruise drag over lift coefficients {} to {} and Mach numbers {} to {}; JSBSim holds the edge outside. -->",
        lift.first(),
        lift.last(),
        mach.first(),
        mach.last()
    );
    if let Some(left_out) = remainder_left_out(model) {
        let _ = writeln!(text, "<!-- Drag alone: {}. -->", comment(&left_out.words()));
    }
    let area_m2 = model.initial.aircraft().wing_area().to_square_meters();
    let _ = writeln!(
        text,
        "<!-- Coefficients refer to a wing area of {area_m2} m2: <wingarea unit=\"M2\">. -->"
    );
    text.push_str(
        "<aerodynamics>\n <axis name=\"DRAG\">\n  <function name=\"aero/force/drag-cruisefit\">\n   \
         <description>Drag in cruise</description>\n   <product>\n    <property>aero/qbar-psf</property>\n    \
         <property>metrics/Sw-sqft</property>\n    <table>\n     \
         <independentVar lookup=\"row\">aero/cl-squared</independentVar>\n     \
         <independentVar lookup=\"column\">velocities/mach</independentVar>\n     <tableData>\n",
    );
    let row = |text: &mut String, first: Option<f64>, values: &mut dyn Iterator<Item = f64>| {
        text.push_str("      ");
        if let Some(first) = first {
            let _ = write!(text, "{first}");
        }
        for value in values {
            let _ = write!(text, "\t{value}");
        }
        text.push('\n');
    };
    row(&mut text, None, &mut mach.breakpoints().iter().copied());
    for (index, lift_coefficient) in lift.breakpoints().iter().enumerate() {
        let nodes = index * mach.len()..(index + 1) * mach.len();
        let square = lift_coefficient * lift_coefficient;
        row(&mut text, Some(square), &mut nodes.map(|node| drag.value_at_node(node)));
    }
    text.push_str(
        "     </tableData>\n    </table>\n   </product>\n  </function>\n </axis>\n</aerodynamics>\n",
    );
    text
}

/// Text inside an XML comment: without two hyphens in a row, or one at its end.
fn comment(text: &str) -> String {
    text.replace('-', "\u{2011}").replace(['\n', '\r'], " ")
}
