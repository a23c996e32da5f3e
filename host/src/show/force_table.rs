//! A force table as a picture: what a lookup gives, node by node.

use slipfit_core::table::{AxisKind, Table};
use slipfit_tolerance::number::{level, typeset};

use crate::firmware::force_table::ForceTable;
use crate::{
    dynamics::driven::DriveKind,
    firmware::flash::AxisSpec,
    show::plot::{Chart, Look, Panel, PlotError, Scale, Series, line_chart},
};

/// The force of `table` over its second axis, a line a level, as SVG; of a table over three axes at the last speed.
///
/// # Errors
/// [`PlotError`], if there is nothing to draw.
pub fn picture(kind: DriveKind, table: &ForceTable, title: &str) -> Result<String, PlotError> {
    let at = |axis: &AxisSpec, i: usize| axis.first + axis.step * i as f32;
    let [levels, along, ..] = &table.axes[..] else { return Err(PlotError::Empty) };
    let speed = table.axes.get(2).map(|axis| at(axis, axis.count - 1));
    let force = |n: f32, x: f32| match speed {
        None => Table::<2>::open(&table.bytes).map(|table| table.lookup([n, x]).force),
        Some(speed) => Table::<3>::open(&table.bytes).map(|table| table.lookup([n, x, speed]).force),
    };
    let shown = |x: f64| if along.kind == AxisKind::Position { kind.travel(x) } else { x * 1e3 };
    let line = |n: f32| {
        let points = (0..along.count).filter_map(|i| {
            let x = at(along, i);
            Some((shown(f64::from(x)), f64::from(force(n, x).ok()?)))
        });
        let n = f64::from(n);
        Series { label: format!("n = {}", typeset(&level(n))), look: Look::Level(n), points: points.collect() }
    };
    let speed = speed.map_or_else(String::new, |speed| {
        format!(", commanded to {} {}", kind.speed(f64::from(speed)), kind.speed_unit())
    });
    let (what, x_label) = match along.kind {
        AxisKind::Position => ("position", format!("position ({})", kind.travel_unit())),
        _ => ("time", "time (ms)".to_owned()),
    };
    line_chart(&Chart {
        title: title.to_owned(),
        subtitle: format!("drive {} over {what}{speed}, as the flash table gives it", kind.effort()),
        x_label,
        scale: Scale::Linear,
        panels: vec![Panel {
            y_label: format!("drive {} ({})", kind.effort(), kind.effort_unit()),
            series: (0..levels.count).map(|i| line(at(levels, i))).collect(),
            ..Panel::default()
        }],
    })
}
