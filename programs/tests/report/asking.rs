//! The command line.

use asvgf_programs::report::command::{Command, Request, parse};
use asvgf_programs::report::script::Script;

fn command(line: &str) -> Result<Command, String> {
    match parse(line.split_whitespace().map(Into::into)) {
        Ok(Request::Report(command)) => Ok(command),
        Ok(Request::Help) => Err("help".into()),
        Err(usage) => Err(usage.to_string()),
    }
}

#[test]
fn nothing_said_is_the_quick_suite() {
    let command = command("").unwrap();
    assert_eq!((command.suite.name, command.suite.size, command.budget), ("quick", [96, 54], None));
    assert_eq!(command.suite.sequences.len(), 3);
    assert!(command.baselines.is_empty() && !command.export && !command.growth);
}

#[test]
fn everything_said() {
    let line = "--size 64x48 --paths 99 --suite full --scene pillars --budget 5 --out there --baseline a=b/c \
                --baseline d=e --sequences --growth --repeats 0";
    let command = command(line).unwrap();
    assert_eq!((command.suite.name, command.suite.size, command.budget), ("full", [64, 48], Some(5.0)));
    assert_eq!(command.suite.paths, 99);
    let names: Vec<_> = command.suite.sequences.iter().map(|sequence| sequence.name.as_str()).collect();
    assert_eq!(names.len(), 6);
    assert!(names.iter().all(|name| name.starts_with("pillars-")));
    assert_eq!(command.out.to_str(), Some("there"));
    let baselines: Vec<_> = command.baselines.iter().map(|b| (b.name.as_str(), b.folder.to_str())).collect();
    assert_eq!(baselines, [("a", Some("b/c")), ("d", Some("e"))]);
    assert!(command.export && command.growth);
    assert_eq!(command.suite.repeats, 0);
}

#[test]
fn a_choice_of_animations_and_methods() {
    let line = ["--animations", "blink, static", "--methods", "a-svgf,1 spp"].map(Into::into);
    let Ok(Request::Report(Command { suite, .. })) = parse(line) else { panic!("it was understood") };
    let names: Vec<_> = suite.sequences.iter().map(|sequence| sequence.name.as_str()).collect();
    assert_eq!(names, ["cornell-static", "cornell-blink"]);
    let names: Vec<_> = suite.methods.iter().map(|method| method.name.as_str()).collect();
    assert_eq!(names, ["a-svgf", "1 spp"]);
    let unknown = command("--animations jump").err().unwrap();
    assert_eq!(unknown, "--animations jump: must be of static, blink, move-light");
    assert!(command("--methods best").err().unwrap().starts_with("--methods best: must be of "));
}

#[test]
fn a_file_is_one_sequence() {
    let command = command("--scene some/Helmet.gltf").unwrap();
    assert_eq!(command.suite.sequences.len(), 1);
    assert_eq!(command.suite.sequences[0].name, "Helmet");
}

#[test]
fn the_full_suite_has_all_scenes_that_come_along() {
    let command = command("--suite full").unwrap();
    let of = |scene: &str| command.suite.sequences.iter().filter(|s| s.name.starts_with(scene)).count();
    assert_eq!(["cornell-", "pillars-", "gloss-", "textured-", "still-life-"].map(of), [6, 6, 7, 2, 4]);
    // The animations of a file are looked up in it.
    let files =
        command.suite.sequences.iter().filter(|s| ["textured-", "still-life-"].iter().any(|f| s.name.starts_with(f)));
    for sequence in files {
        let script = Script::load(&command.suite, sequence).unwrap();
        let [first, last] = [command.suite.first(), command.suite.first() + command.suite.frames - 1];
        let moves = script.frame(first) != script.frame(last);
        assert_eq!(moves, !sequence.name.ends_with("-static"), "{}", sequence.name);
    }
}

#[test]
fn what_is_wrong_is_named() {
    for (line, part) in [
        ("--suite slow", "must be one of quick, full"),
        ("--size 10x10", "must be WIDTHxHEIGHT"),
        ("--budget 0", "--budget 0"),
        ("--baseline nameless", "must be NAME=DIR"),
        ("--baseline =dir", "must be NAME=DIR"),
        ("--other", "--other"),
        ("stray", "stray"),
        ("--help", "help"),
    ] {
        let error = command(line).err().unwrap();
        assert!(error.contains(part), "{line}: {error}");
    }
}
