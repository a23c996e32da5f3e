//! Tables that are read, and what is said of those that are wrong.
#![cfg(test)]

use proptest::prelude::*;

use super::{CsvError, Options, Problem, read, read_file, write};
use crate::{
    table::{Column, Grouping, MeasuredTable},
    unit::Unit,
};

const TABLE: &str = "\
part,cavity,length [mm],angle [°]
nominal,,208,90
lower,,207.964,
upper,,208.036,90.5
1,A,208.011,90.12
2,B,207.998,-
3,,208.02,90.3
";

fn grouped() -> Options {
    Options { groups: vec!["cavity".into()], ..Options::default() }
}

#[test]
fn limits_labels_and_groups_are_read() {
    let table = read(TABLE.as_bytes(), &grouped()).expect("a table");
    let [length, angle] = table.columns() else { panic!("{table:?}") };
    assert_eq!((length.name.as_str(), length.unit, length.nominal), ("length", Unit::Millimetre, Some(208.0)));
    assert_eq!(length.limits, [Some(207.964), Some(208.036)]);
    assert_eq!((angle.unit, angle.limits), (Unit::Degree, [None, Some(90.5)]));
    assert_eq!(angle.values, [Some(90.12), None, Some(90.3)]);
    assert_eq!(table.groupings()[0].group_of, [Some(0), Some(1), None]);
    assert_eq!(table.label(2), "3");
    assert_eq!(read(write(&table).as_bytes(), &grouped()), Ok(table));
}

/// Limits stand above or below the parts, labels in any column, by the names of other programs, too.
#[test]
fn limits_and_labels_stand_anywhere() {
    let expected = read(TABLE.as_bytes(), &grouped()).expect("a table");
    let [head, limits @ .., one, two, three] = &TABLE.lines().collect::<Vec<_>>()[..] else { panic!("six lines") };
    let below = [&[*head, *one, *two, *three][..], limits].concat().join("\n");
    let names = TABLE.replace("nominal", "Target").replace("lower", "LSL").replace("upper", "USL");
    let turned = |line: &str| line.split(',').rev().collect::<Vec<_>>().join(",");
    let backwards = TABLE.lines().map(turned).collect::<Vec<_>>().join("\n");
    for text in [below, names] {
        assert_eq!(read(text.as_bytes(), &grouped()), Ok(expected.clone()), "{text}");
    }
    let table = read(backwards.as_bytes(), &grouped()).expect("a table");
    let [angle, length] = table.columns() else { panic!("{table:?}") };
    assert_eq!(
        [length, angle].map(|column| &column.values),
        [&expected.columns()[0].values, &expected.columns()[1].values]
    );
    assert_eq!((length.limits, table.label(2)), (expected.columns()[0].limits, "3".into()));
    // A file without labels has no rows but parts.
    assert!(read("a [mm]\n1\n2\nlower\n".as_bytes(), &Options::default()).is_err());
}

#[test]
fn other_spellings_read_as_the_same_table() {
    let expected = read(TABLE.as_bytes(), &grouped());
    let german = TABLE.replace(',', ";").replace('.', ",").replace("90;12", "90,12");
    for text in [
        format!("\u{feff}{TABLE}"),
        TABLE.replace('\n', "\r\n"),
        german,
        TABLE.replace(',', "\t"),
        TABLE.replace("-\n", "NaN\n\n,,,\n"),
    ] {
        assert_eq!(read(text.as_bytes(), &grouped()), expected, "{text}");
    }
    let bare = read(b"a,b [inch]\n1,2\n3,4\n", &Options::default()).expect("a table");
    assert_eq!((bare.labels(), bare.columns()[1].unit, bare.parts()), (None, Unit::Inch, 2));
}

fn error(text: &str, options: &Options) -> CsvError {
    read(text.as_bytes(), options).expect_err(text)
}

