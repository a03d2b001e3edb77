//! The filter stays finite, unbiased and bounded for any use: cases as rows of data, each with a bound from theory or
//! from a reference. The program `stability` prints the same rows, and the long ones.

use asvgf_programs::stability::cases::{self, Case};

/// Asserts every row of a group, and names all that break their bound.
fn assert_bounds(cases: &[Case]) {
    let broken: Vec<String> = cases
        .iter()
        .filter_map(|case| {
            let found = (case.measure)();
            println!(
                "{}: {:.3e} of {:.3e}, {} inputs, worst at {}",
                case.name, found.value, case.bound, found.inputs, found.at
            );
            assert!(found.inputs > 0, "{} measured nothing", case.name);
            (found.value > case.bound).then(|| {
                format!(
                    "{}: {} is {}, above {} ({}), at {}",
                    case.name, case.quantity, found.value, case.bound, case.origin, found.at
                )
            })
        })
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

macro_rules! groups {
    ($($group:ident),+) => {
        $(#[test]
        fn $group() {
            assert_bounds(cases::$group::CASES);
        })+
    };
}

groups!(
    radiance,
    samples,
    outliers,
    dynamics,
    geometry,
    deformation,
    glass,
    gloss,
    mirrors,
    shapes,
    events,
    hostile,
    limits
);
