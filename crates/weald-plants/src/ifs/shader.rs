//! A compute shader as data.

/// A compute shader: uniforms are bound first, then storage buffers, in the order of these lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shader {
    /// Its entry point.
    pub name: &'static str,
    /// Its text, in parts that follow each other.
    pub text: &'static [&'static str],
    /// Invocations of a workgroup.
    pub group: u32,
    /// Names of its uniforms.
    pub uniforms: &'static [&'static str],
    /// Names of its storage buffers, and whether it writes them.
    pub buffers: &'static [(&'static str, bool)],
}

impl Shader {
    /// The whole text.
    pub fn source(&self) -> String {
        self.text.concat()
    }
}
