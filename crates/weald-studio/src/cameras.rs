//! Cameras of a project as text: a name each, where it stands, where it looks.

use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, value};
use weald::picture::Camera;

/// Names with their cameras, as they are saved.
pub(crate) fn to_text(cameras: &[(String, Camera)]) -> String {
    let mut tables = ArrayOfTables::new();
    let list = |numbers: &[f32]| numbers.iter().map(|number| f64::from(*number)).collect::<Array>();
    for (name, camera) in cameras {
        let mut table = Table::new();
        table["name"] = value(name.as_str());
        table["eye"] = value(list(&camera.eye));
        table["forward"] = value(list(&camera.forward));
        table["half"] = value(list(&camera.half));
        tables.push(table);
    }
    let mut document = DocumentMut::new();
    document["camera"] = Item::ArrayOfTables(tables);
    document.to_string()
}

/// Reads what [`to_text`] writes.
///
/// # Errors
/// What is no camera, and where.
pub(crate) fn of_text(text: &str) -> Result<Vec<(String, Camera)>, String> {
    let document: DocumentMut = text.parse().map_err(|cause: toml_edit::TomlError| cause.to_string())?;
    let Some(tables) = document.get("camera").and_then(Item::as_array_of_tables) else {
        return Ok(Vec::new());
    };
    let camera = |(place, table): (usize, &Table)| {
        let name = table.get("name").and_then(Item::as_str).unwrap_or_default().to_owned();
        let wrong = |key: &str| {
            format!("camera {}, `{name}`: `{key}` is no list of numbers as it was saved", place + 1)
        };
        let eye = numbers(table, "eye").ok_or_else(|| wrong("eye"))?;
        let forward = numbers(table, "forward").ok_or_else(|| wrong("forward"))?;
        let half = numbers(table, "half").ok_or_else(|| wrong("half"))?;
        Ok((name, Camera::looking(eye, forward, half)))
    };
    tables.iter().enumerate().map(camera).collect()
}

fn numbers<const COUNT: usize>(table: &Table, key: &str) -> Option<[f32; COUNT]> {
    let list = table.get(key)?.as_array()?;
    let numbers: Option<Vec<f32>> =
        list.iter().map(|number| number.as_float().map(|number| number as f32)).collect();
    numbers?.try_into().ok().filter(|numbers: &[f32; COUNT]| numbers.iter().all(|number| number.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_come_back_as_they_were_saved_and_others_are_refused() {
        let camera = Camera::looking([10.5, -20.25, 1e6], [0.6, 0.0, -0.8], [0.4, 0.3]);
        let kept =
            vec![("from \"above\"".to_owned(), camera), ("río".to_owned(), camera.at([1.0, 2.0, 3.0]))];
        let back = of_text(&to_text(&kept)).expect("read");
        assert_eq!(back.len(), 2);
        for ((name, camera), (other, back)) in kept.iter().zip(&back) {
            assert_eq!((name, camera.eye, camera.half), (other, back.eye, back.half));
            assert!(camera.forward.iter().zip(back.forward).all(|(one, other)| (one - other).abs() < 1e-6));
        }
        assert!(of_text("").expect("none").is_empty());
        let error = of_text("[[camera]]\nname = \"x\"\neye = [1.0, nan, 2.0]\n").expect_err("no place");
        assert!(error.contains("camera 1, `x`: `eye`"), "{error}");
        assert!(of_text("[[camera").is_err());
    }
}
