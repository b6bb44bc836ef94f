//! Fractals beside those of flam3.

mod flames;
