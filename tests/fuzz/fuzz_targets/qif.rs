//! QIF files: any text is refused with a place, or read as results, and as a model that becomes a part.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipfit_qif::{model, part, results};

fuzz_target!(|text: &str| {
    if let Err(error) = results::read(text) {
        assert!(error.line >= 1 && error.column >= 1);
    }
    match model::read(text) {
        Ok(drawing) => {
            let written = part::write(&drawing, None, "a file");
            assert_eq!(written.stated.len(), drawing.tolerances.len());
        }
        Err(error) => assert!(error.line >= 1 && error.column >= 1),
    }
});
