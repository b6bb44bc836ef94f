//! Structs of 32-bit numbers that a shader sees under the same names.

use weald_core::material::MAX_MATERIALS;

/// A struct that shaders read as a uniform: same name, same fields in the same order without gaps.
pub trait Uniform {
    /// Name of the struct.
    const NAME: &'static str;

    /// Names of the fields and their types in WGSL, in order.
    fn fields() -> Vec<(&'static str, &'static str)>;

    /// The fields' bits, in order.
    fn words(&self) -> Vec<u32>;
}

/// A [`Uniform`] that comes back from its words, so that one process can tell it another.
pub trait FromWords: Uniform {
    /// The struct of these words, as [`Uniform::words`] gives them; words that are missing count as 0.
    fn from_words(words: &[u32]) -> Self;
}

impl FromWords for () {
    fn from_words(_: &[u32]) -> Self {}
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

/// Numbers of four bytes each.
pub trait Words: Copy {
    /// Their type in WGSL.
    const WGSL: &'static str;

    /// Their bits.
    fn words(self) -> Vec<u32>;

    /// The numbers of the first of these bits, which are taken away.
    fn from_words(words: &mut &[u32]) -> Self;
}

/// Takes so many words away; those that are missing are 0.
fn taken<const N: usize>(words: &mut &[u32]) -> [u32; N] {
    let (these, rest) = words.split_at(words.len().min(N));
    *words = rest;
    std::array::from_fn(|at| these.get(at).copied().unwrap_or_default())
}

/// Vectors of four, one after the other.
fn vectors<const N: usize>(words: &mut &[u32]) -> [[f32; 4]; N] {
    std::array::from_fn(|_| taken(words).map(f32::from_bits))
}

impl Words for f32 {
    const WGSL: &'static str = "f32";

    fn words(self) -> Vec<u32> {
        vec![self.to_bits()]
    }

    fn from_words(words: &mut &[u32]) -> Self {
        let [word] = taken(words);
        f32::from_bits(word)
    }
}

impl Words for u32 {
    const WGSL: &'static str = "u32";

    fn words(self) -> Vec<u32> {
        vec![self]
    }

    fn from_words(words: &mut &[u32]) -> Self {
        let [word] = taken(words);
        word
    }
}

/// Four numbers for each material. Uniforms begin with it, since its place is a multiple of sixteen bytes.
impl Words for [[f32; 4]; MAX_MATERIALS] {
    const WGSL: &'static str = "array<vec4<f32>, 8>";

    fn words(self) -> Vec<u32> {
        self.as_flattened().iter().map(|number| number.to_bits()).collect()
    }

    fn from_words(words: &mut &[u32]) -> Self {
        vectors(words)
    }
}

/// Vectors of four. Uniforms that hold some begin with them.
impl Words for [f32; 4] {
    const WGSL: &'static str = "vec4<f32>";

    fn words(self) -> Vec<u32> {
        self.map(f32::to_bits).to_vec()
    }

    fn from_words(words: &mut &[u32]) -> Self {
        taken(words).map(f32::from_bits)
    }
}

impl Words for [u32; 4] {
    const WGSL: &'static str = "vec4<u32>";

    fn words(self) -> Vec<u32> {
        self.to_vec()
    }

    fn from_words(words: &mut &[u32]) -> Self {
        taken(words)
    }
}

impl Words for [[f32; 4]; 6] {
    const WGSL: &'static str = "array<vec4<f32>, 6>";

    fn words(self) -> Vec<u32> {
        self.as_flattened().iter().map(|number| number.to_bits()).collect()
    }

    fn from_words(words: &mut &[u32]) -> Self {
        vectors(words)
    }
}

/// Declares a struct that implements [`Uniform`]; its WGSL twin stands in the shader that reads it.
#[macro_export]
macro_rules! uniform {
    ($(#[$meta:meta])* $vis:vis struct $Struct:ident {
        $( $(#[$field_meta:meta])* $field_vis:vis $field:ident: $Type:ty, )*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $vis struct $Struct { $( $(#[$field_meta])* $field_vis $field: $Type, )* }

        impl $crate::uniform::Uniform for $Struct {
            const NAME: &'static str = stringify!($Struct);

            fn fields() -> Vec<(&'static str, &'static str)> {
                vec![$( (stringify!($field), <$Type as $crate::uniform::Words>::WGSL) ),*]
            }

            fn words(&self) -> Vec<u32> {
                [$( $crate::uniform::Words::words(self.$field) ),*].concat()
            }
        }

        impl $crate::uniform::FromWords for $Struct {
            fn from_words(mut words: &[u32]) -> Self {
                let rest = &mut words;
                Self { $( $field: <$Type as $crate::uniform::Words>::from_words(rest), )* }
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    uniform! {
        struct Every {
            vectors: [[f32; 4]; 6],
            vector: [f32; 4],
            counts: [u32; 4],
            single: f32,
            count: u32,
        }
    }

    #[test]
    fn a_struct_comes_back_from_its_words() {
        let mut vectors = [[0.5; 4]; 6];
        vectors[5] = [1.0, -0.0, f32::MAX, 3.25];
        let every = Every { vectors, vector: [2.0; 4], counts: [1, 2, 3, u32::MAX], single: -7.5, count: 9 };
        let words = every.words();
        assert_eq!(words.len(), 34);
        assert_eq!(Every::from_words(&words), every);
    }
}
