//! Declares a struct of settings: each field in one block, with its documentation, values and range.

/// A field is its documentation, its name and type, and a block of
///
/// | key | meaning | given for |
/// |---|---|---|
/// | `default` | the value of `Default` | all |
/// | `classic` | the value of the published method, if it differs | any |
/// | `range` | the accepted numbers | every `f32`; a `u32` without it accepts all |
/// | `unit` | a word for errors | numbers |
/// | `most` | the name of a constant for the end of the range | numbers |
/// | `useful` | the part of the range that is worth a slider, if not all of it | numbers |
/// | `scale` | `logarithmic`, if numbers compare by their ratio | `f32` |
/// | `compiles` | `Always`, or `Sometimes`; the documentation then says when | any |
///
/// in this order. Types other than `f32`, `u32` and `bool` are enums that `listed!` declares.
///
/// The macro makes the struct with its rustdoc, `Default`, the values of `Settings::classic`, and `FIELDS`, the list of
/// [`Setting`]s that `Settings::check` and tools go through.
///
/// [`Setting`]: super::Setting
macro_rules! settings {
    (
        $(#[$about:meta])*
        pub struct $struct:ident in $part:ident {
            $(
                $(#[doc = $words:literal])+
                $field:ident: $type:ident {
                    default: $default:expr
                    $(, classic: $classic:expr)?
                    $(, range: $low:literal..=$high:literal)?
                    $(, unit: $unit:literal)?
                    $(, most: $most:ident)?
                    $(, useful: $from:literal..=$to:literal)?
                    $(, scale: $scale:ident)?
                    $(, compiles: $compiles:ident)?
                    $(,)?
                }
            )+
        }
    ) => {
        $(settings!(@most [$($most)?] $struct $field $type [$($high)?]);)+

        $(#[$about])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $struct {
            $(
                $(#[doc = $words])+
                #[doc = concat!(
                    "\n\nDefault `", stringify!($default), "`",
                    $(", classic `", stringify!($classic), "`",)?
                    $(", range ", stringify!($low), "…", stringify!($high),)?
                    $(" ", $unit,)?
                    ".",
                    $(settings!(@words $compiles),)?
                )]
                pub $field: $type,
            )+
        }

        impl Default for $struct {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }

        impl $crate::settings::Published for $struct {
            fn published() -> Self {
                Self { $($field: settings!(@either [$($classic)?] [$default]),)+ }
            }
        }

        impl $struct {
            /// The fields as data, in order.
            pub const FIELDS: &'static [$crate::settings::Setting] = &[$(
                $crate::settings::Setting {
                    name: concat!(stringify!($part), ".", stringify!($field)),
                    documentation: concat!($($words, "\n"),+),
                    kind: settings!(
                        @kind $type, $part, $field, [$($low $high)?] [$($unit)?] [$($from $to)?] [$($scale)?]
                    ),
                    compiles: settings!(@compiles $($compiles)?),
                },
            )+];
        }
    };

    (@most [] $struct:ident $field:ident $type:ident $high:tt) => {};
    (@most [$most:ident] $struct:ident $field:ident $type:ident [$high:literal]) => {
        #[doc = concat!("The highest [`", stringify!($struct), "::", stringify!($field), "`].")]
        pub(crate) const $most: $type = $high as $type;
    };

    (@words Always) => { " Changing it compiles." };
    (@words Sometimes) => { "" };

    (@compiles) => { $crate::settings::Compiles::Never };
    (@compiles $compiles:ident) => { $crate::settings::Compiles::$compiles };

    (@either [] [$otherwise:expr]) => { $otherwise };
    (@either [$first:expr] [$otherwise:expr]) => { $first };

    (@range u32 []) => { 0..=u32::MAX };
    (@range $type:ident [$low:literal $high:literal]) => { $low as $type..=$high as $type };

    (@useful $type:ident [] $range:tt) => { settings!(@range $type $range) };
    (@useful $type:ident $useful:tt $range:tt) => { settings!(@range $type $useful) };

    (@accepted [] []) => { "0…4294967295" };
    (@accepted [$low:literal $high:literal] [$($unit:literal)?]) => {
        concat!(stringify!($low), "…", stringify!($high) $(, " ", $unit)?)
    };

    (@field $part:ident $field:ident) => {
        $crate::settings::Field { get: |s| &s.$part.$field, get_mut: |s| &mut s.$part.$field }
    };

    (@kind f32, $part:ident, $field:ident, $range:tt $unit:tt $useful:tt [$($scale:ident)?]) => {
        $crate::settings::SettingKind::Number {
            range: settings!(@range f32 $range),
            accepted: settings!(@accepted $range $unit),
            useful: settings!(@useful f32 $useful $range),
            logarithmic: settings!(@logarithmic $($scale)?),
            field: settings!(@field $part $field),
        }
    };
    (@kind u32, $part:ident, $field:ident, $range:tt $unit:tt $useful:tt []) => {
        $crate::settings::SettingKind::Whole {
            range: settings!(@range u32 $range),
            accepted: settings!(@accepted $range $unit),
            useful: settings!(@useful u32 $useful $range),
            field: settings!(@field $part $field),
        }
    };
    (@kind bool, $part:ident, $field:ident, [] [] [] []) => {
        $crate::settings::SettingKind::Switch { field: settings!(@field $part $field) }
    };
    (@kind $enum:ident, $part:ident, $field:ident, [] [] [] []) => {
        $crate::settings::SettingKind::Choice {
            choices: || {
                let choice = |&variant: &$enum| {
                    $crate::settings::Choice { name: variant.name(), documentation: variant.documentation() }
                };
                $enum::ALL.iter().map(choice).collect()
            },
            get: |s| s.$part.$field.name(),
            set: |s, name| $enum::named(name).map(|variant| s.$part.$field = variant).is_some(),
        }
    };

    (@logarithmic) => { false };
    (@logarithmic logarithmic) => { true };
}

pub(crate) use settings;
