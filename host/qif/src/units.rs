//! Units of lengths (FileUnitsType).

use std::collections::HashMap;

use roxmltree::Node;

use crate::{
    error::{Problem, QifError},
    format::twelve_digits,
    xml::{child, children, error_at, name, number, path, text_of},
};

/// The units of a file.
#[derive(Clone, Debug, Default)]
pub struct Units {
    /// mm for one unit, by its UnitName.
    lengths: HashMap<String, f64>,
    /// UnitName of lengths that state none; metre if empty.
    primary: String,
    /// UnitName of lengths of tolerances that state none (PMILinearUnit).
    of_tolerances: String,
    /// UnitName of angles that state none; radian if empty.
    pub angle: String,
}

impl Units {
    /// The units that a `QIFDocument` declares.
    ///
    /// # Errors
    /// A factor that is no number.
    pub fn read(document: Node) -> Result<Self, QifError> {
        let mut units = Self::default();
        units.lengths.insert(String::new(), 1e3);
        let Some(file) = child(document, "FileUnits") else { return Ok(units) };
        let lists = ["PrimaryUnits", "OtherUnits"].iter().filter_map(|list| child(file, list));
        for unit in lists.flat_map(children) {
            let Some(unit_name) = text_of(unit, "UnitName") else { continue };
            match name(unit) {
                "LinearUnit" | "PMILinearUnit" => {
                    let factor = path(unit, &["UnitConversion", "Factor"]).map_or(Ok(1.0), number)?;
                    units.lengths.insert(unit_name.to_owned(), twelve_digits(factor * 1e3));
                }
                _ => {}
            }
        }
        let primary = |kind: &str| {
            let unit = path(file, &["PrimaryUnits", kind]).and_then(|unit| text_of(unit, "UnitName"));
            unit.unwrap_or_default().to_owned()
        };
        units.primary = primary("LinearUnit");
        let [length, angle] = ["PMILinearUnit", "PMIAngularUnit"].map(primary);
        units.of_tolerances = if length.is_empty() { units.primary.clone() } else { length };
        units.angle = if angle.is_empty() { primary("AngularUnit") } else { angle };
        Ok(units)
    }

    /// A length (mm) of the geometry (LinearValueType).
    pub fn length(&self, node: Node) -> Result<f64, QifError> {
        Ok(twelve_digits(number(node)? * self.factor(node, &self.primary)?))
    }

    /// A length (mm) of a tolerance or a size (LinearValueType).
    pub fn of_tolerance(&self, node: Node) -> Result<f64, QifError> {
        Ok(twelve_digits(number(node)? * self.factor(node, &self.of_tolerances)?))
    }

    /// mm for one unit of an element of the geometry.
    pub fn scale(&self, node: Node) -> Result<f64, QifError> {
        self.factor(node, &self.primary)
    }

    /// UnitName of the length of a tolerance or a size.
    pub fn name_of_tolerance<'a>(&'a self, node: Node<'a, '_>) -> &'a str {
        node.attribute("linearUnit").unwrap_or(&self.of_tolerances)
    }

    /// mm for one unit of this UnitName.
    pub fn millimetres(&self, unit: &str) -> Option<f64> {
        self.lengths.get(unit).copied()
    }

    fn factor(&self, node: Node, default: &str) -> Result<f64, QifError> {
        let unit = node.attribute("linearUnit").unwrap_or(default);
        self.millimetres(unit).ok_or_else(|| error_at(node, Problem::Unit(unit.to_owned())))
    }
}

#[cfg(test)]
mod tests {
    use super::Units;
    use crate::xml::{child, parse};

    #[test]
    fn units_default_to_those_of_the_file() {
        let unit = |kind: &str, name: &str, factor: &str| {
            format!(
                "<{kind}><UnitName>{name}</UnitName><UnitConversion><Factor>{factor}</Factor></UnitConversion></{kind}>"
            )
        };
        let primary = unit("LinearUnit", "mm", "0.001") + &unit("PMILinearUnit", "inch", "0.0254");
        let text = format!(
            "<Q><FileUnits><PrimaryUnits>{primary}</PrimaryUnits></FileUnits><V>0.438</V><W linearUnit='mm'>2</W><X \
             linearUnit='ell'>1</X></Q>"
        );
        let document = parse(&text).expect("a document");
        let root = document.root_element();
        let units = Units::read(root).expect("units");
        let value = |name: &str| units.of_tolerance(child(root, name).expect("an element"));
        assert_eq!((value("V"), value("W")), (Ok(11.1252), Ok(2.0)));
        assert_eq!(units.length(child(root, "V").expect("an element")), Ok(0.438));
        assert!(value("X").is_err_and(|error| error.to_string().contains("`ell`")));
    }
}
