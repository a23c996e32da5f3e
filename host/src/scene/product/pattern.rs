//! Composite position: a pattern of holes or pins to its datums, and each of them within the pattern.
//!
//! The pattern shifts by (x, y) and turns by θ about its middle, so that every axis stays within what the wider zone has over the
//! narrower one: √(x² + y²) + R·|θ| is at most half of their difference, R the distance of the farthest axis. Where the narrower
//! zone has datums that hold the turn, it does not turn.

use slipfit_tolerance::{
    model::{
        Contributor, Variation,
        nested::{Nest, Nested},
    },
    product::{
        contact::{cross, norm, unit},
        feature::Shape,
    },
};

use crate::scene::{Problem, SceneError, value::Field};

use super::{
    datum::datums,
    draft::{Datum, Draft, FeatureDraft},
    geometric::{Callout, WIDTH},
    toleranced,
};

const ALLOWED: &str = "position = { zone = …, within = …, pattern = \"a name\" } of two or more axes of one part";

/// Features that are placed together.
pub(super) struct Pattern<'t, 's> {
    name: String,
    /// Widths (m) of the zones of the pattern, and within it.
    zones: [f64; 2],
    datums: Vec<Datum>,
    /// Whether it turns within its zone.
    turns: bool,
    /// First of its variables: x, y, and θ if it turns.
    first: usize,
    /// Indices of its features.
    members: Vec<usize>,
    field: Field<'t, 's>,
}

/// Reads the keys `pattern` and `within` of a location, `width` (m) wide without a bonus: the number of its pattern in `patterns`,
/// and its width (m) within it.
pub(super) fn of_callout<'t, 's>(
    read: &Callout<'t, 's>,
    width: f64,
    made: &FeatureDraft,
    patterns: &mut Vec<Pattern<'t, 's>>,
    draft: &mut Draft,
) -> Result<Option<(usize, f64)>, SceneError> {
    let held = read.field.get("within_datum");
    let (name, within) = match (read.field.get("pattern"), read.field.get("within")) {
        (None, None) if held.is_none() => return Ok(None),
        (Some(name), Some(within)) => (name, within),
        (name, _) => {
            let missing = if name.is_some() { "within" } else { "pattern" };
            let key = format!("{}.{missing}", read.field.key);
            return Err(read.field.error(Problem::Missing(key), ALLOWED));
        }
    };
    if read.name != "position" || made.feature.shape != Shape::Axis {
        let what = format!("a composite {} of {}", read.name, made.feature.shape.article());
        return Err(name.error(Problem::Unsupported { what }, ALLOWED));
    }
    let narrower = match read.material {
        Some(_) => within.to_number(&WIDTH)?,
        None => toleranced::positive(&within, &WIDTH)?,
    };
    if narrower >= width {
        return Err(within.out_of_range("mm", "less than the zone of the pattern"));
    }
    let turns = match held {
        None => true,
        Some(list) => {
            let held = datums(&list, draft)?;
            if !read.datums.starts_with(&held) {
                let what = format!("{} other than the first datums of the zone", list.key);
                return Err(list.error(Problem::Unsupported { what }, "the first of its datums, in their order"));
            }
            // The primary datum alone holds tilts of the pattern, which has none.
            held.len() < 2
        }
    };
    let (part, _) = made.name.split_once('.').unwrap_or_default();
    let full = format!("{part}.{}", name.to_text()?);
    let zones = [width, narrower];
    if let Some(known) = patterns.iter().position(|pattern| pattern.name == full) {
        let Pattern { zones: known_zones, datums: known_datums, turns: known_turns, .. } = &patterns[known];
        if *known_zones != zones || *known_datums != read.datums || *known_turns != turns {
            let what = format!("the pattern `{full}` with different zones or datums");
            return Err(name.error(Problem::Unsupported { what }, "the same of all its features"));
        }
        return Ok(Some((known, narrower)));
    }
    // Of the two tilts of such a zone θ is one; the other moves nothing.
    let (variation, means): (_, &[f64]) = match turns {
        true => (Variation::Nested(Nested { of: Nest::Axis, rule: read.rule, tilts: 1.0 }), &[0.0; 4]),
        false => (Variation::Disc(read.rule), &[0.0; 2]),
    };
    let first = draft.add(Contributor { name: format!("{full} pattern"), variation }, means);
    let datums = read.datums.clone();
    patterns.push(Pattern { name: full, zones, datums, turns, first, members: Vec::new(), field: name });
    Ok(Some((patterns.len() - 1, narrower)))
}

impl Pattern<'_, '_> {
    /// Adds the feature with this index.
    pub fn add(&mut self, feature: usize) {
        self.members.push(feature);
    }

    /// Lets all its features move with it.
    ///
    /// # Errors
    /// A pattern of one feature, or of axes that are not parallel.
    pub fn place(&self, draft: &mut Draft) -> Result<(), SceneError> {
        let refuse = |what: String| Err(self.field.error(Problem::Unsupported { what }, ALLOWED));
        let features = &mut draft.assembly.features;
        let count = self.members.len() as f64;
        let nominal = |i: &usize| features[*i].nominal;
        let places = || self.members.iter().map(|i| nominal(i)[0]);
        let centre = places().fold([0.0; 3], |sum, at| [0, 1, 2].map(|k| sum[k] + at[k] / count));
        let axis = nominal(&self.members[0])[1];
        if self.members.iter().any(|i| norm(cross(nominal(i)[1], axis)) > 1e-9) {
            return refuse(format!("the pattern `{}` of axes that are not parallel", self.name));
        }
        let arms: Vec<_> = places().map(|at| cross(axis, [0, 1, 2].map(|k| at[k] - centre[k]))).collect();
        let Some((farthest, first)) = arms
            .iter()
            .map(|arm| (norm(*arm), *arm))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .and_then(|(farthest, arm)| Some((farthest, unit(arm)?)))
        else {
            return refuse(format!("the pattern `{}` of one axis", self.name));
        };
        let half = 0.5 * (self.zones[0] - self.zones[1]);
        for (member, arm) in self.members.iter().zip(arms) {
            let feature = &mut features[*member];
            feature.shift(self.first, first, half);
            feature.shift(self.first + 1, cross(axis, first), half);
            if self.turns {
                feature.shift(self.first + 2, arm, half / farthest);
            }
        }
        Ok(())
    }
}
