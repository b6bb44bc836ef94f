//! What `weald render` is given: files and cameras, and keys of the view that the library declares.

use std::path::PathBuf;

use clap::{ArgMatches, Args, FromArgMatches, value_parser};
use weald::picture::View;
use weald::recipe::parameter::Parameters;

use super::running::{Running, Values};
use crate::declared::Declared;
use crate::values;

#[derive(Debug)]
pub(crate) struct RenderArguments {
    pub(crate) files: RenderFiles,
    /// Keys and values of the view.
    pub(crate) view: Vec<(String, String)>,
}

/// What of [`RenderArguments`] is not declared by the library.
#[derive(Debug, Args)]
pub(crate) struct RenderFiles {
    /// The recipe; camera, light and colours start from its first `view` or `render` output
    #[arg(value_name = "RECIPE.toml")]
    pub(crate) recipe: PathBuf,
    /// .png; of several frames numbered .png, one .apng, or .png and an .mp4 or .webm of 24 frames per second [default:
    /// NAME.png]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1920x1080", value_parser = values::size)]
    pub(crate) size: [u32; 2],
    /// MSAA samples per pixel: 4, or 1 with aliased edges
    #[arg(long, value_name = "N", default_value_t = 4)]
    pub(crate) samples: u32,
    /// Where the camera stands: metres east and south of the north-western corner, and its elevation; or X,Y with
    /// --eye-height
    #[arg(long, value_name = "X,Y,Z", allow_negative_numbers = true, value_parser = values::eye)]
    pub(crate) eye: Option<values::Point>,
    /// Height of the camera above the ground at --eye X,Y, as 1.7 for a person's view
    #[arg(long, value_name = "METRES")]
    pub(crate) eye_height: Option<f64>,
    /// What the camera looks at: X,Y,Z, or X,Y on the ground [default: the middle of the landscape]
    #[arg(long, value_name = "X,Y,Z", allow_negative_numbers = true, value_parser = values::point)]
    pub(crate) target: Option<values::Point>,
    /// Frames of a whole turn around what the camera looks at
    #[arg(long, value_name = "FRAMES", value_parser = value_parser!(u32).range(2..=9999), conflicts_with_all = ["through", "eye_height", "frames"])]
    pub(crate) turntable: Option<u32>,
    /// Further points that the camera flies through after --eye; it looks ahead, or at --target
    #[arg(long, value_name = "X,Y,Z", num_args = 1.., requires_all = ["eye", "frames"], allow_negative_numbers = true, value_parser = values::point)]
    pub(crate) through: Vec<values::Point>,
    /// Frames of a flight with --through
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(2..=9999))]
    pub(crate) frames: Option<u32>,
    /// What --eye was called
    #[arg(long, hide = true, allow_negative_numbers = true, value_parser = values::camera_of_before)]
    pub(crate) camera: Option<values::Point>,
    /// What --field-of-view-deg was called
    #[arg(long, hide = true, allow_negative_numbers = true, value_parser = values::field_of_view_of_before)]
    pub(crate) fov: Option<f64>,
    /// Cells along the longer side of the landscape; shape and extent stay
    #[arg(long, value_name = "N", value_parser = value_parser!(u64).range(1..))]
    pub(crate) cells: Option<u64>,
    #[command(flatten)]
    pub(crate) values: Values,
    #[command(flatten)]
    pub(crate) running: Running,
}

/// Keys of a view; its camera and size are set otherwise.
const VIEW: Declared = Declared {
    parameters: View::parameters,
    heading: "View",
    within: None,
    renamed: &[],
    said: &[],
    without: &["width", "height", "samples", "target", "eye", "eye_height", "turn_deg"],
};

impl Args for RenderArguments {
    fn augment_args(command: clap::Command) -> clap::Command {
        VIEW.add_to(RenderFiles::augment_args(command))
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for RenderArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self { files: RenderFiles::from_arg_matches(matches)?, view: VIEW.given(matches) })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
