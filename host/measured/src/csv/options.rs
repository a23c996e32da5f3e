//! How a CSV file is read.

/// The greatest file that is read unless an option says otherwise, in bytes. A table needs at most twenty times as much
/// memory as its file.
pub const LARGEST: u64 = 1 << 28;

/// How a CSV file is read.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the column that labels the parts.
    pub labels: Option<String>,
    /// Names of the columns that divide the parts into subgroups.
    pub groups: Vec<String>,
    /// Names of the columns that are left out.
    pub ignored: Vec<String>,
    /// Names of the columns of measured values, all others being left out; all columns if not stated.
    pub values: Option<Vec<String>>,
    /// Greatest size of the file (bytes).
    pub largest: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { labels: None, groups: Vec::new(), ignored: Vec::new(), values: None, largest: LARGEST }
    }
}
