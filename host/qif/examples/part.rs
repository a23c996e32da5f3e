//! Prints the part of a QIF product model: `cargo run -p slipfit-qif --example part -- MODEL.qif`.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("the path of a QIF product model")?;
    let drawing = slipfit_qif::model::read(&std::fs::read_to_string(&path)?)?;
    print!("{}", slipfit_qif::part::write(&drawing, None, &path).file());
    Ok(())
}
