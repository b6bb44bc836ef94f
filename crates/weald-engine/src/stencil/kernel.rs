//! Row kernels: what one cell becomes, declared with the rows it reads, updates and writes.
//!
//! The compiler turns each into vector code three times (baseline, AVX2, AVX-512) and the fitting one is
//! chosen at run time. Results do not depend on the choice: every operation is a correctly rounded IEEE one,
//! and none is fused.

use pulp::Arch;

/// A kernel whose rows are known by number, for a pipeline that finds them by their names.
pub trait RowKernel {
    /// Name of the kernel, for messages.
    const NAME: &'static str;
    /// Rows that it reads.
    const READS: &'static [&'static str];
    /// Rows that it changes in place.
    const UPDATES: &'static [&'static str];
    /// Rows that it overwrites.
    const WRITES: &'static [&'static str];
    /// Numbers that are the same for all cells.
    const CONSTANTS: &'static [&'static str];

    /// Runs over whole rows, in the order of the lists; `changes` are the updates and behind them the writes.
    fn run_on(arch: Arch, reads: &[&[f32]], changes: &mut [&mut [f32]], constants: &[f32]);
}

/// Declares a row kernel as a struct of equally long rows and constants with a method `run`.
///
/// `reads` are inputs, `updates` are changed in place, `writes` are overwritten, `constants` are the same
/// for the whole row; a list that is empty may be left out. The body sees one cell: it may assign to updates
/// and must assign to writes. Rows are separate arguments of the inner loop, never fields, so that the compiler
/// knows them apart.
#[macro_export]
macro_rules! kernel {
    (
        $(#[$meta:meta])*
        $vis:vis struct $Kernel:ident {
            $(reads { $($read:ident),* $(,)? })?
            $(updates { $($update:ident),* $(,)? })?
            $(writes { $($write:ident),* $(,)? })?
            $(constants { $($constant:ident: $Constant:ty),* $(,)? })?
        }
        fn cell() { $($body:tt)* }
    ) => {
        $(#[$meta])*
        #[allow(clippy::struct_field_names, reason = "a kernel is often named for the row it writes")]
        $vis struct $Kernel<'a> {
            $($(pub $read: &'a [f32],)*)?
            $($(pub $update: &'a mut [f32],)*)?
            $($(pub $write: &'a mut [f32],)*)?
            $($(pub $constant: $Constant,)*)?
        }

        impl $Kernel<'_> {
            /// Runs over the whole row.
            $vis fn run(self, arch: pulp::Arch) {
                arch.dispatch(self);
            }
        }

        impl $crate::stencil::kernel::RowKernel for $Kernel<'_> {
            const NAME: &'static str = stringify!($Kernel);
            const READS: &'static [&'static str] = &[$($(stringify!($read)),*)?];
            const UPDATES: &'static [&'static str] = &[$($(stringify!($update)),*)?];
            const WRITES: &'static [&'static str] = &[$($(stringify!($write)),*)?];
            const CONSTANTS: &'static [&'static str] = &[$($(stringify!($constant)),*)?];

            fn run_on(arch: pulp::Arch, reads: &[&[f32]], changes: &mut [&mut [f32]], constants: &[f32]) {
                let &[$($($read,)*)?] = reads else { unreachable!("as many rows as it reads") };
                let [$($($update,)*)? $($($write,)*)?] = changes else {
                    unreachable!("as many rows as it changes")
                };
                let &[$($($constant,)*)?] = constants else { unreachable!("as many numbers as it knows") };
                $Kernel { $($($read,)*)? $($($update,)*)? $($($write,)*)? $($($constant,)*)? }.run(arch);
            }
        }

        impl pulp::NullaryFnOnce for $Kernel<'_> {
            type Output = ();

            #[inline(always)]
            fn call(self) {
                #[inline(always)]
                #[allow(clippy::too_many_arguments, clippy::needless_late_init)]
                fn cell(
                    $($($read: f32,)*)? $($(mut $update: f32,)*)? $($($constant: $Constant,)*)?
                ) -> [f32; [$($(stringify!($update),)*)? $($(stringify!($write),)*)?].len()] {
                    $($(let $write: f32;)*)?
                    $($body)*
                    [$($($update,)*)? $($($write,)*)?]
                }
                #[inline(always)]
                #[allow(clippy::too_many_arguments)]
                fn row(
                    cells: usize,
                    $($($read: &[f32],)*)? $($($update: &mut [f32],)*)? $($($write: &mut [f32],)*)?
                    $($($constant: $Constant,)*)?
                ) {
                    $($(let $read = &$read[..cells];)*)?
                    $($(let $update = &mut $update[..cells];)*)?
                    $($(let $write = &mut $write[..cells];)*)?
                    for i in 0..cells {
                        let results = cell($($($read[i],)*)? $($($update[i],)*)? $($($constant,)*)?);
                        let mut results = results.into_iter();
                        $($($update[i] = results.next().expect("one result an update");)*)?
                        $($($write[i] = results.next().expect("one result a write");)*)?
                    }
                }
                let Self { $($($read,)*)? $($($update,)*)? $($($write,)*)? $($($constant,)*)? } = self;
                let cells = [$($($update.len(),)*)? $($($write.len(),)*)?][0];
                row(cells, $($($read,)*)? $($($update,)*)? $($($write,)*)? $($($constant,)*)?);
            }
        }
    };
}
