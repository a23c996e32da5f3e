//! Records that are read, and what is said of those that are wrong.
#![cfg(test)]

use super::{Columns, ForceConstant, Needs, Record, read};

fn text(head: &str, row: impl Fn(usize) -> String) -> String {
    (0..40).fold(format!("{head}\n"), |text, i| text + &row(i) + "\n")
}

fn record(text: &str, needs: Needs) -> Result<Record, String> {
    read("run.csv", text.as_bytes().to_vec(), &Columns::default(), needs).map_err(|error| error.to_string())
}

#[test]
fn units_become_si() {
    let text = text("time (ms),position (mm),note,force (kN)", |i| format!("{i},{},x,{}", 2 * i, i + 1));
    let record = record(&text, Needs::Motion).expect("a record");
    assert!((record.step - 1e-3).abs() < 1e-15 && record.samples == 40 && (record.duration() - 0.039).abs() < 1e-12);
    assert_eq!(record.position.expect("a position")[3], 6e-3);
    assert_eq!(record.force.expect("a force")[0], 1000.0);
}

#[test]
fn a_current_is_a_force_by_its_constant() {
    let text = text("t (s),v (mm/s),i (mA)", |i| format!("{i},{i},{}", 1000 + i));
    let named = |force_constant| Columns {
        speed: Some("v".into()),
        current: Some("i".into()),
        force_constant,
        ..Columns::default()
    };
    let with = read("r", text.clone().into(), &named(Some(ForceConstant::PerAmpere(12.0))), Needs::Motion);
    assert!((with.expect("a record").force.expect("a force")[1] - 12.012).abs() < 1e-12);
    let without = read("r", text.into(), &named(None), Needs::Motion).expect_err("no constant").to_string();
    assert!(without.starts_with("r:1:16:"), "{without}");
}

#[test]
fn errors_name_line_and_column() {
    let good = |i: usize| format!("0.{i:02},{i},1");
    let broken =
        |at: usize, bad: &str| text("t (s),position (m),force (N)", |i| if i == at { bad.into() } else { good(i) });
    for (text, message) in [
        (broken(5, "0.04,1,1"), "run.csv:7:1: the time is 0.04 s, not after the 0.04 s"),
        (broken(5, "0.03,1,1"), "run.csv:7:1: the time is 0.03 s, not after"),
        (broken(5, "nan,1,1"), "run.csv:7:1: column \"t\" has no number"),
        (broken(5, "0.05,x,1"), "run.csv:7:6: \"x\" in column \"position\" is not a number"),
        (broken(5, "0.05,1,inf"), "run.csv:7:8: \"inf\" in column \"force\" is not finite"),
        (broken(5, "0.05,1"), "run.csv:7:7: this row has 2 cells"),
        (broken(39, "0.99,1,1"), "run.csv:41:1: the record has a gap from 0.38 to 0.99 s"),
        ("t (s),position (m),force (N)\n0,1,1\n".into(), "run.csv:2:1: the record has 1 samples"),
        (text("t (s),position (kg)", |i| format!("{i},{i}")), "run.csv:1:7: column \"position\" is in \"kg\""),
        (text("t (s),position (m)", |i| format!("{i},3")), "run.csv:2:3: the position is 3 in every row"),
        (text("t (s),position (m),force (N)", |i| format!("{i},{i},0")), "run.csv:2:"),
        (text("a (s),position (m)", |i| format!("{i},{i}")), "run.csv:1:1: there is no column for the time"),
        (text("t (s),force (N)", |i| format!("{i},{i}")), "run.csv:1:1: there is no column for the position"),
    ] {
        let error = record(&text, Needs::Motion).expect_err(message);
        assert!(error.starts_with(message), "{error}");
    }
    let uneven =
        text("t (s),force (N)", |i| format!("{},{i}", i as f64 + if i > 20 { 0.4 * (i - 20) as f64 } else { 0.0 }));
    let error = record(&uneven, Needs::Force).expect_err("uneven");
    assert!(error.contains("off a grid"), "{error}");
}
