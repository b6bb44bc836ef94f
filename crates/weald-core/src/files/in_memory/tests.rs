use std::io::{BufReader, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::*;

/// Tests share the one tree: each has a folder of its own.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new("/").join(name);
    create_dir_all(&folder).expect("made");
    folder
}

/// What both file systems answer to the same calls.
macro_rules! story {
    ($files:path, $folder:expr) => {{
        use $files as files;
        let folder: PathBuf = $folder;
        let kind = |cause: std::io::Error| cause.kind();
        let (one, two) = (folder.join("deep/er/one.txt"), folder.join("two.txt"));
        let mut told = Vec::new();
        told.push(format!("{:?}", files::write(&one, "no folder").map_err(kind)));
        told.push(format!("{:?}", files::create_dir_all(one.parent().expect("has one")).map_err(kind)));
        told.push(format!("{:?}", files::write(&one, "first").map_err(kind)));
        told.push(format!("{:?}", files::read_to_string(&one).map_err(kind)));
        let mut open = files::File::options().read(true).write(true).open(&one).expect("there");
        open.seek(SeekFrom::End(-2)).expect("within");
        open.write_all(b"ST and more").expect("written");
        told.push(format!("{:?}", files::read_to_string(&one).map_err(kind)));
        told.push(format!("{:?}", files::rename(&one, &two).map_err(kind)));
        open.seek(SeekFrom::Start(0)).expect("within");
        let mut text = String::new();
        open.read_to_string(&mut text).expect("goes on under another name");
        told.push(text);
        told.push(format!("{:?}", files::read(&one).map_err(kind)));
        told.push(format!("{:?}", files::rename(&one, &two).map_err(kind)));
        told.push(format!("{:?}", files::remove_dir(&folder).map_err(kind)));
        told.push(format!("{:?}", files::remove_dir(folder.join("deep/er")).map_err(kind)));
        told.push(format!("{:?}", files::File::create(folder.join("two.txt/in a file")).map_err(kind).err()));
        told.push(format!("{:?}", files::create_dir_all(folder.join("two.txt/in")).map_err(kind)));
        let mut end = files::File::options().append(true).open(&two).expect("there");
        end.write_all(b"!").expect("written");
        told.push(format!(
            "{:?}",
            files::metadata(&two).map(|about| (about.len(), about.is_file())).map_err(kind)
        ));
        let entries = files::read_dir(&folder).expect("there");
        let mut names: Vec<_> = entries.map(|entry| entry.expect("listed").file_name()).collect();
        names.sort();
        told.push(format!("{names:?}"));
        let mut written = BufWriter::new(files::File::create(&two).expect("there"));
        written.write_all(&vec![7; 100_000]).expect("written");
        written.into_inner().expect("flushed").sync_all().expect("kept");
        let mut bytes = Vec::new();
        BufReader::new(files::File::open(&two).expect("there"))
            .take(99_999)
            .read_to_end(&mut bytes)
            .expect("read");
        told.push(format!("{}", bytes.len()));
        told.push(format!("{:?}", files::rename(folder.join("deep"), folder.join("renamed")).map_err(kind)));
        told.push(format!(
            "{} {}",
            files::is_dir(&folder.join("renamed")),
            files::exists(&folder.join("deep"))
        ));
        told.push(format!("{:?}", files::remove_file(&folder.join("renamed")).map_err(kind)));
        told.push(format!("{:?}", files::remove_dir_all(&folder).map_err(kind)));
        told.push(format!("{:?}", files::remove_dir_all(&folder).map_err(kind)));
        told
    }};
}

#[test]
fn it_answers_as_the_file_system_of_the_machine() {
    let on_disk = std::env::temp_dir().join(format!("weald-files-{}", std::process::id()));
    std::fs::create_dir_all(&on_disk).expect("made");
    let machine = story!(crate::files::of_machine, on_disk);
    let memory = story!(crate::files::in_memory, folder("story"));
    assert_eq!(memory, machine);
}

#[test]
fn changes_are_told_once_and_those_of_others_are_not() {
    let folder = folder("changes");
    let (kept, gone) = (folder.join("kept"), folder.join("gone"));
    take_over(vec![(folder.join("other"), Some(vec![9]))]);
    write(&kept, "a").expect("written");
    write(&gone, "b").expect("written");
    remove_file(&gone).expect("there");
    let mut mine = take_changes();
    mine.retain(|(path, _)| path.starts_with(&folder));
    assert_eq!(mine, [(gone, None), (kept.clone(), Some(b"a".to_vec()))]);
    File::options().append(true).open(&kept).expect("there").write_all(b"b").expect("written");
    let mut mine = take_changes();
    mine.retain(|(path, _)| path.starts_with(&folder));
    assert_eq!(mine, [(kept, Some(b"ab".to_vec()))]);
    assert_eq!(read(folder.join("other")).expect("taken over"), [9]);
}

#[test]
fn paths_start_from_home_and_an_empty_one_is_none() {
    assert_eq!(absolute(Path::new("a/../b/./c")).expect("a path"), Path::new("/home/b/c"));
    assert_eq!(absolute(Path::new("/../x")).expect("a path"), Path::new("/x"));
    assert_eq!(absolute(Path::new("")).expect_err("none").kind(), ErrorKind::InvalidInput);
}
