//! The axes of a chart: their ends, their ticks and how ticks are written.

use slipfit_tolerance::number::{fixed, typeset};

use crate::show::{
    chart::{Chart, Panel, PlotError, Scale},
    layout::{Ticks, extent},
};

/// An axis from `low` to `high`, places on its scale, with its ticks.
#[derive(Clone)]
pub(super) struct Axis {
    pub scale: Scale,
    pub low: f64,
    pub high: f64,
    ticks: Ticks,
}

impl Axis {
    /// From the first to the last abscissa, with room for markers; about `most_ticks` ticks.
    pub fn abscissa(chart: &Chart, most_ticks: f64) -> Result<Self, PlotError> {
        let points = || chart.panels.iter().flat_map(Panel::points);
        let (low, high) = extent(points().map(|(x, _)| chart.scale.place(x))).ok_or(PlotError::Empty)?;
        if chart.scale != Scale::Linear {
            return Ok(Self::decades(low, high));
        }
        let marked = chart.panels.iter().any(|panel| panel.markers.iter().any(|markers| !markers.points.is_empty()));
        let room = match high - low {
            0.0 => 0.5f64.max(0.05 * high.abs()),
            span if marked => 0.02 * span,
            _ => 0.0,
        };
        let (low, high) = (low - room, high + room);
        let ticks = Ticks::over(high - low, most_ticks).ok_or_else(|| PlotError::NotFinite(chart.x_label.clone()))?;
        Ok(Self { scale: chart.scale, low, high, ticks })
    }

    /// Around all values, on a linear scale around zero and with a little room, too.
    pub fn ordinate(chart: &Chart, panel: &Panel) -> Result<Self, PlotError> {
        let error = || PlotError::NotFinite(panel.y_label.clone());
        let scale = chart.scale.upwards();
        let values = panel.points().map(|(_, y)| scale.place(y));
        if chart.scale == Scale::Log {
            let (low, high) = extent(values).unwrap_or((0.0, 0.0));
            return Ok(Self::decades(low, high));
        }
        let (low, high) = extent(values.chain([0.0])).ok_or_else(error)?;
        let high = if high > low { high } else { 1.0 };
        let ticks = Ticks::over(high - low, if chart.panels.len() > 1 { 4.0 } else { 8.0 }).ok_or_else(error)?;
        let room = 0.04 * (high - low);
        Ok(Self { scale, low: if low < 0.0 { low - room } else { low }, high: high + room, ticks })
    }

    /// Whole powers of ten around the exponents `low` to `high`, at least one, each with a tick.
    fn decades(low: f64, high: f64) -> Self {
        let (low, high) = (low.floor(), high.ceil());
        let high = high.max(low + 1.0);
        Self { scale: Scale::Log, low, high, ticks: Ticks { step: ((high - low) / 12.0).ceil(), decimals: 0 } }
    }

    /// Where `value` stands between the ends, as a share.
    pub fn share(&self, value: f64) -> f64 {
        (self.scale.place(value) - self.low) / (self.high - self.low)
    }

    /// Values of the ticks.
    pub fn ticks(&self) -> Vec<f64> {
        let places = self.ticks.within(self.low, self.high);
        match self.scale {
            Scale::Linear => places,
            Scale::Log | Scale::LogAcross => places.into_iter().map(|exponent| libm::pow(10.0, exponent)).collect(),
        }
    }

    /// A tick's value as it is written.
    pub fn label(&self, value: f64) -> String {
        if self.scale != Scale::Linear {
            let exponent = libm::log10(value).round();
            let plain = (-4.0..6.0).contains(&exponent);
            return if plain { fixed(value, (-exponent).max(0.0) as usize) } else { typeset(&format!("{value:.0e}")) };
        }
        let wide = self.high.max(-self.low) >= 1e6 || self.ticks.decimals > 5;
        typeset(&if wide && value == 0.0 {
            "0".to_owned()
        } else if wide {
            format!("{value:.1e}")
        } else {
            fixed(value, self.ticks.decimals)
        })
    }
}
