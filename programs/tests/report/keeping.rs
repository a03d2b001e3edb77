//! Results kept between reports, and their names.

use asvgf_programs::report::hash::Hash;
use asvgf_programs::report::record::{Row, Run};

#[test]
fn a_hash_tells_what_decides_it() {
    let shaders = Hash::of(&["shaders"]).unwrap();
    assert_eq!(shaders.to_string(), Hash::of(&["shaders"]).unwrap().to_string());
    assert_ne!(shaders.to_string(), Hash::of(&["shaders/shared"]).unwrap().to_string());
    assert!(Hash::of(&["nothing"]).is_err());
    let hash = |things: &[u32]| things.iter().fold(shaders, |hash, thing| hash.and(thing)).to_string();
    assert_eq!(hash(&[1, 2]), hash(&[1, 2]));
    assert_ne!(hash(&[1, 2]), hash(&[2, 1]));
    assert_ne!(hash(&[1, 2]), hash(&[12]));
    assert_eq!(hash(&[]).len(), 16);
}

#[test]
fn a_run_is_taken_up_again_only_if_nothing_changed() {
    let path = std::env::temp_dir().join(format!("asvgf-report-{}.json", std::process::id()));
    let row = Row { method: "any".into(), frame: 7, ssim: Some(0.5), ..Row::default() };
    let times = vec![vec![("trace".into(), 1.5)]];
    let run = Run { key: "a".into(), rows: vec![row], lag: Vec::new(), repeats: 3, times };
    run.save(&path).unwrap();
    let kept = Run::load(&path, "a").unwrap();
    assert_eq!((kept.rows[0].frame, kept.rows[0].ssim, kept.rows[0].flip, kept.repeats), (7, Some(0.5), None, 3));
    assert_eq!(kept.times, run.times);
    assert!(Run::load(&path, "b").is_none());
    std::fs::write(&path, "{ half").unwrap();
    assert!(Run::load(&path, "a").is_none());
    std::fs::remove_file(&path).unwrap();
    assert!(Run::load(&path, "a").is_none());
}