#[test]
fn errors_name_the_place_the_value_and_what_is_allowed() {
    for (text, message) in [
        ("", "line 1, column 1: the file is empty; its first row must name the columns, such as `part,length [mm]`"),
        (
            "a [kg]\n1\n",
            "line 1, column 1: column \"a\": \"kg\" is not a unit of measured values, which are mm, µm (um), m, in (inch), ° (deg) and rad",
        ),
        ("a,b,a\n1,2,3\n", "line 1, column 5: there are two columns \"a\"; each needs a name that no other has"),
        ("a,,b\n1,2,3\n", "line 1, column 3: column 2 has no name"),
        ("a,b\n1,2\n3\n", "line 3, column 2: this row has 1 cells, but the head has 2"),
        ("a,b\n1,2\n3,4,5\n", "line 3, column 5: this row has 3 cells, but the head has 2"),
        (
            "é,b\n\"1\",ünf\n",
            "line 2, column 5: \"ünf\" in column \"b\" is not a number; missing values are empty, `-`, `NA` or `NaN`, and a column of texts must be named as a grouping or left out",
        ),
        (
            "a\n1\n1e999\n",
            "line 3, column 1: \"1e999\" in column \"a\" is not finite; its amount must be below 1.8e308",
        ),
        (
            "a;b\n1,5;1.5\n",
            "line 2, column 5: \"1.5\" in column \"b\" has the decimal mark `.`, but numbers before it have `,`",
        ),
        ("part,a\nlower,1\nlower,2\n1,2\n", "line 3, column 1: there are two rows `lower`"),
        (
            "part,a\nlower,2\nupper,1\n1,2\n",
            "line 3, column 7: column \"a\" has the lower limit 2, which is not below its upper limit 1",
        ),
        ("part,a\nlower,1\n", "line 3, column 1: there is no row with a measured part"),
        ("part\n1\n", "line 1, column 1: there is no column with measured values, only labels and groupings"),
    ] {
        assert_eq!(error(text, &Options::default()).to_string(), message);
    }
    let missing = error("a\n1\n", &grouped()).to_string();
    assert_eq!(missing, "line 1, column 1: there is no column \"cavity\" for subgroups; the columns are \"a\"");
    let latin = read(b"a,b\n1,\xb5\n", &Options::default()).expect_err("not UTF-8");
    assert_eq!((latin.place.line, latin.place.column, latin.problem), (2, 3, Problem::NotUtf8));
    let escaped = error("a\n\u{1b}[31m\n", &Options::default()).to_string();
    assert!(escaped.contains("\\u{1b}"), "{escaped}");
}

#[test]
fn large_files_are_refused_unread() {
    let folder = std::env::temp_dir().join(format!("slipfit-measured-{}", std::process::id()));
    std::fs::write(&folder, "a\n1\n2\n").expect("written");
    let options = Options { largest: 5, ..Options::default() };
    let error = read_file(&folder, &options).expect_err("too large").to_string();
    let read = read_file(&folder, &Options::default());
    std::fs::remove_file(&folder).expect("removed");
    assert!(error.contains("6 bytes, of which at most 5 are read"), "{error}");
    assert!(read.is_ok());
}

proptest! {
    #[test]
    fn any_bytes_end_without_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = read(&bytes, &Options::default());
    }

    #[test]
    fn any_text_of_cells_ends_with_a_place_within_it(text in "[ab1-3.,;\"\n\r\tµ-]{0,80}") {
        if let Err(error) = read(text.as_bytes(), &Options::default()) {
            prop_assert!(error.place.span.end <= text.len(), "{:?}", error);
            prop_assert!(text.is_char_boundary(error.place.span.start), "{:?}", error);
        }
    }

    #[test]
    fn what_is_written_reads_the_same(
        values in prop::collection::vec(prop::option::of(-1e300f64..1e300), 1..20),
        name in "[a-z ,\"\\[\\];]{1,8}[a-z\\]]",
        nominal in prop::option::of(-1e9f64..1e9),
    ) {
        let name = name.trim().to_owned();
        let groups: Vec<&str> = values.iter().map(|value| if value.is_some() { "x, y" } else { "" }).collect();
        let column = Column { name, nominal, unit: Unit::None, values: values.clone(), ..Column::default() };
        let table = MeasuredTable::new(vec![column]).and_then(|t| t.with_grouping(Grouping::new("A", groups))).expect("a table");
        let labels: Vec<String> = (1..=values.len()).map(|part| part.to_string()).collect();
        let expected = if nominal.is_some() { table.clone().with_labels(labels).expect("labels") } else { table.clone() };
        let options = Options { groups: vec!["A".into()], ..Options::default() };
        prop_assert_eq!(read(write(&table).as_bytes(), &options), Ok(expected), "{}", write(&table));
    }
}
