//! Enums that can list their variants, with names and documentation.

/// Declares an enum whose variants each have a name for files and command lines:
/// ```ignore
/// listed! {
///     /// Taps of a spatial iteration.
///     #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
///     #[non_exhaustive]
///     pub enum Kernel {
///         /// All 25.
///         Full = "full",
///     }
/// }
/// ```
macro_rules! listed {
    (
        $(#[$about:meta])*
        pub enum $enum:ident {
            $($(#[doc = $words:literal])+ $variant:ident = $name:literal,)+
        }
    ) => {
        $(#[$about])*
        pub enum $enum {
            $($(#[doc = $words])+ $variant,)+
        }

        impl $enum {
            /// Every variant, in order.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name in lower case, with hyphens between words.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }

            /// The variant of that [`name`](Self::name).
            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|variant| variant.name() == name)
            }

            /// The documentation in Markdown, as rustdoc shows it.
            pub const fn documentation(self) -> &'static str {
                match self {
                    $(Self::$variant => concat!($($words, "\n"),+),)+
                }
            }
        }
    };
}

pub(crate) use listed;
