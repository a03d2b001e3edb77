//! The list of methods.

use asvgf::Settings;
use asvgf_programs::report::methods::{ALPHAS, CONTROL, DEFAULT, Group, ONE_PATH, all, quick};
use std::collections::HashSet;

#[test]
fn every_method_has_a_name_of_its_own_and_sound_settings() {
    let methods = all();
    let names: HashSet<_> = methods.iter().map(|method| method.name.as_str()).collect();
    assert_eq!(names.len(), methods.len());
    for method in &methods {
        method.settings.check().unwrap();
        // Names become names of files.
        assert!(method.name.chars().all(|c| c.is_ascii_alphanumeric() || " .-".contains(c)), "{}", method.name);
    }
    assert_eq!(methods[0].settings, Settings::adaptive());
}

#[test]
fn what_is_left_out_differs_from_the_default() {
    let methods = all();
    let undone = methods.iter().filter(|m| matches!(m.group, Group::Ablation | Group::Iterations | Group::Control));
    assert!(undone.into_iter().all(|method| method.settings != Settings::adaptive()));
}

#[test]
fn the_quick_suite_has_what_its_words_are_about() {
    let names: Vec<_> = quick().into_iter().map(|method| method.name).collect();
    assert_eq!(names.len(), 10 + 2 * ALPHAS.len());
    for name in [DEFAULT, ONE_PATH, CONTROL, "svgf 0.2", "svgf 0.05"] {
        assert!(names.iter().any(|known| known == name), "{name}");
    }
}
