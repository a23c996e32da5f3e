//! The archive that a unit is.

use std::io::{Cursor, Write};

use zip::{CompressionMethod, DateTime, ZipWriter, result::ZipError, write::SimpleFileOptions};

use super::Entry;

/// The archive with these `entries`, in their order: the same bytes whenever and wherever it is made.
///
/// # Errors
/// If one of them does not fit into an archive.
pub fn archive(entries: &[Entry]) -> Result<Vec<u8>, ZipError> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, bytes) in entries {
        let name: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
        writer.start_file(name.join("/"), options)?;
        writer.write_all(bytes)?;
    }
    Ok(writer.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use std::{io::Read, path::PathBuf};

    use super::archive;

    #[test]
    fn gives_back_what_it_was_given_and_the_same_bytes_again() {
        let entries = [
            (PathBuf::from("modelDescription.xml"), b"<a/>".to_vec()),
            (PathBuf::from("binaries").join("x86_64-linux").join("slide.so"), vec![7; 100_000]),
        ];
        let bytes = archive(&entries).unwrap();
        assert_eq!(bytes, archive(&entries).unwrap());
        let mut read = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
        for (name, expected) in
            [("modelDescription.xml", &entries[0].1), ("binaries/x86_64-linux/slide.so", &entries[1].1)]
        {
            let mut found = Vec::new();
            read.by_name(name).unwrap().read_to_end(&mut found).unwrap();
            assert_eq!(found, *expected);
        }
    }
}
