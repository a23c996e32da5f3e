//! Writes a part.
