//! Scene files that are text, but not in UTF-8.

/// The `bytes` of a file as text, without a byte order mark.
///
/// # Errors
/// What encoding they are in, as far as it can be seen, and what to do.
pub fn text_of(mut bytes: Vec<u8>) -> Result<String, String> {
    const SAVE: &str = "save it as UTF-8";
    // UTF-16 of Latin letters has a zero in every second byte, with or without its mark. UTF-8 text has none.
    let zeros = |first: usize| bytes.iter().skip(first).step_by(2).take(64).filter(|byte| **byte == 0).count();
    let is_wide = bytes.len() >= 2 && zeros(0).max(zeros(1)) > bytes.len().min(128) / 4;
    match &bytes[..] {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => return Err(format!("it is in UTF-32: {SAVE}")),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => return Err(format!("it is in UTF-16: {SAVE}")),
        [0xef, 0xbb, 0xbf, ..] => drop(bytes.drain(..3)),
        [b'P', b'K', 3, 4, ..] => return Err("it is a ZIP archive, as office programs write".into()),
        _ if is_wide => return Err(format!("it is in UTF-16 or not a text: {SAVE}")),
        _ => {}
    }
    String::from_utf8(bytes).map_err(|error| {
        let (valid, rest) = error.as_bytes().split_at(error.utf8_error().valid_up_to());
        let line = valid.iter().filter(|byte| **byte == b'\n').count() + 1;
        let byte = rest.first().copied().unwrap_or_default();
        // Texts have no other control characters than those that move on.
        if valid.iter().chain(rest).any(|byte| matches!(byte, 0..=8 | 14..=31)) {
            return format!(
                "line {line} has the byte 0x{byte:02x}, and control characters are in it: it is not a text"
            );
        }
        format!("line {line} has the byte 0x{byte:02x}, which is not UTF-8, but may be Latin-1 (Windows-1252): {SAVE}")
    })
}

#[cfg(test)]
mod tests {
    use super::text_of;

    #[test]
    fn other_encodings_are_recognised() {
        let text = "title = \"Träger\"\n[slide]\nmass = 90\n";
        let wide = |mark: bool, bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
            let units = mark.then_some(0xfeff).into_iter().chain(text.encode_utf16());
            units.flat_map(bytes).collect()
        };
        for (mark, bytes) in [(true, u16::to_le_bytes as fn(u16) -> [u8; 2]), (true, u16::to_be_bytes)] {
            assert_eq!(text_of(wide(mark, bytes)).unwrap_err(), "it is in UTF-16: save it as UTF-8");
        }
        for bytes in [u16::to_le_bytes as fn(u16) -> [u8; 2], u16::to_be_bytes] {
            assert!(text_of(wide(false, bytes)).unwrap_err().contains("UTF-16"));
        }
        let four: Vec<u8> = "\u{feff}a".chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
        assert!(text_of(four).unwrap_err().contains("UTF-32"));
        assert!(text_of(b"PK\x03\x04ab\xff".to_vec()).unwrap_err().contains("ZIP"));
        assert!(text_of(b"\x89PNG\r\n\x1a\n\xff".to_vec()).unwrap_err().contains("not a text"));
        let latin: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
        assert!(
            text_of(latin).unwrap_err().starts_with("line 1 has the byte 0xe4, which is not UTF-8, but may be Latin-1")
        );
        assert_eq!(text_of(text.as_bytes().to_vec()).unwrap(), text);
        assert_eq!(text_of(format!("\u{feff}{text}").into_bytes()).unwrap(), text);
        assert_eq!(text_of(Vec::new()).unwrap(), "");
    }
}
