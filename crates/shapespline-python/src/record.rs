// SPDX-License-Identifier: MIT OR Apache-2.0

//! Records: immutable objects of named fields, which compare and hash to the last bit, and pickle.

/// Defines classes of records; each also needs its `PickledKind`.
macro_rules! record {
    ($(
        $(#[doc = $text:literal])*
        $name:ident { $( $(#[doc = $about:literal])* $field:ident: $kind:ty, )* }
    )*) => { $(
        $(#[doc = $text])*
        #[pyclass(module = "shapespline", frozen, get_all, eq, hash, weakref)]
        #[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
        pub(crate) struct $name { $( $(#[doc = $about])* pub(crate) $field: $kind, )* }

        impl $name {
            /// What tells one record from another. NaN equals itself here.
            fn key(&self) -> String {
                format!("{self:?}")
            }
        }

        impl PartialEq for $name {
            fn eq(&self, other: &Self) -> bool {
                self.key() == other.key()
            }
        }

        impl std::hash::Hash for $name {
            fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
                self.key().hash(state);
            }
        }

        #[pymethods]
        impl $name {
            #[new]
            fn new($($field: $kind),*) -> Self {
                Self { $($field),* }
            }

            fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
                let fields = [$(
                    format!("{}={}", stringify!($field), slf.getattr(stringify!($field))?.repr()?)
                ),*];
                Ok(format!("{}({})", stringify!($name), fields.join(", ")))
            }

            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<$crate::pickle::Reduced<'py>> {
                $crate::pickle::reduce_whole(slf, $crate::pickle::PickledKind::$name)
            }
        }
    )* };
}

pub(crate) use record;
