//! The committed header is what the crate's source says.

use std::{fs, path::Path};

#[test]
fn the_header_is_current() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).unwrap();
    let mut found = Vec::new();
    let sources = [
        "status",
        "layout",
        "scene",
        "predictor",
        "observer",
        "ahead",
        "table",
        "integers",
        "slots",
        "scrubber",
        "seal",
        "deadline",
        "monitor",
        "jam_watch",
        "production",
    ]
    .map(|name| root.join(format!("src/{name}.rs")));
    let mut builder = cbindgen::Builder::new().with_config(config);
    for source in sources {
        builder = builder.with_src(source);
    }
    builder.generate().unwrap().write(&mut found);
    let found = with_layout(&String::from_utf8(found).unwrap());
    let path = root.join("include/slipfit.h");
    if std::env::var_os("SLIPFIT_WRITE_HEADER").is_some() {
        fs::write(&path, &found).unwrap();
    }
    assert!(
        fs::read_to_string(&path).unwrap() == found,
        "to write it: SLIPFIT_WRITE_HEADER=1 cargo test -p slipfit-capi"
    );
}

/// The header with what the sizes of its structs come to, in the way in which the library says it.
fn with_layout(header: &str) -> String {
    let names = header.split("typedef struct ").skip(1).filter_map(|text| Some(text.split_once(" {\n")?.0));
    let mut names: Vec<_> = names.collect();
    names.sort_unstable();
    let sum = names.iter().fold("0u".to_owned(), |sum, name| format!("({sum} * 31u + sizeof({name}))"));
    let defined = format!(
        "// What the sizes of the structs come to: the second argument of slipfit_check_header.\n\
         #define SLIPFIT_LAYOUT {}\n\n",
        sum.replace(") * 31u", ")\\\n * 31u")
    );
    let (before, after) = header.rsplit_once("#ifdef __cplusplus\nextern \"C\"").expect("the functions follow");
    format!("{before}{defined}#ifdef __cplusplus\nextern \"C\"{after}")
}

#[test]
fn the_version_is_the_packages() {
    let [major, minor, patch] =
        [env!("CARGO_PKG_VERSION_MAJOR"), env!("CARGO_PKG_VERSION_MINOR"), env!("CARGO_PKG_VERSION_PATCH")]
            .map(|number| number.parse::<u32>().unwrap());
    assert_eq!(slipfit_capi::SLIPFIT_VERSION, 10_000 * major + 100 * minor + patch);
}
