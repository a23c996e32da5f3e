//! No panic is reachable from making and stepping a kernel, from predicting ahead of the clock, or from opening and looking
//! up a table.

use slipfit_tests::cross::{self, TARGET, finished, printed, whole_program};

const BUILD: [&str; 6] = ["build", "--release", "-p", "slipfit-no-panic", "--target", TARGET];

#[test]
fn the_images_link_only_without_panics() {
    cross::require_target();
    let build = || {
        let mut cargo = whole_program(env!("CARGO_TARGET_TMPDIR"));
        cargo.args(BUILD);
        cargo
    };
    printed(&mut build());

    // The other way round: with one panic in reach neither links, and for this reason.
    for image in ["slipfit-no-panic", "slipfit-no-panic-ahead"] {
        let output = finished(build().args(["--features", "reachable-panic", "--bin", image]));
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && errors.contains("undefined symbol: panic_is_reachable"), "{errors}");
    }
}
