//! Whole numbers that stand for things, such as directions of flow, kinds of ground or numbers of lakes: what each means
//! and how it is drawn.

/// What one number stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Class {
    /// The number, 0 or more.
    pub number: u32,
    /// What it means.
    pub name: String,
    /// Colour in a map: red, green, blue.
    pub colour: [u8; 3],
}

/// What the values of a raster stand for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Classes {
    /// Those that have a name, each number once, the least first.
    pub named: Vec<Class>,
    /// The greatest number that the raster may hold.
    pub greatest: u32,
}

/// Type of the numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Whole {
    Byte,
    Short,
    Long,
}

impl Classes {
    /// The smallest type that holds all numbers and one more for no-data.
    pub(crate) fn whole(&self) -> Whole {
        match self.greatest {
            0..=254 => Whole::Byte,
            255..=65_534 => Whole::Short,
            _ => Whole::Long,
        }
    }
}

impl Whole {
    pub(crate) fn bits(self) -> u16 {
        match self {
            Self::Byte => 8,
            Self::Short => 16,
            Self::Long => 32,
        }
    }

    /// The number of cells without data, which no class has.
    pub(crate) fn no_data(self) -> i32 {
        match self {
            Self::Byte => 255,
            Self::Short => 65_535,
            Self::Long => -1,
        }
    }
}
