//! Files that are written where others point to them or protect them.

use std::path::Path;

use subsurf_encoder::write_bytes;

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

#[cfg(unix)]
#[test]
fn links_stay_and_what_they_lead_to_is_written() {
    use std::os::unix::fs::symlink;

    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("elsewhere")).unwrap();
    std::fs::write(at("elsewhere/file"), "old").unwrap();
    symlink("elsewhere/file", at("link")).unwrap();
    symlink("link", at("second")).unwrap();
    symlink(at("elsewhere/new"), at("dangling")).unwrap();
    symlink("elsewhere", at("folder")).unwrap();
    symlink("round", at("round")).unwrap();
    symlink("nowhere/file", at("lost")).unwrap();
    for (link, target) in [("link", "file"), ("second", "file"), ("dangling", "new")] {
        write_bytes(&at(link), link.as_bytes()).unwrap();
        assert!(at(link).is_symlink(), "{link} stays a link");
        assert_eq!(text(&at("elsewhere").join(target)), link);
    }
    for (link, words) in [("folder", "is not a file"), ("round", "too many symbolic links"), ("lost", "no folder")] {
        let error = write_bytes(&at(link), b"new").unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn permissions_are_kept_and_heeded() {
    use std::os::unix::fs::PermissionsExt;

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    let mode = || std::fs::metadata(&path).unwrap().permissions().mode() & 0o777;
    let set = |mode| std::fs::set_permissions(&path, PermissionsExt::from_mode(mode)).unwrap();
    std::fs::write(&path, "by others").unwrap();
    let usual = mode();
    std::fs::remove_file(&path).unwrap();
    write_bytes(&path, b"new").unwrap();
    assert_eq!(mode(), usual, "a new file is as any program makes it");
    set(0o640);
    write_bytes(&path, b"newer").unwrap();
    assert_eq!((mode(), text(&path).as_str()), (0o640, "newer"));
    set(0o444);
    let error = write_bytes(&path, b"newest").unwrap_err();
    assert!(error.to_string().contains("write-protected") && error.is_callers(), "{error}");
    assert_eq!(text(&path), "newer");
}
