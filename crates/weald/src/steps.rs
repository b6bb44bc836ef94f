//! The parameters of every step of the [catalogue](crate::recipe::catalog), each under the name of its step:
//! `do = "diamond-square"` is [`DiamondSquare`].
//!
//! All have public fields and a `Default` with the defaults of a recipe.

pub use crate::recipe::load::Load;
pub use weald_land::analyse::aspect::Aspect;
pub use weald_land::analyse::curvature::Curvature;
pub use weald_land::analyse::flow_step::FlowStep as Flow;
pub use weald_land::analyse::lakes::LakesStep as Lakes;
pub use weald_land::analyse::moisture::Moisture;
pub use weald_land::analyse::network_step::Network;
pub use weald_land::analyse::occlusion::Occlusion;
pub use weald_land::analyse::rivers::RiversStep as Rivers;
pub use weald_land::analyse::select::Select;
pub use weald_land::analyse::slope::Slope;
pub use weald_land::analyse::soil::Soil;
pub use weald_land::analyse::sunlight::Sunlight;
pub use weald_land::analyse::watersheds::Watersheds;
pub use weald_land::analyse::wetness::Wetness;
pub use weald_land::combine::add::Add;
pub use weald_land::combine::blend::Blend;
pub use weald_land::combine::displace::Displace;
pub use weald_land::combine::extremes::Max;
pub use weald_land::combine::extremes::Min;
pub use weald_land::combine::layers::Layers;
pub use weald_land::combine::remap::Remap;
pub use weald_land::combine::resample::Resample;
pub use weald_land::combine::smooth::Smooth;
pub use weald_land::combine::terrace::Terrace;
pub use weald_land::combine::top_material::TopMaterial;
pub use weald_land::edit::PaintedLayer as PaintLayer;
pub use weald_land::erode::coast::Coast;
pub use weald_land::erode::dissolution_step::DissolutionStep as Dissolution;
pub use weald_land::erode::fluvial_step::Fluvial;
pub use weald_land::erode::hydraulic::Hydraulic;
pub use weald_land::erode::slippage_step::SlippageStep as Slippage;
pub use weald_land::erode::stream_power_step::StreamPower;
pub use weald_land::erode::thermal_step::Thermal;
pub use weald_land::erode::transport_step::Carry as Transport;
pub use weald_land::generate::basin::Basin;
pub use weald_land::generate::cone::Cone;
pub use weald_land::generate::constant::Constant;
pub use weald_land::generate::diamond_square::DiamondSquare;
pub use weald_land::generate::dome::Dome;
pub use weald_land::generate::fault::Fault;
pub use weald_land::generate::fbm::Fbm;
pub use weald_land::generate::plane::Plane;
pub use weald_land::generate::ridged::Ridged;
pub use weald_land::generate::volcano::Volcano;
pub use weald_land::generate::warp::Warp;
pub use weald_plants::grass_step::Grass;
pub use weald_plants::scatter::Scatter;

#[cfg(test)]
mod tests {
    use crate::recipe::catalog::CATALOG;

    /// The name of the type of a step in this module.
    fn camel(name: &str) -> String {
        let word = |word: &str| word[..1].to_uppercase() + &word[1..];
        name.split('-').map(word).collect()
    }

    #[test]
    fn every_step_of_the_catalogue_is_here_under_its_name() {
        let source = include_str!("steps.rs");
        for entry in CATALOG {
            let name = camel(entry.name);
            let found = source.lines().any(|line| {
                line.starts_with("pub use ")
                    && (line.ends_with(&format!("::{name};")) || line.ends_with(&format!(" as {name};")))
            });
            assert!(found, "`{}` is not in `steps` as `{name}`", entry.name);
        }
        let count = source.lines().filter(|line| line.starts_with("pub use ")).count();
        assert_eq!(count, CATALOG.len(), "nothing but steps");
    }
}
