//! The deadline of an interrupt.

use slipfit_capi::*;

use super::common::zeroed;

#[test]
fn periods_missed_and_the_longest_call() {
    let (mut c, mut timing) = (zeroed::<slipfit_deadline>(), zeroed::<slipfit_timing>());
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        assert_eq!(slipfit_deadline_begin(&mut c, 0), SLIPFIT_NOT_MADE);
        for period in [0, 1, 1 << 30] {
            assert_eq!(slipfit_deadline_init(&mut c, period), SLIPFIT_PARAMETER, "{period}");
            assert_eq!(slipfit_deadline_end(&mut c, 0), SLIPFIT_NOT_MADE);
        }
        assert_eq!(slipfit_deadline_init(&mut c, 1000), SLIPFIT_OK);
        // The counter wraps around after the second call; the period of the fourth is missed.
        for (late, took) in [(0u32, 10u32), (1100, 20), (1900, 1200), (4000, 30)] {
            let now = 0xffff_fa00u32.wrapping_add(late);
            assert_eq!(slipfit_deadline_begin(&mut c, now), SLIPFIT_OK);
            assert_eq!(slipfit_deadline_end(&mut c, now.wrapping_add(took)), SLIPFIT_OK);
        }
        assert_eq!(slipfit_deadline_read(&c, &mut timing), SLIPFIT_OK);
        assert_eq!(timing, slipfit_timing { calls: 4, missed: 1, longest: 1200, overruns: 1 });
    }
}
