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
    let mut text = String::new();
    file.take(most + 1).read_to_string(&mut text)?;
    if text.len() as u64 > most {
        return Err(Error::other(format!("more than {most} bytes")));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use std::io::repeat;

    use super::read_at_most;

    #[test]
    fn what_has_no_end_is_not_read_to_it() {
        assert_eq!(read_at_most(&b"<Q/>"[..], 4).expect("four bytes"), "<Q/>");
        assert!(read_at_most(&b"<Q/> "[..], 4).is_err());
        assert_eq!(read_at_most(repeat(b' '), 1000).expect_err("endless").to_string(), "more than 1000 bytes");
    }
}
