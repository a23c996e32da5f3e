//! Marks at points: shapes that differ without colour, too.

use crate::show::{
    chart::Shape,
    palette::{Colour, PAPER},
    svg::{Stroke, Svg, number},
};

/// Marks of one kind at `points`, `r` in radius, as one element.
pub fn draw(svg: &mut Svg, shape: Shape, points: &[[f64; 2]], r: f64, colour: Colour) {
    let outline = Some(Stroke::new(colour, 1.5));
    let path = || points.iter().map(|point| path(shape, *point, r)).collect::<String>();
    match shape {
        _ if points.is_empty() => {}
        Shape::Ring => svg.path(&path(), Some(PAPER), outline),
        Shape::Cross | Shape::Plus | Shape::Star => svg.path(&path(), None, outline),
        _ => svg.path(&path(), Some(colour), None),
    }
}

fn path(shape: Shape, [x, y]: [f64; 2], r: f64) -> String {
    let closed = |corners: &[[f64; 2]]| {
        let corners: Vec<String> =
            corners.iter().map(|[dx, dy]| format!("{},{}", number(x + r * dx), number(y + r * dy))).collect();
        format!("M{}Z", corners.join("L"))
    };
    let stroke = |[dx, dy]: [f64; 2]| {
        let [from_x, from_y, to_x, to_y] = [x - r * dx, y - r * dy, x + r * dx, y + r * dy].map(number);
        format!("M{from_x},{from_y}L{to_x},{to_y}")
    };
    let disc = |r: f64| {
        let ([left, y], [r, across]) = ([x - r, y].map(number), [r, 2.0 * r].map(number));
        format!("M{left},{y}a{r},{r} 0 1,1 {across},0a{r},{r} 0 1,1 -{across},0")
    };
    let cross = || stroke([1.0, 1.0]) + &stroke([-1.0, 1.0]);
    let plus = || stroke([1.0, 0.0]) + &stroke([0.0, 1.0]);
    match shape {
        Shape::Dot => disc(r),
        Shape::Ring => disc(r - 0.5),
        Shape::Triangle => closed(&[[-1.0, 1.0], [0.0, -1.0], [1.0, 1.0]]),
        Shape::Wedge => closed(&[[-1.0, -1.0], [0.0, 1.0], [1.0, -1.0]]),
        Shape::Square => closed(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]),
        Shape::Diamond => closed(&[[-1.25, 0.0], [0.0, -1.25], [1.25, 0.0], [0.0, 1.25]]),
        Shape::Cross => cross(),
        Shape::Plus => plus(),
        Shape::Star => cross() + &plus(),
    }
}
