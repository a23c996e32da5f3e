//! The guide's reference, written from the code: a test fails where the page is another. `INSTA_UPDATE=always` writes it.

use crate::{cli, product::expression::FUNCTIONS, scene};

const INTRODUCTION: &str = "# Reference

This page is generated from the code. What a key takes is what the reader of scenes itself says about it.

## Keys

A scene is a TOML file. A number is in the first unit named, a text carries its own: `mass = 90` and `mass = \"0.09 kg\"` are the same.
A list of tables is written `[[name]]`. On the command line `--set KEY=VALUE` sets a key; a table in a list goes by its name there:
`--set \"pin.left front.left=[0.01, 0.05]\"`.
";

/// Functions of expressions and what they are.
const MEANINGS: [(&str, &str); 10] = [
    ("sqrt", "square root"),
    ("sin", "sine of an angle"),
    ("cos", "cosine of an angle"),
    ("tan", "tangent of an angle"),
    ("asin", "angle with that sine"),
    ("acos", "angle with that cosine"),
    ("atan", "angle with that tangent"),
    ("abs", "absolute value"),
    ("min", "least of several"),
    ("max", "greatest of several"),
];

fn functions() -> String {
    let row = |name: &str| {
        let known = MEANINGS.iter().find(|(known, _)| *known == name);
        let (_, meaning) = known.unwrap_or_else(|| panic!("no description of the function {name}"));
        format!("| `{name}` | {meaning} |\n")
    };
    let rows: String = FUNCTIONS.split(", ").map(row).collect();
    format!("| function | what it is |\n|---|---|\n{rows}")
}

fn page() -> String {
    [
        INTRODUCTION,
        &scene::reference::keys(),
        "\n## Units\n\nCommon spellings mean the same: `um`, `N*s/mm`, `Ns/mm`, `m/s^2`, `deg`. A contact's stiffness is in N/mm^e or N/m^e \
         with the contact's exponent e.\n\n",
        &scene::reference::units(),
        "\n## Distributions\n\n",
        &scene::reference::distributions(),
        "\n## Expressions\n\nA measure's `is` has `+ - * / ^`, parentheses, numbers with units, `pi`, names of dimensions, of diameters \
         (`PART.AXIS.diameter`) and of measures that stand above. A name with blanks stands in single quotes.\n\n",
        &functions(),
        "\n## Commands\n\nEvery command has `--help`; `slipfit --version` prints the version.\n",
        &cli::reference::commands(),
        "\n## Exit codes\n\n",
        &cli::reference::exit_codes(),
    ]
    .concat()
}

#[test]
fn the_guide_has_the_reference_of_this_code() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("guide/src/reference.md");
    let page = page();
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    let other = written.lines().zip(page.lines()).find(|(written, own)| written != own);
    assert!(written == page, "the reference is not this code's: {other:?}; INSTA_UPDATE=always writes it");
}

#[test]
fn every_function_has_a_meaning_and_no_other() {
    assert_eq!(MEANINGS.map(|(name, _)| name).join(", "), FUNCTIONS);
}
