//! Decides for each tolerance and feature whether the part states it.

use super::{
    entry::{Class, Entry},
    geometry::is_pattern,
    rules,
};
use crate::drawing::{Drawing, Limits, Shape};

/// What a part states, and why it does not state the rest.
pub struct Decided {
    /// The tolerances that each feature has in the part.
    pub entries: Vec<Vec<Entry>>,
    /// For each tolerance the features in which it is not in the part, with the reason; none of a tolerance of no feature.
    pub refused: Vec<Vec<(Option<usize>, String)>>,
    /// Features of the part in an order in which datums come first.
    pub order: Vec<usize>,
}

/// Decides what of a `drawing` its part states.
pub fn decide(drawing: &Drawing) -> Decided {
    let count = drawing.features.len();
    let mut decided = Decided {
        entries: vec![Vec::new(); count],
        refused: vec![Vec::new(); drawing.tolerances.len()],
        order: Vec::new(),
    };
    decided.sizes(drawing);
    decided.geometric(drawing);
    for feature in 0..count {
        decided.one_each(feature);
        decided.narrower_orientation(feature, drawing);
    }
    decided.whole_patterns(drawing);
    decided.sort(drawing);
    decided.whole_patterns(drawing);
    decided
}

impl Decided {
    fn refuse(&mut self, tolerance: usize, feature: usize, reason: String) {
        self.refused[tolerance].push((Some(feature), reason));
    }

    /// Takes entries of a feature out.
    fn remove(&mut self, feature: usize, is_out: impl Fn(&Entry) -> bool, reason: &str) {
        let out: Vec<_> = self.entries[feature].iter().filter(|entry| is_out(entry)).map(|e| e.tolerance).collect();
        self.entries[feature].retain(|entry| !is_out(entry));
        for tolerance in out {
            self.refuse(tolerance, feature, reason.to_owned());
        }
    }

    fn sizes(&mut self, drawing: &Drawing) {
        for (i, tolerance) in drawing.tolerances.iter().enumerate() {
            let Limits::Diameter(size) = &tolerance.limits else { continue };
            if tolerance.features.is_empty() {
                self.refused[i].push((None, "it is of no feature".into()));
            }
            for &feature in &tolerance.features {
                let is_taken = !self.entries[feature].is_empty();
                let entry = match &drawing.features[feature].shape {
                    Ok(Shape::Axis(_)) if is_taken => Err("a second size of the feature".into()),
                    Ok(Shape::Axis(axis)) => rules::size(i, size, axis),
                    Ok(_) => Err("a diameter of a feature that is no cylinder".into()),
                    Err(reason) => Err(reason.clone()),
                };
                match entry {
                    Ok(entry) => self.entries[feature].push(entry),
                    Err(reason) => self.refuse(i, feature, reason),
                }
            }
        }
    }

    fn geometric(&mut self, drawing: &Drawing) {
        let sizes: Vec<_> = self.entries.iter().map(|entries| entries.first()?.diameter.clone()).collect();
        for (i, tolerance) in drawing.tolerances.iter().enumerate() {
            let geometric = match &tolerance.limits {
                Limits::Geometric(geometric) => Ok(geometric),
                Limits::NotRead(reason) | Limits::Nothing(reason) => Err(reason),
                Limits::Diameter(_) => continue,
            };
            if tolerance.features.is_empty() {
                let reason = geometric.err().cloned().unwrap_or_else(|| "it is of no feature".into());
                self.refused[i].push((None, reason));
            }
            for &feature in &tolerance.features {
                let entry = geometric.map_err(String::clone);
                match entry.and_then(|geometric| rules::geometric(i, geometric, feature, drawing, &sizes)) {
                    Ok(entry) => self.entries[feature].push(entry),
                    Err(reason) => self.refuse(i, feature, reason),
                }
            }
        }
    }

