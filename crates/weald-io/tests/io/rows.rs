//! Rows of a file read without the others: the bits of the whole, or refused where that is.

use std::path::Path;

use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_io::{Raster, open_rows};

/// How rows differ from the whole of a file that is read by rows; nothing where they do not.
pub(crate) fn difference_of_rows(path: &Path, whole: &Result<Raster, Error>) -> Option<String> {
    let file = match (open_rows(path), whole) {
        (Ok(file), _) => file,
        (Err(_), Err(_)) => return None,
        (Err(error), Ok(_)) => {
            let said = error.to_string();
            let is_told = said.contains("is read as a whole") || said.contains("says more of it");
            return (!is_told).then_some(format!("rows are refused: {said}"));
        }
    };
    let rows = file.size().rows;
    for step in [rows, 7, 1, file.rows_at_once()] {
        for first in (0..rows).step_by(step) {
            let window = first..(first + step).min(rows);
            match (file.rows(window.clone()), whole) {
                (Ok(part), Ok(whole)) if of_whole(whole, &part, first) => {}
                (Ok(part), Ok(whole)) => {
                    return Some(format!("rows {window:?} are {part:?}, not of {whole:?}"));
                }
                (Err(error), Ok(_)) => return Some(format!("rows {window:?} are refused: {error}")),
                // What is wrong with a file may lie in other rows.
                (_, Err(_)) => {}
            }
        }
    }
    let all = file.rows(0..rows);
    (all.is_ok() != whole.is_ok()).then(|| format!("all rows: {:?}", all.err()))
}

/// Whether rows from one on are those of the whole, and all that is said of them the same.
fn of_whole(whole: &Raster, part: &Raster, first: usize) -> bool {
    let Size { columns, rows } = part.field.size();
    let cells = first * columns..(first + rows) * columns;
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    let flags =
        |raster: &Raster, cell: usize| raster.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
    let said = |raster: &Raster| Raster {
        field: Field::filled(Size { columns: 1, rows: 1 }, 0.0),
        valid: None,
        ..raster.clone()
    };
    bits(&whole.field.values()[cells.clone()]) == bits(part.field.values())
        && cells.clone().all(|cell| flags(whole, cell) == flags(part, cell - cells.start))
        && said(whole) == said(part)
}

#[test]
fn rows_of_our_own_files_and_of_the_committed_ones_are_those_of_the_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let field =
        Field::from_function(Size { columns: 301, rows: 290 }, |x, y| ((x * 7 + y * 13) % 911) as f32 / 3.0);
    let tiled = folder.path().join("tiled.tif");
    weald_io::write(&tiled, &Raster { cell: Some(12.5), ..Raster::from(field) }).expect("written");
    let committed = ["jacksboro_fault_utm16_80m.tif", "jacksboro_fault_srtm_wgs84.tif"];
    for path in committed.map(|name| root.join("data").join(name)).into_iter().chain([tiled]) {
        let whole = weald_io::read(&path);
        assert!(whole.is_ok(), "{}: {whole:?}", path.display());
        assert_eq!(difference_of_rows(&path, &whole), None, "{}", path.display());
    }
}

#[test]
fn a_file_of_a_format_that_is_read_as_a_whole_or_with_another_beside_it_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let raster = Raster { cell: Some(2.0), ..Raster::from(Field::filled(Size { columns: 9, rows: 4 }, 5.0)) };
    let [npy, tif] = ["h.npy", "h.tif"].map(|name| folder.path().join(name));
    for path in [&npy, &tif] {
        weald_io::write(path, &raster).expect("written");
    }
    let said = |path: &Path| {
        open_rows(path).map_or_else(|error| error.to_string(), |file| format!("{:?}", file.size()))
    };
    assert!(said(&npy).contains("is read as a whole, which needs it in memory"), "{}", said(&npy));
    assert_eq!(said(&tif), "Size { columns: 9, rows: 4 }");
    std::fs::write(folder.path().join("h.tfw"), "2\n0\n0\n-2\n1\n1\n").expect("written");
    assert!(
        said(&tif).contains("h.tfw says more of it") && said(&tif).contains("gdal_translate"),
        "{}",
        said(&tif)
    );
    let missing = said(&folder.path().join("none.tif"));
    assert!(missing.contains("none.tif: cannot be read"), "{missing}");
}

#[test]
fn a_file_cut_anywhere_is_refused_and_never_read_beyond_its_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("h.tif");
    let field = Field::from_function(Size { columns: 40, rows: 30 }, |x, y| (x * y) as f32);
    weald_io::write(&path, &Raster { cell: Some(2.0), ..Raster::from(field) }).expect("written");
    let bytes = std::fs::read(&path).expect("there");
    for length in (0..bytes.len()).step_by(7) {
        std::fs::write(&path, &bytes[..length]).expect("written");
        assert_eq!(difference_of_rows(&path, &weald_io::read(&path)), None, "{length} bytes");
    }
    for at in 0..bytes.len().min(600) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x81;
        std::fs::write(&path, &damaged).expect("written");
        let whole = weald_io::read(&path);
        let difference = difference_of_rows(&path, &whole);
        // A chunk may be longer than its cells, where the whole has it all.
        assert_eq!(difference, None, "byte {at}");
    }
}
