//! C headers: the include guard, and names that follow the file's.

use slipfit_core::table::layout::checksum;

/// The `text` of a header, which starts with a comment, behind an include guard of the `name` and a checksum of the text.
///
/// The name alone does not tell apart two headers of one name in different folders: the second would be dropped without a
/// warning. So the compiler refuses what both define.
pub(super) fn guarded(name: &str, text: &str) -> String {
    let guard = format!("{name}_{:08X}", checksum(text.as_bytes()));
    let (comment, rest) = text.split_at(text.find("*/\n").map_or(0, |end| end + 3));
    format!("{comment}#ifndef {guard}\n#define {guard}\n\n{rest}\n#endif\n")
}

/// What the names in a C header have of its file's `stem`, so that a program can include several: its letters in lower case and its
/// digits, `_` for all else.
pub(super) fn c_name(stem: &str) -> String {
    stem.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::{c_name, guarded};

    #[test]
    fn headers_that_differ_have_guards_that_differ() {
        let guard = |text: &str| guarded("A_H", text).lines().nth(1).map(str::to_owned);
        let texts = ["/* a */\nint a;\n", "/* b */\nint a;\n", "/* a */\nint b;\n"].map(guard);
        assert!(texts[0] != texts[1] && texts[0] != texts[2] && texts[1] != texts[2], "{texts:?}");
        let text = guarded("A_H", "/* a */\nint a;\n");
        assert!(text.starts_with("/* a */\n#ifndef A_H_") && text.ends_with("\n\nint a;\n\n#endif\n"), "{text}");
    }

    #[test]
    fn names_are_of_c() {
        for (stem, name) in [("scene", "scene"), ("Left-2", "left_2"), ("2nd", "2nd"), ("für b", "f_r_b")] {
            assert_eq!(c_name(stem), name);
        }
    }
}
