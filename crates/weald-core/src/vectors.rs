//! Kernels in the widest vectors of the machine: one source, compiled for several instruction sets, chosen at
//! run time. No operation is fused or reordered, so the bits are the same for each.

use pulp::{Arch, Simd, WithSimd};

/// Runs a kernel compiled for AVX-512, AVX2 or the base instructions, whichever the machine has.
///
/// The closure must be marked `#[inline(always)]`, and so must every function it calls in its inner loops:
/// what is not inlined is compiled for the base instructions alone.
#[inline(always)]
pub fn widest(kernel: impl FnMut()) {
    Arch::new().dispatch(Kernel(kernel));
}

/// A closure passed to `pulp` as it is goes through a shim of `FnOnce` that is never inlined; this is not.
struct Kernel<F>(F);

impl<F: FnMut()> WithSimd for Kernel<F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        (self.0)();
    }
}
