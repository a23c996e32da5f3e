//! What stands on drawings: symbols, letters in circles and words, and what they are in a scene.

/// Callouts and what else is written beside them, and what it is here, a key or nothing. Words are without hyphens and the like.
const WRITTEN: &[(&[&str], &str)] = &[
    (&["⏥", "▱"], "flatness"),
    (&["⏤", "—"], "straightness"),
    (&["○", "◯", "roundness", "circularity"], "roundness"),
    (&["⌭", "cylindricity"], "cylindricity"),
    (&["∥", "//", "parallel"], "parallelism"),
    (&["⊥", "⟂", "squareness", "perpendicular"], "perpendicularity"),
    (&["∠", "angular"], "angularity"),
    (&["⌖", "⊕", "trueposition", "location"], "position"),
    (&["⌓", "surfaceprofile", "profileofasurface"], "profile"),
    (&["◎", "coaxiality", "coaxial"], "coaxiality"),
    (&["concentricity", "concentric"], "concentricity"),
    (&["⌯", "symmetry"], "symmetry"),
    (&["↗", "runout", "circularrunout", "tir"], "run_out"),
    (&["⌰", "⌮", "totalrunout"], "total_run_out"),
    (&["modifier", "modifiers"], "material"),
    (&["⌒", "lineprofile", "profileofaline"], "the profile of a line"),
    (&["composite", "compositeposition"], "within"),
    (&["datumtarget", "datumtargets"], "datum targets"),
];

/// A letter in a circle.
#[derive(Debug, PartialEq)]
pub(super) struct Modifier {
    pub symbol: char,
    /// How else it is written, without hyphens and the like.
    names: &'static [&'static str],
    pub meaning: &'static str,
}

const fn modifier(symbol: char, names: &'static [&'static str], meaning: &'static str) -> Modifier {
    Modifier { symbol, names, meaning }
}

const MODIFIERS: [Modifier; 13] = [
    modifier('Ⓜ', &["mmc", "mmr", "maximummaterial"], "the maximum material condition"),
    modifier('Ⓛ', &["lmc", "lmr", "leastmaterial"], "the least material condition"),
    modifier('Ⓢ', &["rfs"], "regardless of feature size"),
    modifier('Ⓟ', &["projected", "projectedzone"], "a projected tolerance zone"),
    modifier('Ⓣ', &["tangent", "tangentplane"], "a tangent plane"),
    modifier('Ⓕ', &["free", "freestate"], "the free state"),
    modifier('Ⓡ', &["reciprocity"], "the reciprocity requirement"),
    modifier('Ⓔ', &["envelope"], "the envelope requirement"),
    modifier('Ⓘ', &["independency"], "independency"),
    modifier('Ⓤ', &["uz", "unequal"], "an unequally disposed profile"),
    modifier('Ⓐ', &["derived"], "a derived feature"),
    modifier('Ⓒ', &["cz", "commonzone", "combinedzone"], "a combined zone"),
    modifier('Ⓖ', &["gauss"], "an associated feature"),
];

/// `text` as words are listed here.
fn plain(text: &str) -> String {
    text.to_lowercase().chars().filter(|c| !" -_".contains(*c)).collect()
}

/// What something that a drawing has is here: a key of a scene, or its name if there is none.
pub(super) fn meaning(written: &str) -> Option<&'static str> {
    let plain = plain(written);
    let is = |known: &&str| **known == *written || **known == *plain;
    if let Some((_, meaning)) = WRITTEN.iter().find(|(known, _)| known.iter().any(is)) {
        return Some(meaning);
    }
    let found = match split(written) {
        Some(("", modifier)) => Some(modifier),
        _ => named(written),
    }?;
    Some(if matches!(found.symbol, 'Ⓜ' | 'Ⓛ') { "material" } else { found.meaning })
}

/// A text without the modifier at its end, and that modifier: its symbol, or its letter in parentheses.
pub(super) fn split(text: &str) -> Option<(&str, &'static Modifier)> {
    let text = text.trim_end();
    MODIFIERS.iter().find_map(|modifier| {
        let letter = char::from_u32(modifier.symbol as u32 - 'Ⓐ' as u32 + 'A' as u32)?;
        let ends = [modifier.symbol.to_string(), format!("({letter})"), format!("({})", letter.to_ascii_lowercase())];
        let rest = ends.iter().find_map(|end| text.strip_suffix(end.as_str()))?;
        Some((rest.trim_end(), modifier))
    })
}

/// The modifier of this name.
pub(super) fn named(text: &str) -> Option<&'static Modifier> {
    let plain = plain(text);
    MODIFIERS.iter().find(|modifier| modifier.names.contains(&plain.as_str()))
}

#[cfg(test)]
mod tests {
    use super::{meaning, split};

    #[test]
    fn modifiers_are_known_in_each_way_to_write_them() {
        let known = |text| split(text).map(|(rest, modifier)| (rest, modifier.symbol));
        for text in ["part.bore Ⓜ", "part.bore(M)", "part.bore (m) "] {
            assert_eq!(known(text), Some(("part.bore", 'Ⓜ')), "{text}");
        }
        assert_eq!(split("0.2 (P)").unwrap().1.meaning, "a projected tolerance zone");
        assert_eq!((known("part.bore"), known("part.(X)")), (None, None));
        for text in ["Ⓟ", "(p)", "projected-zone", "Projected"] {
            assert_eq!(meaning(text), Some("a projected tolerance zone"), "{text}");
        }
        assert_eq!((meaning("MMC"), meaning("0.2 (P)")), (Some("material"), None));
    }
}