    /// Leaves a feature one location, one orientation and one of each form: of two locations the one with more datums, otherwise
    /// the narrower one, which is all that a part can state of both.
    fn one_each(&mut self, feature: usize) {
        let mut entries = std::mem::take(&mut self.entries[feature]);
        let datums = |entry: &Entry| if entry.class == Class::Location { entry.datums.len() } else { 0 };
        entries.sort_by(|a, b| datums(b).cmp(&datums(a)).then(a.width.total_cmp(&b.width)));
        let mut kept: Vec<Entry> = Vec::new();
        for entry in entries {
            let is_rival = |known: &&Entry| match entry.class {
                Class::Form | Class::Size => known.key == entry.key,
                class => known.class == class,
            };
            match kept.iter().find(is_rival).map(|known| known.key) {
                Some(other) => {
                    let what = if entry.class == Class::Location { "locations" } else { "tolerances of this kind" };
                    self.refuse(entry.tolerance, feature, format!("the part has its {other}, and not two {what}"));
                }
                None => kept.push(entry),
            }
        }
        kept.sort_by_key(|entry| (entry.class != Class::Size, entry.tolerance));
        self.entries[feature] = kept;
    }

    /// Takes an orientation out that is wider than the location at a limit of the diameter, which a scene refuses where one of
    /// both is at a condition of material.
    fn narrower_orientation(&mut self, feature: usize, drawing: &Drawing) {
        let entries = &self.entries[feature];
        let of = |class: Class| entries.iter().find(|entry| entry.class == class);
        let (Some(location), Some(orientation)) = (of(Class::Location), of(Class::Orientation)) else { return };
        let size = of(Class::Size).and_then(|entry| entry.diameter.as_ref());
        let (Some(size), Ok(Shape::Axis(axis))) = (size, &drawing.features[feature].shape) else { return };
        let limits = size.deviations.map(|deviation| size.nominal + deviation);
        let is_hole = axis.is_hole.unwrap_or_default();
        let width = |entry: &Entry| entry.within.map_or(entry.width, |(width, _)| width);
        let at = |entry: &Entry, diameter| entry.width_at(diameter, limits, is_hole) - entry.width + width(entry);
        let has_bonus = [location, orientation].iter().any(|entry| entry.material != Default::default());
        let is_wider = |diameter: &f64| at(orientation, *diameter) > at(location, *diameter) + 1e-9;
        if has_bonus && limits.iter().any(is_wider) {
            let reason = "it is wider than the location at a limit of the diameter";
            self.remove(feature, |entry| entry.class == Class::Orientation, reason);
        }
    }

    /// Takes composite positions out that are not of two or more parallel axes, all in the part.
    fn whole_patterns(&mut self, drawing: &Drawing) {
        for (i, tolerance) in drawing.tolerances.iter().enumerate() {
            let Limits::Geometric(geometric) = &tolerance.limits else { continue };
            if geometric.within.is_none() {
                continue;
            }
            let has = |feature: &usize| self.entries[*feature].iter().any(|entry| entry.tolerance == i);
            let all = tolerance.features.iter().all(has);
            let shapes: Vec<_> =
                tolerance.features.iter().filter_map(|i| drawing.features[*i].shape.as_ref().ok().copied()).collect();
            if all && is_pattern(&shapes) {
                continue;
            }
            for &feature in &tolerance.features {
                let reason = "a composite position of something other than parallel axes of the part";
                self.remove(feature, |entry| entry.tolerance == i, reason);
            }
        }
    }

    /// Puts datums before what refers to them. Where features are datums of each other, tolerances of the first one are out.
    fn sort(&mut self, drawing: &Drawing) {
        let count = drawing.features.len();
        let mut is_placed = vec![false; count];
        let mut left: Vec<usize> = (0..count).filter(|i| drawing.features[*i].shape.is_ok()).collect();
        let is_datum: Vec<bool> =
            (0..count).map(|i| drawing.datums.iter().any(|datum| datum.features.contains(&i))).collect();
        left.sort_by_key(|i| !is_datum[*i]);
        while !left.is_empty() {
            let waits = |entry: &Entry| entry.datums.iter().flat_map(|datum| &datum.features).any(|i| !is_placed[*i]);
            let free: Vec<usize> =
                left.iter().copied().filter(|feature| !self.entries[*feature].iter().any(waits)).collect();
            if free.is_empty() {
                let first = left[0];
                let placed = is_placed.clone();
                let waits = |entry: &Entry| entry.datums.iter().flat_map(|datum| &datum.features).any(|i| !placed[*i]);
                self.remove(first, waits, "its datums refer to the feature themselves");
                continue;
            }
            for feature in &free {
                is_placed[*feature] = true;
            }
            left.retain(|feature| !is_placed[*feature]);
            self.order.extend(free);
        }
    }
}
