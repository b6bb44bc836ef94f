//! Every step there is. Adding one is one file and one line here.

use super::load;
use weald_engine::step::Entry;
use weald_land::{analyse, combine, edit, erode, generate};
use weald_plants as grow;

/// All steps, in the order of `weald steps`.
#[rustfmt::skip] // one entry a line, so that branches that add some do not meet
pub const CATALOG: &[Entry] = &[
    generate::fault::ENTRY,
    generate::diamond_square::ENTRY,
    generate::fbm::ENTRY,
    generate::ridged::ENTRY,
    generate::warp::ENTRY,
    generate::plane::ENTRY,
    generate::cone::ENTRY,
    generate::dome::ENTRY,
    generate::volcano::ENTRY,
    generate::basin::ENTRY,
    generate::constant::ENTRY,
    load::ENTRY,
    combine::add::ENTRY,
    combine::extremes::MAX,
    combine::extremes::MIN,
    combine::blend::ENTRY,
    combine::remap::ENTRY,
    combine::terrace::ENTRY,
    combine::smooth::ENTRY,
    combine::displace::ENTRY,
    combine::resample::ENTRY,
    combine::layers::ENTRY,
    combine::top_material::ENTRY,
    edit::PAINTED_LAYER,
    erode::hydraulic::ENTRY,
    erode::thermal_step::ENTRY,
    erode::transport_step::ENTRY,
    erode::fluvial_step::ENTRY,
    erode::stream_power_step::ENTRY,
    erode::coast::ENTRY,
    erode::slippage_step::ENTRY,
    erode::dissolution_step::ENTRY,
    analyse::slope::ENTRY,
    analyse::aspect::ENTRY,
    analyse::curvature::ENTRY,
    analyse::sunlight::ENTRY,
    analyse::occlusion::ENTRY,
    analyse::soil::ENTRY,
    analyse::select::ENTRY,
    analyse::network_step::ENTRY,
    analyse::flow_step::ENTRY,
    analyse::rivers::ENTRY,
    analyse::lakes::ENTRY,
    analyse::watersheds::ENTRY,
    analyse::wetness::ENTRY,
    analyse::moisture::ENTRY,
    grow::scatter::ENTRY,
    grow::grass_step::ENTRY,
];

/// The step of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    CATALOG.iter().find(|entry| entry.name == name)
}
