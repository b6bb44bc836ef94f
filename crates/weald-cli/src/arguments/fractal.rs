//! What `weald fractal` is given: files, and keys that the library declares.

use std::path::PathBuf;

use clap::{ArgMatches, Args, FromArgMatches, value_parser};
use weald::export::Points;
use weald::grow::ifs::Wind;
use weald::grow::ifs::deform::DeformKeys;
use weald::picture::GrowthKeys;
use weald::picture::fractal::Look;
use weald::recipe::FilmKeys;
use weald::recipe::parameter::Parameters;

use crate::declared::Declared;

#[derive(Debug)]
pub(crate) struct FractalArguments {
    pub(crate) name: String,
    pub(crate) output: Option<PathBuf>,
    pub(crate) points: Option<PathBuf>,
    pub(crate) threads: Option<u16>,
    pub(crate) quiet: bool,
    /// Keys and values of the deformation, of the picture, and of the points.
    pub(crate) deform: Vec<(String, String)>,
    pub(crate) picture: Vec<(String, String)>,
    pub(crate) export: Vec<(String, String)>,
}

/// What of [`FractalArguments`] is not declared by the library.
#[derive(Debug, Args)]
struct FractalFiles {
    /// A built-in fractal, a .flame file, or a recipe whose first [[fractal]] is drawn; `list` names the built-in ones
    name: String,
    /// .png, .svg, or with --frames numbered .png, .apng, or .png and an .mp4 or .webm [default: NAME.png]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the points: .csv, .ply or .npy
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// Threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print errors only
    #[arg(long)]
    quiet: bool,
}

const LOOK: Declared = Declared {
    parameters: Look::parameters,
    heading: "Picture",
    within: None,
    renamed: &[],
    said: &[],
    without: &[],
};

const GROWTH: Declared =
    Declared { parameters: GrowthKeys::parameters, without: &["fractal", "wind"], ..LOOK };

const FILM: Declared = Declared {
    parameters: FilmKeys::parameters,
    heading: "Film",
    said: &[
        ("frames", "Number of frames: of one turn of the camera, or with --wind of one loop"),
        ("frames_per_second", "Frame rate [default: 24]"),
    ],
    without: &["every"],
    ..LOOK
};

const WIND: Declared = Declared {
    parameters: Wind::parameters,
    heading: "Wind",
    within: Some("wind"),
    renamed: &[("speed", "wind")],
    said: &[(
        "speed",
        "Speed of the wind: 4 moves leaves, 10 sways the plant, 25 bends it down. Without it the air is still, or, where \
         another option of the wind is given, moves at 4 m/s",
    )],
    without: &[],
};

const DEFORM: Declared = Declared {
    parameters: DeformKeys::parameters,
    heading: "Deformation",
    renamed: &[("by", "deform")],
    ..LOOK
};

const POINTS: Declared = Declared {
    parameters: Points::parameters,
    heading: "Points",
    without: &["fractal", "depth", "seed"],
    ..LOOK
};

const FRACTAL: [Declared; 6] = [LOOK, GROWTH, FILM, WIND, DEFORM, POINTS];

impl Args for FractalArguments {
    fn augment_args(command: clap::Command) -> clap::Command {
        FRACTAL.iter().fold(FractalFiles::augment_args(command), |command, declared| declared.add_to(command))
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FractalArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let FractalFiles { name, output, points, threads, quiet } = FractalFiles::from_arg_matches(matches)?;
        let picture =
            [LOOK, GROWTH, FILM, WIND].iter().flat_map(|declared| declared.given(matches)).collect();
        let (deform, export) = (DEFORM.given(matches), POINTS.given(matches));
        Ok(Self { name, output, points, threads, quiet, deform, picture, export })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
