//! Keys that do not go together, reported before anything runs.

use super::keys::{Boundary, Hydraulic};
use crate::erode::stack::deposit_of;
use weald_core::material::Material;
use weald_core::parameter::{Fault, Nested};

impl Hydraulic {
    pub(super) fn all_faults(&self) -> Vec<Fault> {
        let walled = self.region.is_some() && self.boundary == Boundary::Open;
        let fault =
            Fault::of("boundary", "`boundary` must be \"closed\" beside `region`, which has walls around it");
        walled.then_some(fault).into_iter().collect()
    }

    pub(super) fn all_faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        let Some(keys) = self.model.stava() else { return Vec::new() };
        let deposit = deposit_of(keys.deposit.as_ref(), materials).err();
        let deposit = deposit.map(|message| Fault::of("deposit", message));
        let slippage = keys.slippage.as_ref().and_then(|Nested(within)| within.fault_among(materials));
        deposit.into_iter().chain(slippage.map(|fault| fault.within("slippage"))).collect()
    }
}
