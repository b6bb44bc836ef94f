//! What the linker of macOS must be told of symbols that a Python will have.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
