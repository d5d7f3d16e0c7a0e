//! Arguments that make no sense: one line, which keeps what clap suggests.

use crate::common::{assert_refused, run};

#[test]
fn wrong_arguments_are_told_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    for (args, words) in [
        ("rendr", &["unrecognized subcommand 'rendr'", "similar", "'render'"][..]),
        ("render a.subsurf -o b.png --sise 3", &["unexpected argument '--sise'", "'--size'"]),
        ("render a.subsurf", &["not provided", "--output <OUTPUT>"]),
        ("render a.subsurf -o b.png --size ax1", &["'ax1'", "--size <WxH>", "write for example 640x480"]),
        ("encode btf a --method nestd", &["'nestd'", "possible values: nested, factored, havran2010", "'nested'"]),
        ("simulate --material onyx --maps a=b -o a.npy", &["--material <MATERIAL>", "cannot be used with", "--maps"]),
        ("simulate -o a.npy", &["not provided", "--material <MATERIAL>"]),
        ("info a b", &["unexpected argument 'b'"]),
    ] {
        let refused = run(folder.path(), args);
        assert_refused(&refused, words);
        assert_refused(&refused, &["subsurf: ", "--help tells more"]);
        assert!(!refused.err.contains("error:") && !refused.err.contains("Usage"), "{}", refused.err);
    }
}

#[test]
fn help_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    for args in ["--help", "help encode", "encode btf --help", "--version"] {
        let told = run(folder.path(), args);
        assert_eq!((told.code, told.err.as_str()), (0, ""), "{args}");
        assert!(told.out.contains("subsurf"), "{args}: {}", told.out);
    }
    let nothing = run(folder.path(), "");
    assert!(nothing.code == 2 && nothing.err.contains("Usage: subsurf <COMMAND>"), "{}", nothing.err);
}
