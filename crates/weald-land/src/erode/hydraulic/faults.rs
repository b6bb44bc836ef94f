//! Keys that mean nothing together, told before anything runs.

use super::{Boundary, Hydraulic, Model, Transport, UptakeLaw, deposit_of};
use weald_core::material::Material;
use weald_core::parameter::Nested;

impl Hydraulic {
    pub(super) fn all_faults(&self) -> Vec<String> {
        let own = if self.model == Model::Stava { self.faults_of_stava() } else { self.keys_of_stava() };
        own.into_iter().chain(self.faults_of_any()).collect()
    }

    pub(super) fn all_faults_among(&self, materials: &[Material]) -> Vec<String> {
        if self.model != Model::Stava {
            return Vec::new();
        }
        let deposit = deposit_of(self.deposit.as_ref(), materials).err();
        let slippage = self.slippage.as_ref().and_then(|Nested(within)| within.fault_among(materials));
        deposit.into_iter().chain(slippage).collect()
    }

    fn faults_of_any(&self) -> Vec<String> {
        let mut faults = Vec::new();
        if self.model != Model::Han && self.law == UptakeLaw::Dissolution {
            let model = self.model.word();
            faults
                .push(format!("`law` belongs to model \"han\"; {model} always erodes towards its capacity"));
        }
        if self.model == Model::Mei && self.evaporation.is_some_and(|share| share > 1.0) {
            faults.push("`evaporation` of model \"mei\" is a share of the depth, 0 to 1".to_owned());
        }
        if self.model != Model::Stava && self.erosion.is_some_and(|share| share > 1.0) {
            let model = self.model.word();
            faults.push(format!("`erosion` of model {model:?} is a share of at most 1"));
        }
        if self.region.is_some() && self.boundary == Boundary::Open {
            let fault = "`region` has walls around it, so `boundary` must be \"closed\"";
            faults.push(fault.to_owned());
        }
        faults.extend(self.faults_of_transport());
        faults
    }

    fn faults_of_transport(&self) -> Option<String> {
        match (self.transport(), self.conserve) {
            (Transport::Upwind, Some(false)) => {
                Some("`conserve` is false, but transport = \"upwind\" always conserves sediment".to_owned())
            }
            (Transport::SemiLagrangian, Some(true)) => Some(
                "`conserve` is true, but transport = \"semi-lagrangian\" cannot conserve sediment; \
                 \"maccormack\" and \"upwind\" can"
                    .to_owned(),
            ),
            _ => None,
        }
    }

    /// What stava does not know.
    fn faults_of_stava(&self) -> Vec<String> {
        let wrong = [
            (!self.limiter, "`limiter = false` belongs to \"han\" and \"mei\"; stava always limits its flow"),
            (
                self.deposit_ratio < 1.0,
                "`deposit_ratio` belongs to \"han\" and \"mei\"; all that stava drops settles",
            ),
            (self.thermal.is_some(), "`thermal` belongs to \"han\" and \"mei\"; stava has `slippage`"),
        ];
        wrong.into_iter().filter(|(is_wrong, _)| *is_wrong).map(|(_, fault)| fault.to_owned()).collect()
    }

    /// What only stava knows.
    fn keys_of_stava(&self) -> Vec<String> {
        let given = [
            ("edits", self.edits.is_some()),
            ("rain_layer", self.rain_layer.is_some()),
            ("evaporation_layer", self.evaporation_layer.is_some()),
            ("source_layer", self.source_layer.is_some()),
            ("sources", !self.sources.is_empty()),
            ("drains", !self.drains.is_empty()),
            ("viscosity", self.viscosity > 0.0),
            ("deposit", self.deposit.is_some()),
            ("dissolution", self.dissolution.is_some()),
            ("slippage", self.slippage.is_some()),
        ];
        let given = given.into_iter().filter(|(_, given)| *given);
        given.map(|(key, _)| format!("`{key}` belongs to model \"stava\"")).collect()
    }
}
