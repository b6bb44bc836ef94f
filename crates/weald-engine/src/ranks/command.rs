//! What the first rank tells the others to do.

use super::bytes::{Reader, Writer, damaged};
use crate::device::Window;
use crate::patch::Patch;
use crate::stencil::rows::{Layout, Rows};
use crate::sums::{RowSums, SUMS};
use weald_core::error::Error;

/// What all ranks do next.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Command {
    /// A simulation begins; a part of its start is dealt to each rank.
    Begin(Start),
    /// Steps are done, of which these are the words of the weather.
    Advance { recorded: bool, weather: Vec<Vec<u32>> },
    /// Each says where its first value lies that is no number.
    Check,
    /// Each keeps a copy of what it has.
    Keep,
    /// Each goes back to the copy.
    GoBack,
    /// The state is collected.
    Collect,
    /// What lies in a window is collected.
    Cut(Window),
    /// A patch is laid over the state.
    Lay(Box<Patch>),
    /// The simulation goes on by another process, and begins with it.
    Follow,
    /// Means begin anew.
    ClearMeans,
    /// The simulation ends.
    End,
}

/// What a simulation begins with, beside its state.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) layout: Layout,
    pub(super) rows: usize,
    /// The numbers of the process, in words.
    pub(super) process: String,
}

impl Command {
    fn number(&self) -> usize {
        match self {
            Self::Begin(_) => 0,
            Self::Advance { .. } => 1,
            Self::Check => 2,
            Self::Keep => 3,
            Self::GoBack => 4,
            Self::Collect => 5,
            Self::Cut(_) => 6,
            Self::Lay(_) => 7,
            Self::Follow => 8,
            Self::ClearMeans => 9,
            Self::End => 10,
        }
    }

    pub(super) fn message(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        writer.count(self.number());
        match self {
            Self::Begin(Start { layout, rows, process }) => {
                writer.counts(&[layout.columns, layout.planes, *rows]);
                writer.0.extend(process.as_bytes());
            }
            Self::Advance { recorded, weather } => {
                let words = weather.first().map_or(0, Vec::len);
                writer.counts(&[usize::from(*recorded), weather.len(), words]);
                for step in weather {
                    writer.words(step);
                }
            }
            Self::Cut(window) => write_window(&mut writer, window),
            Self::Lay(patch) => write_patch(&mut writer, patch),
            _ => {}
        }
        writer.0
    }

    pub(super) fn read(message: &[u8]) -> Result<Self, Error> {
        let mut reader = Reader(message);
        Ok(match reader.count()? {
            0 => Self::Begin(Start {
                layout: Layout { columns: reader.count()?, planes: reader.count()? },
                rows: reader.count()?,
                process: String::from_utf8(reader.0.to_vec()).map_err(|_| damaged())?,
            }),
            1 => {
                let (recorded, steps, words) = (reader.count()? == 1, reader.count()?, reader.count()?);
                let weather = (0..steps).map(|_| reader.words(words)).collect::<Result<_, _>>()?;
                Self::Advance { recorded, weather }
            }
            2 => Self::Check,
            3 => Self::Keep,
            4 => Self::GoBack,
            5 => Self::Collect,
            6 => Self::Cut(read_window(&mut reader)?),
            7 => Self::Lay(Box::new(read_patch(&mut reader)?)),
            8 => Self::Follow,
            9 => Self::ClearMeans,
            10 => Self::End,
            _ => return Err(damaged()),
        })
    }
}

fn write_window(writer: &mut Writer, window: &Window) {
    let Window { columns, rows } = window;
    writer.counts(&[columns.start, columns.end, rows.start, rows.end]);
}

fn read_window(reader: &mut Reader<'_>) -> Result<Window, Error> {
    Ok(Window { columns: reader.count()?..reader.count()?, rows: reader.count()?..reader.count()? })
}

fn write_patch(writer: &mut Writer, patch: &Patch) {
    write_window(writer, &patch.window);
    writer.count(patch.planes.len());
    writer.counts(&patch.planes);
    writer.doubles(&patch.sums);
    for y in 0..patch.window.rows.len() {
        (0..patch.planes.len()).for_each(|plane| writer.singles(patch.rows.plane(y, plane)));
    }
}

fn read_patch(reader: &mut Reader<'_>) -> Result<Patch, Error> {
    let window = read_window(reader)?;
    let count = reader.count()?;
    let planes: Vec<_> = (0..count).map(|_| reader.count()).collect::<Result<_, _>>()?;
    let mut sums: RowSums = [0.0; SUMS];
    reader.doubles(&mut sums)?;
    let layout = Layout { columns: window.columns.len(), planes: planes.len() };
    let mut rows = Rows::new(layout, window.rows.len());
    for y in 0..window.rows.len() {
        (0..planes.len()).try_for_each(|plane| reader.singles(rows.plane_mut(y, plane)))?;
    }
    Ok(Patch { window, planes, rows, sums })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_arrives_as_it_was_given() {
        let window = Window { columns: 2..5, rows: 1..3 };
        let layout = Layout { columns: 3, planes: 2 };
        let mut rows = Rows::new(layout, 2);
        rows.plane_mut(1, 1).copy_from_slice(&[1.5, -0.0, 3.0]);
        let patch =
            Patch { window: window.clone(), planes: vec![4, 0], rows, sums: [1.0, 2.0, 0.0, 4.0, 5.0] };
        let weather = vec![vec![1, u32::MAX], vec![0, 3]];
        for command in [
            Command::Begin(Start { layout, rows: 9, process: "slöpe".to_owned() }),
            Command::Advance { recorded: true, weather },
            Command::Advance { recorded: false, weather: Vec::new() },
            Command::Check,
            Command::Keep,
            Command::GoBack,
            Command::Collect,
            Command::Cut(window),
            Command::Lay(Box::new(patch)),
            Command::Follow,
            Command::ClearMeans,
            Command::End,
        ] {
            let message = command.message();
            assert_eq!(Command::read(&message).expect("it is whole"), command);
            assert!(
                message.len() == 8 || Command::read(&message[..8]).is_err(),
                "{command:?} needs the rest"
            );
        }
        assert!(Command::read(&[255; 8]).is_err());
    }
}
