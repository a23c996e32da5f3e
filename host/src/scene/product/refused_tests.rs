//! Every kind of bad input, with its place and what is allowed.

use super::tests::{check_all, parse};

/// A stack to spoil.
const STACK: &str = r#"
[tolerance]
general = "mK"
[[dimension]]
name = "a"
value = 10
tolerance = 0.1
[[dimension]]
name = "b"
value = 20
distribution = { kind = "triangular", mode = 0.1 }
[[dimension]]
name = "phi"
value = "30°"
side = 20
[[correlation]]
of = ["a", "b"]
coefficient = 0.5
[[measure]]
name = "m"
is = "a + 'b' / 2"
lower = 10
upper = 30
[[sum]]
name = "s"
of = ["m"]
"#;

#[test]
fn the_stack_to_spoil_is_sound() {
    let file = parse(STACK, &[]).unwrap();
    assert!(file.product.unwrap().warnings[0].contains("withdrawn"));
}

#[test]
fn bad_input_is_shown_with_its_place_and_what_is_allowed() {
    let cases = [
        ("\"mK\"", "\"xK\"", ["general = |\"xK\"", "is \"xK\"", "f, m, c, v"]),
        ("general = \"mK\"", "rule = \"sigma\"", ["rule = |\"sigma", "is \"sigma\"", "sigma-zone, truncated"]),
        ("general = \"mK\"", "sigma = 0", ["sigma = |0", "`tolerance.sigma` is 0", "1 to 100"]),
        ("general = \"mK\"", "sigma = 3", ["|[[dimension]]\nname = \"b\"", "`dimension.tolerance` is missing", "±"]),
        ("general", "generl", ["|generl", "did you mean `tolerance.general`", "general, rule, sigma"]),
        ("value = 10", "value = true", ["value = |true", "is a boolean", "a number in mm"]),
        ("value = 10", "value = inf", ["value = |inf", "not finite", "mm"]),
        ("value = 10", "value = \"10 lb\"", ["value = |\"10 lb", "unit does not fit", "mm, m"]),
        (
            "value = 20",
            "value = 0.2",
            ["value = |0.2", "class m has no tolerance of a size for 0.2 mm", "from 0.5 up to 4000"],
        ),
        ("value = 20", "value = 4001", ["value = |4001", "for 4001 mm", "from 0.5 up to 4000 mm"]),
        (
            "tolerance = 0.1",
            "tolerance = 0.1\nsigma = 0.3",
            ["sigma = |0.3", "`dimension.sigma` is 0.3", "not the standard deviation itself"],
        ),
        ("tolerance = 0.1", "tolerance = 0", ["tolerance = |0", "`dimension.tolerance` is 0 mm", "\"constant\""]),
        ("tolerance = 0.1", "tolerance = [0.3, -0.1]", ["tolerance = |[0.3", "lower limit is above", "[-0.1, 0.3]"]),
        ("tolerance = 0.1", "tolerance = \"K9\"", ["tolerance = |\"K9", "no class K9 for 10 mm", "H7 or g6"]),
        (
            "value = 10\ntolerance = 0.1",
            "value = 501\ntolerance = \"H7\"",
            ["value = |501", "up to 500 mm, not 501", "H7"],
        ),
        ("tolerance = 0.1", "tolerance = -0.1", ["tolerance = |-0.1", "is -0.1 mm", "more than 0"]),
        ("tolerance = 0.1", "tolerance = [0.1, 0.1]", ["tolerance = |[0.1", "no width", "below the upper one"]),
        (
            "tolerance = 0.1",
            "tolerance = \"x\"",
            ["tolerance = |\"x", "is \"x\"", "ISO 286 class with its size: H7, g6"],
        ),
        ("tolerance = 0.1", "tolerance = 1e-18", ["tolerance = |1e-18", "no width", "±"]),
        ("side = 20", "", ["|[[dimension]]\nname = \"phi", "`dimension.side` is missing", "shorter side"]),
        ("mode = 0.1", "mode = 0.3", ["distribution = |{ kind", "the mode is not within", "±"]),
        ("\"triangular\"", "\"bell\"", ["kind = |\"bell", "is \"bell\"", "normal, truncated-normal"]),
        ("\"triangular\"", "\"table\"", ["|{ kind", "`dimension.distribution.deviations` is missing", "two or more"]),
        ("name = \"phi\"", "name = \"a\"", ["name = |\"a\"\nvalue = \"30", "is \"a\" again", "a name of its own"]),
        ("name = \"phi\"", "name = \"it's\"", ["name = |\"it's", "`dimension.name`", "without single quotes"]),
        ("[\"a\", \"b\"]", "[\"a\", \"c\"]", ["[\"a\", |\"c\"]", "no contributor of one variable `c`", "a, b, phi"]),
        ("[\"a\", \"b\"]", "[\"a\"]", ["of = |[\"a\"]\ncoef", "is a list of 1", "two contributors"]),
        ("[\"a\", \"b\"]", "[\"a\", \"a\"]", ["of = |[\"a\", \"a\"]", "is \"a\" again", "every pair once"]),
        ("coefficient = 0.5", "coefficient = 1", ["coefficient = |1", "is 1", "between -0.9"]),
        ("coefficient = 0.5", "coefficient = 1.1", ["coefficient = |1.1", "is 1.1", "-1 to 1"]),
        ("a + 'b'", "a + 'c'", ["a + |'c' / 2", "no measure above called `c`", "a dimension"]),
        ("a + 'b'", "a + + +", ["a + + + |/", "found `/`", "such as"]),
        ("a + 'b'", "a + phi", ["a |+ phi", "cannot add a length and an angle", "one kind"]),
        ("'b' / 2", "'b' / 0", ["'b' |/ 0", "divides by zero", "finite at the nominal"]),
        ("a + 'b' / 2", "m", ["is = \"|m", "no measure above called `m`", "stands above"]),
        ("upper = 30", "upper = 10", ["upper = |10", "which is not above the lower limit, 10 mm", "above the lower"]),
        ("upper = 30", "upper = \"3°\"", ["upper = |\"3°", "unit does not fit", "mm"]),
        ("[\"m\"]", "[\"n\"]", ["of = [|\"n\"]", "there is no measure `n`", "m"]),
        ("[\"m\"]", "[]", ["of = |[]", "is a list of 0", "a list of measures"]),
        ("is = \"a", "it = \"a", ["|it = ", "unknown key `measure.it`", "name, is"]),
    ];
    check_all(STACK, &cases);
}
