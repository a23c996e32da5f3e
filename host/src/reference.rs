//! The guide's reference, written from the code: a test fails where the page is another. `INSTA_UPDATE=always` writes it.

use slipfit_tolerance::product::expression::FUNCTIONS;

use crate::{cli, scene};

const INTRODUCTION: &str = "# Reference

This page is for looking up: every key of a scene, the units, distributions and functions, every command with its options, and the
exit codes. It is generated from the program's own tables. The [tutorial](tutorial.md) shows how to write a scene, and the
[glossary](glossary.md) explains the words.

## Keys

A scene is a TOML file. It describes a product, something that moves, or both:

- A *product* has `[[dimension]]` or `[[part]]`, and `[[measure]]`.
- A *slide* on pins has `[slide]`, `[contact]`, `[friction]`, `[drive]`, `[run]`, `[sweep]` and `[[pin]]`.
- A *mechanism* has `[mechanism]`, `[[body]]`, `[[joint]]` and `[run]`.

Gaps of a slide or of a mechanism may be measures of the product in the same file. Keys are written like this:

```toml
title = \"Drawer\"

[slide]                       # a table
mass = 90                     # a bare number is in the first unit that the column \"takes\" names: g
inertia_box = [\"13 cm\", 12, 150]   # a text states its own unit; bare numbers in mm

[[pin]]                       # a table of a list, one for each pin
name = \"left front\"
left = [0.01, 0.05]
```

On the command line `--set KEY=VALUE` sets a key: `--set \"slide.mass=0.09 kg\"`. The tables of a list are told apart by their names:
`--set \"pin.left front.left=[0.01, 0.05]\"`.

A text has no tabs and no other control characters. Only the expression of a measure may go over several lines.

A key is required in its table unless its meaning names a default, calls it optional, or says for what it is required.

The column *takes* quotes the program's error message about a wrong value. Some keys take a length in one scene, and an angle, a force
or a plain number in another. There the message is that for a length; a number without a unit is in the first [unit](#units) of the
quantity. Where a mechanism moves in a plane, lists of 3 are lists of 2.
";

/// The fields that the guide's page on JSON has under a `heading`.
pub fn json_fields(heading: &str) -> Vec<String> {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/guide/src/json.md")).unwrap();
    let section = page.split("\n## ").flat_map(|section| section.split("\n### "));
    let rows = section.filter(|section| section.lines().next() == Some(heading)).flat_map(str::lines);
    rows.filter_map(|row| row.strip_prefix("| ")?.split(" |").next().map(str::to_owned)).skip(1).collect()
}

/// Functions of expressions and what they are.
const MEANINGS: [(&str, &str); 10] = [
    ("sqrt", "square root"),
    ("sin", "sine of an angle"),
    ("cos", "cosine of an angle"),
    ("tan", "tangent of an angle"),
    ("asin", "angle whose sine is the argument"),
    ("acos", "angle whose cosine is the argument"),
    ("atan", "angle whose tangent is the argument"),
    ("abs", "absolute value"),
    ("min", "smallest of the arguments"),
    ("max", "greatest of the arguments"),
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
        "\n## Units\n\nUnits can also be typed in plain letters, such as `um` for `µm`, `N*s/mm` or `Ns/mm` for `N·s/mm`, `m/s^2` for `m/s²`, \
         `deg` for `°`. The stiffness of a contact is in N/mm^e or N/m^e, where e is the contact's exponent.\n\n",
        &scene::reference::units(),
        "\n## Distributions\n\nThe `distribution` of a dimension, a size or a deviation. [Dimensions](dimensions.md) has the formulas.\n\n",
        &scene::reference::distributions(),
        "\n## Expressions\n\nThe `is` of a measure is an expression. It can have `+ - * / ^`, parentheses, numbers with units, `pi`, and names: of \
         dimensions, of diameters (`PART.AXIS.diameter`), and of measures further up in the file. A name with blanks stands in \
         single quotes.\n\n",
        &functions(),
        "\n## Commands\n\n`slipfit COMMAND -h` prints a summary of a command, `--help` all of this, and `slipfit --version` the version. Results go \
         to standard output, warnings, errors and progress to standard error. Output files that exist are replaced. What `--json` prints is described under \
         [JSON](json.md).\n",
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
