//! Row kernels: what one cell becomes, declared with the rows it reads, updates and writes.
//!
//! The compiler turns each into vector code three times (baseline, AVX2, AVX-512) and the fitting one is
//! chosen at run time. Results do not depend on the choice: every operation is a correctly rounded IEEE one,
//! and none is fused.

/// Declares a row kernel as a struct of equally long rows and constants with a method `run`.
///
/// `reads` are inputs, `updates` are changed in place, `writes` are overwritten, `constants` are the same
/// for the whole row. The body sees one cell: it may assign to updates and must assign to writes.
/// Rows are separate arguments of the inner loop, never fields, so that the compiler knows them apart.
#[macro_export]
macro_rules! kernel {
    (
        $(#[$meta:meta])*
        $vis:vis struct $Kernel:ident {
            reads { $($read:ident),* $(,)? }
            updates { $($update:ident),* $(,)? }
            writes { $($write:ident),* $(,)? }
            constants { $($constant:ident: $Constant:ty),* $(,)? }
        }
        fn cell() { $($body:tt)* }
    ) => {
        $(#[$meta])*
        #[allow(clippy::struct_field_names, reason = "a kernel is often named for the row it writes")]
        $vis struct $Kernel<'a> {
            $($vis $read: &'a [f32],)*
            $($vis $update: &'a mut [f32],)*
            $($vis $write: &'a mut [f32],)*
            $($vis $constant: $Constant,)*
        }

        impl $Kernel<'_> {
            /// Runs over the whole row.
            $vis fn run(self, arch: pulp::Arch) {
                arch.dispatch(self);
            }
        }

        impl pulp::NullaryFnOnce for $Kernel<'_> {
            type Output = ();

            #[inline(always)]
            fn call(self) {
                #[inline(always)]
                #[allow(clippy::too_many_arguments, clippy::needless_late_init)]
                fn cell(
                    $($read: f32,)* $(mut $update: f32,)* $($constant: $Constant,)*
                ) -> [f32; [$(stringify!($update),)* $(stringify!($write),)*].len()] {
                    $(let $write: f32;)*
                    $($body)*
                    [$($update,)* $($write,)*]
                }
                #[inline(always)]
                #[allow(clippy::too_many_arguments)]
                fn row(
                    cells: usize,
                    $($read: &[f32],)* $($update: &mut [f32],)* $($write: &mut [f32],)* $($constant: $Constant,)*
                ) {
                    $(let $read = &$read[..cells];)*
                    $(let $update = &mut $update[..cells];)*
                    $(let $write = &mut $write[..cells];)*
                    for i in 0..cells {
                        let results = cell($($read[i],)* $($update[i],)* $($constant,)*);
                        let mut results = results.into_iter();
                        $($update[i] = results.next().expect("one result an update");)*
                        $($write[i] = results.next().expect("one result a write");)*
                    }
                }
                let Self { $($read,)* $($update,)* $($write,)* $($constant,)* } = self;
                let cells = [$($update.len(),)* $($write.len(),)*][0];
                row(cells, $($read,)* $($update,)* $($write,)* $($constant,)*);
            }
        }
    };
}
