//! The text of a QIF file, however long somebody made it.

use std::{
    fs::File,
    io::{Error, Read, Result},
    path::Path,
};

/// The greatest file that is read (bytes).
pub const LARGEST: u64 = 1 << 28;

/// Reads a file of at most [`LARGEST`] bytes of UTF-8.
///
/// # Errors
/// A file that cannot be read, is larger, or is not UTF-8.
pub fn read(path: &Path) -> Result<String> {
    read_at_most(File::open(path)?, LARGEST)
}

fn read_at_most(file: impl Read, most: u64) -> Result<String> {
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(Error::other(format!("more than {most} bytes")));
    }
    String::from_utf8(bytes).map_err(|error| {
        let (valid, rest) = error.as_bytes().split_at(error.utf8_error().valid_up_to());
        let line = valid.iter().filter(|byte| **byte == b'\n').count() + 1;
        let byte = rest.first().copied().unwrap_or_default();
        Error::other(format!("line {line} has the byte 0x{byte:02x}, which is not UTF-8: save the file as UTF-8"))
    })
}

#[cfg(test)]
mod tests {
    use std::io::repeat;

    use super::read_at_most;

    #[test]
    fn what_has_no_end_is_not_read_to_it() {
        assert_eq!(read_at_most(&b"<Q/>"[..], 4).expect("four bytes"), "<Q/>");
        assert!(read_at_most(&b"<Q/> "[..], 4).is_err());
        let error = read_at_most(&b"<Q>\n\xe4</Q>"[..], 100).expect_err("Latin-1").to_string();
        assert!(error.starts_with("line 2 has the byte 0xe4"), "{error}");
        assert_eq!(read_at_most(repeat(b' '), 1000).expect_err("endless").to_string(), "more than 1000 bytes");
    }
}
