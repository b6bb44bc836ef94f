//! Messages between the page and its worker: a text and arrays, whose memory is handed over.

use js_sys::{Array as List, Float32Array, Object, Reflect, Uint8Array};
use wasm_bindgen::{JsCast, JsValue};
use weald_studio::work::{Array, Parcel};

/// The message of a parcel, and what of its memory is handed over.
pub(crate) fn message_of(parcel: Parcel) -> (JsValue, List) {
    let (arrays, memory) = (List::new(), List::new());
    for array in parcel.arrays {
        let (array, buffer): (JsValue, _) = match array {
            Array::Bytes(bytes) => {
                let array = Uint8Array::from(bytes.as_slice());
                let buffer = array.buffer();
                (array.into(), buffer)
            }
            Array::Singles(singles) => {
                let array = Float32Array::from(singles.as_slice());
                let buffer = array.buffer();
                (array.into(), buffer)
            }
        };
        arrays.push(&array);
        memory.push(&buffer);
    }
    let message = Object::new();
    // An object that was just made takes every key.
    let _ = Reflect::set(&message, &"text".into(), &parcel.text.into());
    let _ = Reflect::set(&message, &"arrays".into(), &arrays);
    (message.into(), memory)
}

/// The parcel of a message.
pub(crate) fn parcel_of(text: String, arrays: &List) -> Parcel {
    let read = |array: JsValue| match array.dyn_into::<Float32Array>() {
        Ok(singles) => Array::Singles(singles.to_vec()),
        Err(array) => Array::Bytes(Uint8Array::new(&array).to_vec()),
    };
    Parcel { text, arrays: arrays.iter().map(read).collect() }
}
