//! Structs of 32-bit numbers that a shader sees under the same names.

/// A struct that shaders read as a uniform: same name, same fields in the same order, four bytes each.
pub trait Uniform {
    /// Name of the struct.
    const NAME: &'static str;

    /// Names of the fields and their types in WGSL, in order.
    fn fields() -> Vec<(&'static str, &'static str)>;

    /// The fields' bits, in order.
    fn words(&self) -> Vec<u32>;
}

/// Nothing to tell.
impl Uniform for () {
    const NAME: &'static str = "";

    fn fields() -> Vec<(&'static str, &'static str)> {
        Vec::new()
    }

    fn words(&self) -> Vec<u32> {
        Vec::new()
    }
}

/// A number of four bytes.
pub trait Word: Copy {
    /// Its type in WGSL.
    const WGSL: &'static str;

    /// Its bits.
    fn word(self) -> u32;
}

impl Word for f32 {
    const WGSL: &'static str = "f32";

    fn word(self) -> u32 {
        self.to_bits()
    }
}

impl Word for u32 {
    const WGSL: &'static str = "u32";

    fn word(self) -> u32 {
        self
    }
}

/// Declares a struct that implements [`Uniform`]; its WGSL twin stands in the shader that reads it.
macro_rules! uniform {
    ($(#[$meta:meta])* $vis:vis struct $Struct:ident {
        $( $(#[$field_meta:meta])* $field_vis:vis $field:ident: $Type:ty, )*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $vis struct $Struct { $( $(#[$field_meta])* $field_vis $field: $Type, )* }

        impl $crate::engine::uniform::Uniform for $Struct {
            const NAME: &'static str = stringify!($Struct);

            fn fields() -> Vec<(&'static str, &'static str)> {
                vec![$( (stringify!($field), <$Type as $crate::engine::uniform::Word>::WGSL) ),*]
            }

            fn words(&self) -> Vec<u32> {
                vec![$( $crate::engine::uniform::Word::word(self.$field) ),*]
            }
        }
    };
}

pub(crate) use uniform;
