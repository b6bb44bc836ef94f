//! Layers as arrays of `NumPy`: lent without a copy, taken over with one.

use numpy::ndarray::{ArrayView2, ArrayViewD};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use weald::grid::Mask;
use weald::{Domain, Field, Landscape, Size};

/// Keeps a layer alive for the arrays that show it. A landscape never changes a layer that others hold: it takes another in
/// its place.
#[pyclass(frozen, module = "weald._weald")]
struct LentLayer {
    holder: Landscape,
    name: String,
}

/// A layer as an array of rows and columns that shares its memory and cannot be written to.
pub(crate) fn lent<'py>(
    py: Python<'py>,
    landscape: &Landscape,
    name: &str,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let mut holder = Landscape::new(Domain::new(landscape.domain.size, landscape.domain.cell));
    holder.share_layer(landscape, name);
    let lent = Bound::new(py, LentLayer { holder, name: name.to_owned() })?;
    let (owner, Size { columns, rows }) = (lent.get(), landscape.domain.size);
    let field = owner.holder.field(&owner.name).map_err(|error| crate::errors::exception(py, error))?;
    let view = ArrayView2::from_shape((rows, columns), field.values()).expect("a field has one value a cell");
    // SAFETY: `lent` is the base of the array and holds the layer, which is behind an `Arc` that is never written to while
    // it is shared, and `LentLayer` is frozen. So the memory neither moves nor changes as long as the array lives, and the
    // array is made read-only before anybody sees it.
    #[allow(unsafe_code, reason = "memory that Rust owns is lent to NumPy")]
    let array = unsafe { PyArray2::borrow_from_array(&view, lent.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// A field as an array that owns it, without a copy.
pub(crate) fn given(py: Python<'_>, field: Field) -> PyResult<Bound<'_, PyArray2<f32>>> {
    let Size { columns, rows } = field.size();
    PyArray1::from_vec(py, field.into_values()).reshape([rows, columns])
}

/// Which cells hold data, as a new array of flags.
pub(crate) fn flags<'py>(py: Python<'py>, domain: &Domain) -> PyResult<Bound<'py, PyArray2<bool>>> {
    let Size { columns, rows } = domain.size;
    let flags = match &domain.valid {
        Some(valid) => valid.flags().to_vec(),
        None => vec![true; rows * columns],
    };
    PyArray1::from_vec(py, flags).reshape([rows, columns])
}

/// An array that was taken over: its values with 0 where they are not finite, and the cells that are.
pub(crate) struct Taken {
    pub(crate) field: Field,
    pub(crate) finite: Option<Mask>,
}

/// Copies an array of two dimensions of any type of numbers, once.
pub(crate) fn taken(array: &Bound<'_, PyAny>) -> PyResult<Taken> {
    macro_rules! of_type {
        ($($type:ty => $convert:expr),+ $(,)?) => {
            $(if let Ok(found) = array.extract::<PyReadonlyArrayDyn<'_, $type>>() {
                return copied(array.py(), found.as_array(), $convert);
            })+
        };
    }
    of_type!(
        f32 => |value| value,
        f64 => |value| value as f32,
        i16 => f32::from,
        u16 => f32::from,
        u8 => f32::from,
        i8 => f32::from,
        bool => |value| f32::from(u8::from(value)),
        i32 => |value| value as f32,
        u32 => |value| value as f32,
        i64 => |value| value as f32,
        u64 => |value| value as f32,
    );
    let kind = array.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "a {kind} is no array of numbers; give one of NumPy, of two dimensions"
    )))
}

fn copied<T: Element + Copy>(
    py: Python<'_>,
    array: ArrayViewD<'_, T>,
    convert: impl Fn(T) -> f32,
) -> PyResult<Taken> {
    let &[rows, columns] = array.shape() else {
        let shape = array.shape();
        return Err(PyValueError::new_err(format!(
            "an array of shape {shape:?}; a layer has rows and columns"
        )));
    };
    let size = Size::new(columns, rows).map_err(|error| crate::errors::exception(py, error))?;
    let mut values: Vec<f32> = match array.as_slice() {
        Some(slice) => slice.iter().map(|&value| convert(value)).collect(),
        None => array.iter().map(|&value| convert(value)).collect(),
    };
    let mut finite = None;
    if values.iter().any(|value| !value.is_finite()) {
        finite = Mask::new(size, values.iter().map(|value| value.is_finite()).collect());
        values.iter_mut().filter(|value| !value.is_finite()).for_each(|value| *value = 0.0);
    }
    Ok(Taken { field: Field::from_values(size, values), finite })
}

/// Flags of cells from an array of rows and columns.
pub(crate) fn taken_flags(array: &Bound<'_, PyAny>, size: Size) -> PyResult<Option<Mask>> {
    let Taken { field, .. } = taken(array)?;
    if field.size() != size {
        let (given, wanted) = (field.size(), size);
        let message = format!("a mask of {given} cells for a landscape of {wanted}");
        return Err(PyValueError::new_err(message));
    }
    Ok(Mask::new(size, field.values().iter().map(|&value| value != 0.0).collect()))
}
