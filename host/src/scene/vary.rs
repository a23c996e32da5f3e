//! Parameters that vary over the production, beside the gaps.

use super::{
    SceneError,
    parameter::Named,
    product::{SIGMA_DEFAULT, deviation},
};
use crate::setup::Varied;

/// Reads how the `named` parameters vary.
pub(super) fn vary<P>(named: Vec<Named<P>>) -> Result<Vec<Varied<P>>, SceneError> {
    let varied = |named: Named<P>| {
        let spread = deviation(&named.field, &named.kind.deviation(), SIGMA_DEFAULT)?;
        Ok(Varied { parameter: named.parameter, deviation: spread.contributor(named.name) })
    };
    named.into_iter().map(varied).collect()
}
